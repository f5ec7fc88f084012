"""What matters of a noun, as lines of text and as a small table for a notebook."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

from shaftprint.escape import html_text, terminal_line

LINE_WIDTH = 100
MOST_NAMES = 12
# Notebooks set cells to the right, for numbers; a fact is a sentence.
CELL_STYLE = 'style="text-align: left; vertical-align: top"'


@dataclass(frozen=True, kw_only=True, slots=True)
class Summary:
    """What matters of a noun, in a few facts."""

    title: str
    """Which noun it is, and its name."""
    facts: Mapping[str, str]
    """What a reader wants to know first, by what it is; an empty one is left out."""

    def text(self) -> str:
        """Return a line for the title and one for each fact, none wider than a terminal."""
        facts = {label: value for label, value in self.facts.items() if value}
        width = max((len(label) for label in facts), default=0)
        lines = [self.title, *(f"  {label:<{width}}  {value}" for label, value in facts.items())]
        return "\n".join(_cut(terminal_line(line)) for line in lines)

    def html(self) -> str:
        """Return a table of two columns in HTML, whose every text is escaped, without scripts."""
        rows = (
            f'<tr><th scope="row" {CELL_STYLE}>{html_text(label)}</th><td {CELL_STYLE}>{html_text(value)}</td></tr>'
            for label, value in self.facts.items()
            if value
        )
        return f"<table><caption>{html_text(self.title)}</caption><tbody>{''.join(rows)}</tbody></table>"


def _cut(line: str) -> str:
    """Return a line that fits a terminal; what is left out at its end is marked."""
    return line if len(line) <= LINE_WIDTH else line[: LINE_WIDTH - 1].rstrip() + "…"


def shortened(names: Iterable[str]) -> str:
    """Return names with commas; of many the first, and how many there are."""
    every = list(names)
    if len(every) <= MOST_NAMES:
        return ", ".join(every)
    return f"{', '.join(every[: MOST_NAMES - 2])}, … ({len(every)})"
