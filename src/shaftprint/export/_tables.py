"""The numbers of a fingerprint as tables of plain values: what CSV and JSON are written from."""

import math
from typing import TypeAlias

from shaftprint.distributions import NORMAL_95
from shaftprint.export._model_response import ModelResponse
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.models._structure import Structure

Cell: TypeAlias = str | float | bool | None
Row: TypeAlias = dict[str, Cell]


def parameter_rows(fingerprint: Fingerprint, structure: Structure) -> list[Row]:
    """Return a row for each parameter of the structure; of those that were held no uncertainty is known."""
    quantities = {quantity.name: quantity for quantity in fingerprint.parameters}
    rows = []
    for parameter in structure.parameters:
        if parameter.name in quantities:
            rows.append(quantity_row(quantities[parameter.name]) | {"held": False})
            continue
        held = Estimate(
            name=parameter.name,
            unit=parameter.unit,
            value=fingerprint.held[parameter.name],
            std=math.inf,
            meaning=parameter.meaning,
        )
        rows.append(quantity_row(held) | {"held": True})
    return rows


def number_rows(fingerprint: Fingerprint) -> list[Row]:
    """Return a row for each combination, physical value, margin, calibration and number of a limit."""
    kinds = {kind: numbers for kind, numbers in fingerprint.numbers.items() if kind != "parameter"}
    if fingerprint.with_limits is not None:
        kinds["limit"] = fingerprint.with_limits.numbers
    return [{"kind": kind, **quantity_row(quantity)} for kind, quantities in kinds.items() for quantity in quantities]


def quantity_row(quantity: Estimate) -> Row:
    """Return a number with its uncertainty; what is not known, or not finite, is None.

    The 95 % interval is that of the profile likelihood where there is one, else the first-order one; an end that the
    data did not set is None.
    """
    low, high = quantity.limits_95
    return {
        "name": quantity.name,
        "unit": quantity.unit,
        "value": _finite(quantity.value),
        "std": _finite(quantity.stated_std),
        "lower_95": _finite(low),
        "upper_95": _finite(high),
        "interval_from_profile": quantity.interval_95 is not None,
        "at_bound": quantity.at_bound,
        "expected": _finite(quantity.expected),
        "expected_std": _finite(quantity.expected_std),
        "meaning": quantity.meaning,
    }


def response_rows(modelled: ModelResponse) -> list[Row]:
    """Return a row for each output, input and frequency: the response and its 95 % band to first order."""
    magnitude, phase = modelled.magnitude_db, modelled.phase_deg
    half_db, half_deg = NORMAL_95 * modelled.magnitude_std_db, NORMAL_95 * modelled.phase_std_deg
    rows: list[Row] = []
    for i, output in enumerate(modelled.outputs):
        for j, source in enumerate(modelled.inputs):
            for k, omega in enumerate(modelled.omega_rad_s):
                level, turn, value = magnitude[i, j, k], phase[i, j, k], modelled.response[i, j, k]
                numbers = {
                    "omega_rad_s": omega,
                    "frequency_hz": omega / (2.0 * math.pi),
                    "real": value.real,
                    "imaginary": value.imag,
                    "magnitude_db": level,
                    "magnitude_lower_95_db": level - half_db[i, j, k],
                    "magnitude_upper_95_db": level + half_db[i, j, k],
                    "phase_deg": turn,
                    "phase_lower_95_deg": turn - half_deg[i, j, k],
                    "phase_upper_95_deg": turn + half_deg[i, j, k],
                }
                rows.append({"output": output, "input": source} | {key: _finite(n) for key, n in numbers.items()})
    return rows


def _finite(value: float | None) -> float | None:
    return None if value is None or not math.isfinite(value) else float(value)
