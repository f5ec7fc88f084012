"""The numbers of a fingerprint as rows with labels."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from shaftprint.arrays import FloatArray
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.notebook._labelled import LabelledData
from shaftprint.notebook._labelled_rows import labelled_rows


def labelled_numbers(
    numbers: Mapping[str, Sequence[Estimate]], covariance: FloatArray, facts: Mapping[str, str]
) -> LabelledData:
    """Return a row for each number; what is not known is nan.

    ``numbers``: the numbers by what they are. ``covariance``: covariance of the parameters, shape (parameters,
    parameters). ``facts``: on the whole.
    """
    kinds = [kind for kind, quantities in numbers.items() for _ in quantities]
    rows = [quantity for quantities in numbers.values() for quantity in quantities]
    ends = [quantity.limits_95 for quantity in rows]
    columns: dict[str, tuple[Sequence[Any], str]] = {
        "value": ([one.value for one in rows], "estimate"),
        "std": ([_number(one.stated_std) for one in rows], "standard deviation"),
        "lower_95": ([lower for lower, _ in ends], "lower end of the 95 % interval; nan where the data set none"),
        "upper_95": ([upper for _, upper in ends], "upper end of the 95 % interval; nan where the data set none"),
        "at_bound": ([one.at_bound for one in rows], "whether the search stopped at a bound"),
        "expected": ([_number(one.expected) for one in rows], "value from the vessel file"),
        "expected_std": ([_number(one.expected_std) for one in rows], "standard deviation of that value"),
    }
    texts = {
        "number": [one.name for one in rows],
        "kind": kinds,
        "unit": [one.unit for one in rows],
        "meaning": [one.meaning for one in rows],
    }
    uncertain = [one.name for one in numbers["parameter"]]
    return labelled_rows("number", texts, columns, uncertain=uncertain, covariance=covariance, facts=facts)


def _number(value: float | None) -> float:
    return math.nan if value is None else value
