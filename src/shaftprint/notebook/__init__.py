"""What a noun is in a notebook: a few lines of text, a small table, and data with labels for pandas and xarray.

A noun that a user handles derives from ``Shown`` and says in ``summary`` what matters of it; text and table follow
from that. One that holds data says in ``labelled`` which; both packages get the same names, units and meanings.
"""

from shaftprint.notebook._labelled import Labelled, LabelledData, Variable
from shaftprint.notebook._labelled_rows import labelled_rows
from shaftprint.notebook._library import library
from shaftprint.notebook._public_names import closest_names
from shaftprint.notebook._shown import Shown, field_words
from shaftprint.notebook._summary import Summary, shortened

__all__ = [
    "Labelled",
    "LabelledData",
    "Shown",
    "Summary",
    "Variable",
    "closest_names",
    "field_words",
    "labelled_rows",
    "library",
    "shortened",
]
