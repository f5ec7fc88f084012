"use strict";
// Tables are sorted by the heading that is pressed; a row has an address of its own, by what its first cell says.
(() => {
  const number = (text) => {
    const found = text.replace(/\u2212/g, "-").replace(/(\d)[\u202f\u2009\u00a0](?=\d)/g, "$1").match(/^-?\d+(\.\d+)?(e[-+]?\d+)?(?!\d*[-:]\d)/i);
    return found ? Number(found[0]) : NaN;
  };
  const order = (a, b) => {
    const [one, other] = [number(a), number(b)];
    if (!isNaN(one) && !isNaN(other)) return one - other;
    return isNaN(one) - isNaN(other) || a.localeCompare(b, "en", {numeric: true});
  };
  const slug = (text) => text.trim().toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 60);
  const taken = new Set([...document.querySelectorAll("[id]")].map((one) => one.id));
  for (const table of document.querySelectorAll("main table")) {
    const body = table.tBodies[0];
    if (!body || !table.tHead || body.rows.length < 1) continue;
    [...table.tHead.rows[0].cells].forEach((head, place) => {
      if (!head.textContent.trim() || body.rows.length < 2) return;
      const button = document.createElement("button");
      button.type = "button";
      button.className = "sort";
      button.append(...head.childNodes);
      head.append(button);
      button.addEventListener("click", () => {
        const falls = head.getAttribute("aria-sort") === "ascending";
        for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
        head.setAttribute("aria-sort", falls ? "descending" : "ascending");
        const said = (row) => (row.cells[place]?.innerText || "").trim();
        const rows = [...body.rows].sort((a, b) => (falls ? -1 : 1) * order(said(a), said(b)));
        body.append(...rows);
      });
    });
    for (const row of body.rows) {
      const first = row.cells[0], name = slug(first.querySelector("a")?.textContent || first.firstChild?.textContent || "");
      const second = row.cells[1] ? slug(row.cells[1].innerText) : "";
      const id = [`row-${name}`, `row-${name}-${second}`].find((one) => name && !taken.has(one));
      if (row.id || !id) continue;
      taken.add(id);
      row.id = id;
      const link = document.createElement("a");
      link.href = `#${encodeURIComponent(id)}`;
      link.className = "to-row";
      link.textContent = "#";
      link.setAttribute("aria-label", `Link to the row of ${first.innerText.split("\n")[0].trim()}`);
      first.append(" ", link);
    }
  }
  const show = () => {
    document.querySelectorAll("tr.asked").forEach((row) => row.classList.remove("asked"));
    const row = [...document.querySelectorAll("tr[id]")].find((one) => `#${encodeURIComponent(one.id)}` === location.hash);
    if (!row) return;
    row.classList.add("asked");
    row.scrollIntoView({block: "center"});
  };
  addEventListener("hashchange", show);
  show();
})();
