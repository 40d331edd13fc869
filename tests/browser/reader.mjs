// What a reader of the HTML report does, one task after the other.
// node reader.mjs BROWSER FILE FOLDER: the last is for screenshots.

import assert from "node:assert/strict";
import { mkdirSync, readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { join } from "node:path";
import { pathToFileURL } from "node:url";
import { chromium } from "playwright-core";

const [executablePath, file, folder] = process.argv.slice(2);
const address = pathToFileURL(file).href;
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
mkdirSync(folder, { recursive: true });

const browser = await chromium.launch({ executablePath, args: process.getuid?.() === 0 ? ["--no-sandbox"] : [] });
const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
let [passed, failed] = [0, 0];
// Over all tasks.
const requests = [];
const complaints = [];

async function task(name, options, act) {
  const page = await context.newPage();
  page.on("request", (request) => request.url().startsWith("data:") || requests.push(request.url().split("#")[0]));
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(`${name}: ${message.text()}`));
  page.on("pageerror", (error) => complaints.push(`${name}: ${error}`));
  page.setDefaultTimeout(15000);
  try {
    if (options.width) await page.setViewportSize({ width: options.width, height: 844 });
    await page.emulateMedia({ colorScheme: options.dark ? "dark" : "light", media: options.print ? "print" : "screen" });
    await page.goto(address + (options.at ?? ""));
    await act(page);
    passed += 1;
  } catch (error) {
    failed += 1;
    console.log(`FAILED ${name}\n  ${String(error.stack).split("\n").slice(0, 8).join("\n  ")}`);
  }
  await page.close();
}

const shot = (page, name) => page.screenshot({ path: join(folder, `${name}.png`) });
// Waited for: the address changes first, and the page follows when the browser tells of it.
const shows = (page, id) => page.waitForFunction((id) => document.querySelector(".page.here")?.id === id, id);
const rows = (page) => page.locator("#entries tbody tr:visible");
const width = (page) => page.evaluate(() => document.documentElement.scrollWidth);
const background = (page) => page.evaluate(() => getComputedStyle(document.body).backgroundColor);

/// The rules of WCAG 2 A and AA that a program can check.
async function accessible(page, where) {
  await page.evaluate(axe);
  const { violations } = await page.evaluate(() =>
    window.axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "best-practice"] }),
  );
  const told = violations.map((one) => `${one.id}: ${one.help} (${one.nodes.length}, ${one.nodes[0].html.slice(0, 160)})`);
  assert.deepEqual(told, [], `accessibility of ${where}`);
}

// An experiment with a figure of curves, and its first entry.
const first = await (async () => {
  const page = await context.newPage();
  await page.goto(address);
  const found = await page.evaluate(() => {
    const page = [...document.querySelectorAll(".page")].find((one) => one.querySelector("[data-frame] [data-name]") && one.querySelector("tr a[id]"));
    return { experiment: page.id, entry: page.querySelector("tr a[id]").id };
  });
  await page.close();
  return found;
})();

await task("the first screen says what stands, with links to the experiments", {}, async (page) => {
  await shows(page, "study");
  assert.match(await page.locator("#study p").nth(1).innerText(), /\d+ (numbers?|claims?)/);
  assert.ok((await page.locator("#study .strip a").count()) > 0);
  await accessible(page, "the study");
  await shot(page, "study-1280");
});

await task("a cell of the strip leads to its entry", {}, async (page) => {
  const cell = page.locator("#study .strip a").first();
  const name = (await cell.getAttribute("aria-label")).split(":")[0];
  await cell.click();
  await shows(page, name.split("/")[0]);
  assert.equal(decodeURIComponent(await page.evaluate(() => location.hash)), `#${name}`);
  assert.ok(await page.locator("tr.marked").isVisible());
});

await task("verdicts are sorted by a heading, either way", { at: "#verdicts" }, async (page) => {
  const off = async () => {
    const texts = await page.locator("#entries tbody tr td:last-child").evaluateAll((cells) => cells.map((cell) => cell.dataset.sort));
    return texts.filter(Boolean).map(Number);
  };
  const rising = (list) => list.every((one, i) => i === 0 || list[i - 1] <= one);
  const heading = page.getByRole("button", { name: "|E|/u_val" });
  await heading.click();
  assert.ok(rising(await off()));
  await heading.click();
  assert.ok(rising((await off()).reverse()));
  assert.equal(await page.locator("#entries th[aria-sort]").getAttribute("aria-sort"), "descending");
});

await task("verdicts are filtered by verdict, chapter and whether they are held out", { at: "#verdicts" }, async (page) => {
  const all = await rows(page).count();
  const boxes = page.locator("#filters [name=verdict]");
  const word = await boxes.first().getAttribute("value");
  await boxes.first().check();
  const some = await rows(page).count();
  assert.ok(some > 0 && some <= all);
  assert.deepEqual(await rows(page).evaluateAll((list) => [...new Set(list.map((row) => row.dataset.verdict))]), [word]);
  assert.match(await page.locator("#count").innerText(), some < all ? new RegExp(`^${some} of ${all} entries$`) : /entries/);
  // A study without chapters has "all" alone.
  const [, chapter] = await page.locator("#filters select option").evaluateAll((list) => list.map((option) => option.value));
  if (chapter) {
    await page.locator("#filters select").selectOption(chapter);
    assert.deepEqual(await rows(page).evaluateAll((list) => [...new Set(list.map((row) => row.dataset.chapter))]), [chapter]);
  }
  await page.getByRole("button", { name: "Show all" }).click();
  await page.waitForFunction((all) => document.querySelectorAll("#entries tbody tr:not([hidden])").length === all, all);
  await page.getByLabel("held out only").check();
  assert.equal(await rows(page).count(), await page.locator('#entries tr[data-role="held out"]').count());
  await accessible(page, "the verdicts");
});

await task("verdicts are found by text, and the address keeps the search", { at: "#verdicts" }, async (page) => {
  await page.getByRole("searchbox").fill(first.entry);
  assert.equal(await rows(page).count(), 1);
  const kept = page.url();
  await page.goto("about:blank");
  await page.goto(kept);
  assert.equal(await rows(page).count(), 1);
  assert.equal(await page.getByRole("searchbox").inputValue(), first.entry);
  await shot(page, "verdicts-1280");
});

await task("a link from outside opens the page, and the entry on it", { at: `#${first.entry}` }, async (page) => {
  await shows(page, first.experiment);
  assert.ok(await page.locator("tr.marked").isVisible());
  await page.goto("about:blank");
  await page.goto(`${address}#${first.experiment}`);
  await shows(page, first.experiment);
  assert.equal(await page.title(), await page.locator(".page.here").getAttribute("data-title"));
  await accessible(page, first.experiment);
  await shot(page, "experiment-1280");
});

await task("every link within the file leads somewhere", {}, async (page) => {
  const lost = await page.evaluate(() => {
    const links = [...document.querySelectorAll("a[href^='#']")];
    const name = (a) => decodeURIComponent(a.getAttribute("href").slice(1)).split("?")[0];
    return [...new Set(links.map(name))].filter((name) => !document.getElementById(name));
  });
  assert.deepEqual(lost, []);
  const twice = await page.evaluate(() => {
    const ids = [...document.querySelectorAll("[id]")].map((one) => one.id);
    return ids.filter((id, i) => ids.indexOf(id) !== i);
  });
  assert.deepEqual(twice, [], "ids that occur twice");
});

await task("the back key returns to the page before", {}, async (page) => {
  await page.locator("header a[href='#verdicts']").click();
  await shows(page, "verdicts");
  await page.goBack();
  await shows(page, "study");
});

await task("the keyboard alone finds an entry and opens it", {}, async (page) => {
  await page.keyboard.press("Tab");
  assert.equal(await page.evaluate(() => document.activeElement.className), "skip");
  await page.keyboard.press("/");
  await page.waitForFunction(() => document.activeElement.name === "text");
  await page.keyboard.type(first.entry);
  assert.equal(await rows(page).count(), 1);
  for (let i = 0; i < 40; i++) {
    await page.keyboard.press("Tab");
    if (await page.evaluate(() => document.activeElement.matches("#entries tbody a"))) break;
  }
  await page.keyboard.press("Enter");
  await shows(page, first.experiment);
  assert.equal(await page.evaluate(() => location.hash), `#${first.entry}`);
});

await task("a figure shows its values under the pointer and with the arrow keys", { at: `#${first.experiment}` }, async (page) => {
  const svg = page.locator(".page.here svg:has([data-frame] [data-name])").first();
  await svg.scrollIntoViewIfNeeded();
  const spot = await svg.evaluate((svg) => {
    const [left, top, right, bottom] = svg.querySelector("[data-frame]").dataset.frame.split(" ").map(Number);
    const { x, y } = new DOMPoint((left + right) / 2, (top + bottom) / 2).matrixTransform(svg.getScreenCTM());
    return { x, y };
  });
  await page.mouse.move(spot.x, spot.y);
  const value = page.locator("#value");
  await value.waitFor();
  assert.match(await value.innerText(), /: [−\d.]/);
  await shot(page, "value-1280");
  await page.mouse.move(2, 2);
  await value.waitFor({ state: "hidden" });
  await svg.focus();
  await page.keyboard.press("ArrowRight");
  const before = await value.innerText();
  for (let i = 0; i < 10; i++) await page.keyboard.press("ArrowRight");
  assert.notEqual(await value.innerText(), before);
  await page.keyboard.press("Escape");
  await value.waitFor({ state: "hidden" });
});

await task("the value under the pointer is that of the axes", { at: `#${first.experiment}` }, async (page) => {
  // At the left and the right end of the frame the place read on the x axis is an end of the axis.
  const svg = page.locator(".page.here svg:has([data-frame] [data-name])").first();
  const ends = await svg.evaluate((svg) => svg.querySelector("[data-frame]").dataset.x.split(" ").slice(1).map(Number));
  const read = async () => Number((await page.locator("#value").innerText()).match(/: ([−\d.e+]+)/)[1].replace("−", "-"));
  await svg.focus();
  for (let i = 0; i < 60; i++) await page.keyboard.press("ArrowLeft");
  const low = await read();
  for (let i = 0; i < 60; i++) await page.keyboard.press("ArrowRight");
  const high = await read();
  assert.ok(low >= ends[0] - 1e-3 * Math.abs(ends[0]) && high <= ends[1] * (1 + 1e-3) && low < high, `${low} to ${high} within ${ends}`);
});

await task("dark mode is dark, and can be read", { dark: true }, async (page) => {
  const [r, g, b] = (await background(page)).match(/\d+/g).map(Number);
  assert.ok(r + g + b < 120);
  await accessible(page, "the study in the dark");
  await shot(page, "study-dark-1280");
  await page.goto(`${address}#${first.experiment}`);
  await shows(page, first.experiment);
  await accessible(page, "a page in the dark");
  const svg = page.locator(".page.here svg:has([data-frame])").first();
  assert.equal(await svg.evaluate((svg) => getComputedStyle(svg.querySelector("path")).fill), await background(page), "paper of a figure");
  await svg.scrollIntoViewIfNeeded();
  await shot(page, "experiment-dark-1280");
});

await task("paper shows one page, open and without controls", { at: `#${first.experiment}` }, async (page) => {
  await page.emulateMedia({ media: "print", colorScheme: "dark" });
  assert.ok(!(await page.locator("header").isVisible()));
  assert.equal(await background(page), "rgb(255, 255, 255)");
  await page.evaluate(() => dispatchEvent(new Event("beforeprint")));
  assert.equal(await page.locator(".here details:not([open])").count(), 0);
  await page.evaluate(() => dispatchEvent(new Event("afterprint")));
  const pdf = await page.pdf({ path: join(folder, "experiment.pdf") });
  assert.ok(pdf.length > 10000);
});

for (const at of ["#study", "#verdicts", `#${first.experiment}`]) {
  await task(`a phone shows ${at} without scrolling sideways`, { width: 390, at }, async (page) => {
    assert.ok((await width(page)) <= 390, `the page is ${await width(page)} wide`);
    await accessible(page, `${at} on a phone`);
    await shot(page, `${at.startsWith("#ch") || at === `#${first.experiment}` ? "experiment" : at.slice(1)}-390`);
  });
}

await task("motion can be stopped, and stands still for who wants that", {}, async (page) => {
  await page.emulateMedia({ reducedMotion: "reduce" });
  const moving = await page.evaluate(() => document.getAnimations().length);
  assert.equal(moving, 0);
});

await task("all of it took one request, and nothing was complained of", {}, async () => {
  assert.deepEqual([...new Set(requests)].filter((url) => url !== "about:blank"), [address]);
  assert.deepEqual(complaints, []);
  assert.ok(readFileSync(file).length < 6e6, "under 6 MB");
});

await browser.close();
console.log(`${passed} passed, ${failed} failed`);
process.exit(failed ? 1 : 0);
