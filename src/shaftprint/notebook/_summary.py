"""What matters of a noun, as lines of text and as a small table for a notebook."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

from shaftprint.escape import html_text, terminal_line

LINE_WIDTH = 100
MOST_NAMES = 12


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
        """Return a table of two columns in HTML, without scripts or styles of its own."""
        rows = [(label, value) for label, value in self.facts.items() if value]
        return html_table(self.title, (), rows)


def _cut(line: str) -> str:
    """Return a line that fits a terminal; what is left out at its end is marked."""
    return line if len(line) <= LINE_WIDTH else line[: LINE_WIDTH - 1].rstrip() + "…"


def html_table(title: str, headings: Sequence[str], rows: Iterable[Sequence[str]], note: str = "") -> str:
    """Return a table in HTML whose every text is escaped.

    Parameters
    ----------
    title
        What it shows, above it.
    headings
        Names of the columns; none for a table of facts, whose rows begin with their name.
    rows
        Cells.
    note
        What a reader must know with it, below.
    """
    parts = [f"<table><caption>{html_text(title)}</caption>"]
    if headings:
        parts.append("<thead><tr>" + "".join(f'<th scope="col">{html_text(one)}</th>' for one in headings))
        parts.append("</tr></thead>")
    parts.append("<tbody>")
    for name, *cells in rows:
        parts.append(f'<tr><th scope="row">{html_text(name)}</th>')
        parts.append("".join(f"<td>{html_text(cell)}</td>" for cell in cells) + "</tr>")
    parts.append("</tbody></table>" + (f"<p>{html_text(note)}</p>" if note else ""))
    return "".join(parts)


def shortened(names: Iterable[str]) -> str:
    """Return names with commas; of many the first, and how many there are."""
    every = list(names)
    if len(every) <= MOST_NAMES:
        return ", ".join(every)
    return f"{', '.join(every[: MOST_NAMES - 2])}, … ({len(every)})"
