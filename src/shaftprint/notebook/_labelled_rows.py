"""Numbers with their uncertainty as rows with labels, and the covariance of some of them."""

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.notebook._labelled import LabelledData, Variable


def labelled_rows(
    row: str,
    texts: Mapping[str, Sequence[str]],
    columns: Mapping[str, tuple[Sequence[Any], str]],
    *,
    uncertain: Sequence[str],
    covariance: FloatArray,
    facts: Mapping[str, str],
) -> LabelledData:
    """Return a row for each number.

    ``row``: what a row is; ``texts`` has the names of all under it. ``texts``: what is said of each number, by name.
    ``columns``: numbers of each row with what they mean, by name; what is not known is nan. ``uncertain``: names of the
    parameters that have a covariance. ``covariance``: their covariance, shape (uncertain, uncertain). ``facts``: on the
    whole.
    """
    variables = {
        name: Variable(dims=(row,), values=np.array(values), meaning=meaning)
        for name, (values, meaning) in columns.items()
    }
    axes = ("parameter", "parameter_too")
    variables["covariance"] = Variable(dims=axes, values=covariance, meaning="covariance of the parameters")
    coordinates = {axis: Variable(dims=(axis,), values=np.array(uncertain)) for axis in axes}
    coordinates |= {name: Variable(dims=(row,), values=np.array(labels)) for name, labels in texts.items()}
    return LabelledData(rows=(row,), variables=variables, coordinates=coordinates, attributes=dict(facts))
