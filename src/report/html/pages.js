// Pages: shows the one that the address names, `#ch3-gap` or an entry on it, `#ch3-gap/maximum`.
"use strict";
(() => {
  const pages = [...document.querySelectorAll(".page")];
  const beside = document.getElementById("beside");

  const link = (page, words, rel) => {
    const a = document.createElement("a");
    a.href = "#" + page.id;
    a.rel = rel;
    a.textContent = words + page.dataset.title;
    return a;
  };

  const show = (moved) => {
    const name = decodeURIComponent(location.hash.slice(1)).split("?")[0];
    const target = document.getElementById(name === "main" ? "" : name);
    const page = target?.closest(".page") ?? document.getElementById("study");
    if (name === "main") return;
    for (const one of pages) one.classList.toggle("here", one === page);
    document.title = page.dataset.title;
    for (const a of document.querySelectorAll("header a")) {
      if (a.hash === "#" + page.id) a.setAttribute("aria-current", "page");
      else a.removeAttribute("aria-current");
    }
    const at = pages.indexOf(page);
    beside.replaceChildren();
    if (at > 0) beside.append(link(pages[at - 1], "← ", "prev"));
    if (at + 1 < pages.length) beside.append(link(pages[at + 1], "→ ", "next"));
    for (const old of document.querySelectorAll(".marked")) old.classList.remove("marked");
    if (target && target !== page) {
      for (let up = target; up; up = up.parentElement) if (up.tagName === "DETAILS") up.open = true;
      target.closest("tr")?.classList.add("marked");
      target.scrollIntoView({ block: "center" });
    } else if (moved) {
      scrollTo(0, 0);
    }
    if (moved) {
      // Where reading goes on.
      const start = (target && target !== page && target.closest("tr, h2, h3")) || page.querySelector("h1");
      start?.setAttribute("tabindex", "-1");
      start?.focus({ preventScroll: true });
    }
  };
  addEventListener("hashchange", () => show(true));
  show(location.hash !== "");

  // Paper shows what is closed.
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = [...document.querySelectorAll(".here details:not([open])")];
    for (const one of closed) one.open = true;
  });
  addEventListener("afterprint", () => {
    for (const one of closed) one.open = false;
  });
})();
