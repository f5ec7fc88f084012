// What tells how to do something comes first, what tells why the code is as it is last, and how it became so behind that; a page before a place within one.
// A term or symbol that the glossary has is explained there: it comes before pages that only use the word.
const scoreOfPlace = (page) => {
  if (page === "history") return -60;
  if (page.startsWith("reference/")) return -40;
  if (page.startsWith("decisions")) return -20;
  if (page === "glossary") return 9;
  return page.startsWith("tutorials/") || page.startsWith("theory/") || page === "what-to-measure" ? 3 : 0;
};

var Scorer = {
  score: ([page, title, anchor, description, score]) => score + scoreOfPlace(page) - (anchor ? 2 : 0),
  objNameMatch: 11,
  objPartialMatch: 6,
  objPrio: { 0: 15, 1: 5, 2: -5 },
  objPrioDefault: 0,
  title: 15,
  partialTitle: 7,
  term: 5,
  partialTerm: 2,
};
