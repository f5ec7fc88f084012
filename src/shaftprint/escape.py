"""Text that somebody else wrote, made safe for the languages in which it is written out: one function for each.

Names of vessels, tests, channels, units and files come out of data files that anybody may have written, and go on into
C that is compiled, XML, Modelica, MATLAB, tables for spreadsheets, pages and the terminal. In each of these the text
stands for itself: what reads the language gives it back, and runs nothing. Two things change on the way:

- every character that is not printed becomes a question mark, in all languages: line breaks and other control
  characters, marks that turn the direction of writing, and halves of characters;
- a text that a spreadsheet would take for a formula has an apostrophe in front.

Whoever writes to one of these languages takes the function from here and has no replacement of his own.
"""

import html
import re
import unicodedata

from markupsafe import Markup

HIDDEN = "?"
"""What stands for a character that is not printed."""
FORMULA_BEGINS = "=+-@\uff1d\uff0b\uff0d\uff20"
"""How a formula begins in a spreadsheet, in the wide letters of East Asia too."""
CSV_PREFIX = "'"
"""What stands in front of a text in a table that a spreadsheet would take for a formula."""


def printable(text: str, *, keep: str = "") -> str:
    """Return text with a question mark for every character that ends lines, moves the cursor or is not to be seen.

    Parameters
    ----------
    keep
        Characters that stay although they are of this kind.
    """
    hidden = {ord(letter): HIDDEN for letter in set(text) if not _is_seen(letter) and letter not in keep}
    return text.translate(hidden) if hidden else text


def _is_seen(letter: str) -> bool:
    return letter.isprintable() or unicodedata.category(letter) == "Zs"


def plain_name(text: str) -> str:
    """Return a text as the stem of a file name: what some system forbids there becomes a hyphen."""
    return re.sub(r'[\\/:*?"<>|\s]+', "-", printable(text))


def terminal_line(text: str) -> str:
    """Return text as one line of a terminal; line breaks at its end stay."""
    line = text.rstrip("\n")
    return printable(line) + text[len(line) :]


def terminal_message(text: str) -> str:
    """Return an error message of several lines; those after the first are indented, so that none looks like another."""
    return "\n  ".join(printable(line) for line in text.split("\n  "))


def c_string(text: str) -> str:
    """Return text as a string literal of C, in the bytes of UTF-8.

    All but letters, digits and a few marks are written as octal numbers of three digits, which end by themselves: no
    quotation mark, backslash, trigraph or byte beyond ASCII is left for the compiler to interpret.
    """
    plain = frozenset(b"abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789 _-+.,:;()[]=<>")
    return '"' + "".join(chr(byte) if byte in plain else f"\\{byte:03o}" for byte in printable(text).encode()) + '"'


def xml_text(text: str) -> str:
    """Return text that may stand in XML 1.0; quotation marks and brackets are left to the library that writes it."""
    return printable(text)


def modelica_string(text: str) -> str:
    """Return text as a string of Modelica (Modelica Language Specification 3.6, section 2.4.2)."""
    plain = printable(text).replace("\\", "\\\\").replace('"', '\\"')
    return f'"{plain}"'


def modelica_identifier(text: str) -> str:
    """Return text as an identifier of Modelica in single quotes, which has room for ASCII only (section 2.3.1)."""
    plain = "".join(letter if " " <= letter <= "~" and letter != "`" else "_" for letter in text)
    return "'" + re.sub(r"([\\'\"])", r"\\\1", plain) + "'"


def matlab_string(text: str) -> str:
    """Return text as a string of MATLAB and Octave in single quotes, where nothing but the quote has a meaning."""
    return "'" + printable(text).replace("'", "''") + "'"


def matlab_comment(text: str) -> str:
    """Return text that may stand behind the percent sign and other words of a comment of MATLAB and Octave."""
    return printable(text)


def csv_cell(text: str) -> str:
    """Return text for a cell of a table, with an apostrophe in front where a spreadsheet would compute it.

    A single sign, as the unit ``-`` of a number without unit, is no formula.
    """
    plain = printable(text)
    computed = len(plain) > 1 and plain.startswith(tuple(FORMULA_BEGINS + CSV_PREFIX))
    return CSV_PREFIX + plain if computed else plain


def csv_cell_text(cell: str) -> str:
    """Return the text of a cell that ``csv_cell`` made."""
    marked = cell.startswith(CSV_PREFIX) and len(cell) > 1 and cell[1] in FORMULA_BEGINS + CSV_PREFIX
    return cell[len(CSV_PREFIX) :] if marked else cell


def dbc_text(text: str) -> str:
    """Return text for a string of a DBC file: letters of ISO 8859-1 without quotation marks and backslashes."""
    plain = printable(text).replace('"', "'").replace("\\", "/")
    return plain.encode("latin-1", "replace").decode("latin-1")


_CHAT = str.maketrans({"<": "‹", ">": "›", "[": "(", "]": ")", "@": "＠", "&": "+", "|": "/", "`": "'", "*": "·"})


def chat_text(text: str) -> str:
    """Return text in one line in which a chat finds no mention, link or mark-up; what looks like it stays."""
    return printable(text).translate(_CHAT).replace("://", ": //")


def html_text(text: str) -> str:
    """Return text for HTML, or for an attribute in quotation marks."""
    return html.escape(printable(text))


def html_value(value: object) -> object:
    """Return a value that a template is about to write; line breaks stay, and what is marked up stays so."""
    if isinstance(value, Markup):
        return Markup(printable(value, keep="\n\t"))  # noqa: S704 - letters are taken away, none is added but ?
    return printable(value, keep="\n\t") if isinstance(value, str) else value


def toml_string(text: str) -> str:
    """Return text as a string of TOML on one line; here control characters come back too."""
    plain = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(letter if _is_seen(letter) else f"\\U{ord(letter):08x}" for letter in plain) + '"'
