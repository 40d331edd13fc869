// The verdict table: filters from the form, kept in the address, and rows sorted by the heading that is pressed.
(() => {
  const form = document.getElementById("filters");
  const table = document.getElementById("entries");
  const count = document.getElementById("count");
  const body = table.tBodies[0];
  const rows = [...body.rows].map((row) => ({ row, text: row.textContent.toLowerCase() }));

  const filter = () => {
    const data = new FormData(form);
    const words = data.get("text").toLowerCase().split(/\s+/).filter(Boolean);
    const chapter = data.get("chapter");
    const verdicts = data.getAll("verdict");
    const held = data.has("held");
    let shown = 0;
    for (const { row, text } of rows) {
      const { verdict, chapter: its, role } = row.dataset;
      const fits =
        (!chapter || its === chapter) &&
        (!verdicts.length || verdicts.includes(verdict)) &&
        (!held || role === "held out") &&
        words.every((word) => text.includes(word));
      row.hidden = !fits;
      shown += fits;
    }
    count.textContent = shown === rows.length ? `${shown} entries` : `${shown} of ${rows.length} entries`;
  };

  const remember = () => {
    const set = new URLSearchParams([...new FormData(form)].filter(([, value]) => value)).toString();
    history.replaceState(null, "", "#verdicts" + (set && "?" + set));
  };

  const recall = () => {
    const [page, set] = location.hash.slice(1).split("?");
    if (page !== "verdicts" || set === undefined) return;
    const wanted = new URLSearchParams(set);
    for (const field of form.elements) {
      if (!field.name) continue;
      if (field.type === "checkbox") field.checked = wanted.getAll(field.name).includes(field.value);
      else field.value = wanted.get(field.name) ?? "";
    }
    filter();
  };

  form.addEventListener("input", () => (filter(), remember()));
  form.addEventListener("reset", () => setTimeout(() => (filter(), remember())));
  form.addEventListener("submit", (event) => event.preventDefault());
  addEventListener("hashchange", recall);

  const key = (row, column) => {
    const cell = row.cells[column];
    return cell.dataset.sort ?? cell.textContent;
  };
  const numbers = new Intl.Collator("en", { numeric: true });
  const order = (a, b) => {
    // What has no number stands last either way.
    const [x, y] = [parseFloat(a), parseFloat(b)];
    return Number.isNaN(x) || Number.isNaN(y) ? numbers.compare(a, b) : x - y;
  };
  [...table.tHead.rows[0].cells].forEach((heading, column) => {
    heading.querySelector("button").addEventListener("click", () => {
      const down = heading.getAttribute("aria-sort") === "ascending";
      for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
      heading.setAttribute("aria-sort", down ? "descending" : "ascending");
      const sorted = rows.map(({ row }) => ({ row, key: key(row, column) }));
      const empty = ({ key }) => (key === "" ? 1 : 0);
      sorted.sort((a, b) => empty(a) - empty(b) || (down ? order(b.key, a.key) : order(a.key, b.key)));
      body.append(...sorted.map(({ row }) => row));
    });
  });

  addEventListener("keydown", (event) => {
    const typing = event.target.closest?.("input, select, textarea");
    if (event.key !== "/" || typing || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    if (!location.hash.startsWith("#verdicts")) location.hash = "#verdicts";
    setTimeout(() => form.elements.text.focus());
  });

  recall();
})();
