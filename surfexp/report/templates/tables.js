"use strict";
// Tables sort by a click on a heading, keep the rows that hold a word, and hide columns.
// Without scripts they are whole.
for (const table of document.querySelectorAll("table.rows")) {
  const body = table.tBodies[0], heads = [...table.tHead.rows[0].cells], rows = [...body.rows];
  const tools = document.createElement("div"), count = document.createElement("span");
  const word = document.createElement("input");
  const valueOf = (row, column) => row.cells[column].dataset.value ?? row.cells[column].textContent.trim();
  const compare = (one, other) => {
    const a = Number(one), b = Number(other);
    return Number.isNaN(a) || Number.isNaN(b) ? one.localeCompare(other, "en", { numeric: true }) : a - b;
  };
  const missing = (value) => value === "" || value === "–";
  heads.forEach((head, column) => {
    const button = document.createElement("button");
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const next = { ascending: "descending", descending: "" }[head.getAttribute("aria-sort")] ?? "ascending";
      heads.forEach((other) => other.removeAttribute("aria-sort"));
      if (next) head.setAttribute("aria-sort", next);
      const sign = next === "descending" ? -1 : 1;
      const sorted = next === "" ? rows : [...rows].sort((one, other) => {
        const a = valueOf(one, column), b = valueOf(other, column);
        return missing(a) || missing(b) ? missing(a) - missing(b) : sign * compare(a, b);
      });
      body.append(...sorted);
    });
  });
  const filter = () => {
    const words = word.value.toLowerCase().split(/\s+/).filter(Boolean);
    for (const row of rows) row.hidden = !words.every((part) => row.textContent.toLowerCase().includes(part));
    const shown = rows.filter((row) => !row.hidden).length;
    count.textContent = shown < rows.length ? `${shown} of ${rows.length} rows` : "";
  };
  word.type = "search";
  word.placeholder = "rows with …";
  word.setAttribute("aria-label", "show the rows that hold these words");
  word.addEventListener("input", filter);
  const menu = document.createElement("details"), title = document.createElement("summary");
  title.textContent = "columns";
  menu.append(title);
  heads.forEach((head, column) => {
    const label = document.createElement("label"), box = document.createElement("input");
    box.type = "checkbox";
    box.checked = true;
    box.addEventListener("change", () => {
      for (const row of table.rows) row.cells[column].hidden = !box.checked;
    });
    label.append(box, " " + (head.dataset.name || head.textContent.trim()));
    menu.append(label);
  });
  tools.className = "tools";
  tools.append(word, menu, count);
  if (rows.length > 2) table.parentElement.before(tools);
}
// a table that is wider than the page says so, and how much of it is hidden
for (const box of document.querySelectorAll(".scroll")) {
  const heads = [...box.querySelectorAll("thead th")], note = document.createElement("p");
  const look = new ResizeObserver(() => {
    const hidden = heads.filter((head) => head.offsetLeft + head.offsetWidth > box.clientWidth + 1).length;
    note.hidden = hidden === 0;
    note.textContent = `Wider than the page: scroll the table sideways for ${hidden} more ${hidden === 1 ? "column" : "columns"}.`;
  });
  note.className = "note wider";
  note.hidden = true;
  box.before(note);
  look.observe(box);
  look.observe(box.firstElementChild);
}
// what is folded away on a screen is on paper
addEventListener("beforeprint", () => {
  for (const part of document.querySelectorAll("details.rows")) part.open = true;
});
