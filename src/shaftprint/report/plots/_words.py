"""Words on interactive figures: names with slanted letters and lowered indices, all else as it is written."""

from shaftprint.escape import html_text
from shaftprint.report.notation import symbol_html
from shaftprint.tables import unit_text


def name_text(formula: str) -> str:
    """Return a parameter name or formula for a label; what a user named cannot become a link or a tag."""
    return str(symbol_html(formula))


def label_text(label: str) -> str:
    """Return the name of a model, test or fingerprint as it was given: no part of it is a formula or a tag."""
    return html_text(label).replace("$", "&#36;")


def axis_text(label: str, unit: str = "") -> str:
    """Return an axis label with its unit in brackets, ``[-]`` for a number without unit."""
    return f"{name_text(label)} [{unit_text(unit) or '-'}]"


def over_text(output: str, cause: str) -> str:
    """Return the label of a response, output over input."""
    return f"{name_text(output)} / {name_text(cause)}"
