"use strict";
// Switches the page between its light and its dark look, and tells whoever draws on it.
(() => {
  const root = document.documentElement;
  const darkScreen = window.matchMedia("(prefers-color-scheme: dark)");
  const look = () => root.dataset.look || (darkScreen.matches ? "dark" : "light");

  function prepareLook() {
    const chosen = document.getElementById("look");
    const say = () => {
      chosen.textContent = look() === "dark" ? "Light look" : "Dark look";
      document.dispatchEvent(new Event("look"));
    };
    chosen.hidden = false;
    chosen.addEventListener("click", () => {
      root.dataset.look = look() === "dark" ? "light" : "dark";
      try {
        localStorage.setItem("shaftprint-look", root.dataset.look);
      } catch {
        // A browser may keep nothing for pages from a disk; the choice then holds for this page.
      }
      say();
    });
    darkScreen.addEventListener("change", say);
    say();
  }

  // Long tables are folded on a phone, where each cell is a line, and open on paper.
  function prepareTables() {
    const tables = [...document.querySelectorAll(".fold")];
    if (!window.matchMedia("(max-width: 40rem)").matches) return;
    const fold = () => tables.forEach((table) => { table.open = false; });
    fold();
    window.addEventListener("beforeprint", () => tables.forEach((table) => { table.open = true; }));
    window.addEventListener("afterprint", fold);
  }

  // Paper has the findings, with what is assumed, though they are folded on the screen.
  function prepareFindings() {
    const findings = document.getElementById("summary")?.closest("details");
    if (!findings) return;
    let before = false;
    window.addEventListener("beforeprint", () => { before = findings.open; findings.open = true; });
    window.addEventListener("afterprint", () => { findings.open = before; });
  }

  // A link to a folded section opens it; the menu of a narrow screen closes once it has been used.
  function prepareContents() {
    const parts = [...document.querySelectorAll("details")];
    const openAddressed = () => {
      const target = document.getElementById(decodeURIComponent(location.hash.slice(1)));
      const part = target && target.closest("details");
      if (!part) return;
      part.open = true;
      part.scrollIntoView();
    };
    window.addEventListener("hashchange", openAddressed);
    const contents = document.getElementById("contents");
    contents.addEventListener("click", (event) => {
      if (!event.target.closest("a")) return;
      if (contents.matches(":popover-open")) contents.hidePopover();
      // The address may be the one that stands already.
      setTimeout(openAddressed);
    });
    const unfold = document.getElementById("unfold");
    if (unfold) unfold.addEventListener("click", () => parts.forEach((part) => { part.open = true; }));
    openAddressed();
  }

  try {
    const kept = localStorage.getItem("shaftprint-look");
    if (kept === "light" || kept === "dark") root.dataset.look = kept;
  } catch {
    // As above.
  }
  // The page waits for this script, so it is painted at once as it will stay: its look, and room for its charts.
  root.classList.add("scripted");
  document.addEventListener("readystatechange", () => {
    // All of the page is read, and plotly's script has not run yet.
    if (document.readyState !== "interactive") return;
    prepareLook();
    prepareTables();
    prepareFindings();
    prepareContents();
  });
})();
