// Sorts a table by the column whose heading is pressed, and folds long tables. Without it all is shown, in the order of the report.
"use strict";
const value = (row, k) => row.cells[k].dataset.value ?? row.cells[k].textContent.trim();
for (const table of document.querySelectorAll("table.sortable")) {
  const body = table.tBodies[0];
  const heads = [...table.tHead.rows[0].cells];
  const refold = () => [...body.rows].forEach((row, k) => row.classList.toggle("more", k >= 12));
  heads.forEach((head, k) => {
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => {
      const down = head.getAttribute("aria-sort") === "ascending";
      heads.forEach((h) => h.removeAttribute("aria-sort"));
      head.setAttribute("aria-sort", down ? "descending" : "ascending");
      const rows = [...body.rows];
      const compare = (a, b) => {
        const [x, y] = [value(a, k), value(b, k)];
        const numbers = x !== "" && y !== "" && Number.isFinite(Number(x)) && Number.isFinite(Number(y));
        if (x === "" || y === "") return (x === "") - (y === "");
        return (numbers ? Number(x) - Number(y) : x.localeCompare(y)) * (down ? -1 : 1);
      };
      body.append(...rows.sort(compare));
      refold();
    });
  });
  if (body.rows.length <= 14) continue;
  refold();
  table.classList.add("folded");
  const unfold = document.createElement("button");
  unfold.type = "button";
  unfold.className = "unfold";
  const say = () => (unfold.textContent = table.classList.contains("folded") ? `Show all ${body.rows.length} rows` : "Show the first rows");
  unfold.addEventListener("click", () => {
    table.classList.toggle("folded");
    say();
  });
  say();
  table.parentElement.after(unfold);
}
