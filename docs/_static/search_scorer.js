// Guides, tutorials and theory come before the reference, and a page before a place within one.
var Scorer = {
  score: ([page, title, anchor, description, score]) =>
    score - (page.startsWith("reference/") ? 40 : 0) - (anchor ? 2 : 0),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
