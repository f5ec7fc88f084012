"""A simulation on the terminal: what it was made with, and what came out."""

from __future__ import annotations

import math

from shaftprint.cli._terminal import say
from shaftprint.cli.output._tables import print_table
from shaftprint.digits import rounded, unit_text, with_deviation
from shaftprint.late import late
from shaftprint.plain_table import MEANING, Table, numbers, texts

with late():
    import numpy as np

    from shaftprint.arrays import FloatArray
    from shaftprint.forecast._simulation import Simulation


VALUE_DIGITS, RANGE_DIGITS, STD_DIGITS = 6, 5, 2
# Of the largest value: less is what rounding leaves of zero.
NOTHING = 1e-12


def print_simulation(simulation: Simulation) -> None:
    """Print the parameters with where they come from, the range of every signal, and what a reader must know."""
    model, time_s = simulation.run.model, simulation.time_s
    structure = model.structure
    std = dict(zip(model.uncertain, np.sqrt(np.diag(model.covariance)), strict=True))
    std |= dict.fromkeys(model.not_known, math.inf)
    values = [
        (p.name, _value(value, std.get(p.name)), unit_text(p.unit), origin, p.meaning)
        for p, value, origin in zip(structure.parameters, model.values, model.origins, strict=True)
        if not (p.held and value == 0.0 and origin != "--set")
    ]
    print_table(
        Table(
            title=f"{structure.name}: {structure.title}",
            columns=(*texts("parameter"), *numbers("value"), *texts("unit", "from"), MEANING),
            rows=tuple(values),
        )
    )
    ranges = [
        (
            signal.title,
            signal.unit,
            *(rounded(end, RANGE_DIGITS) for end in _ends(signal.values)),
            "" if signal.std is None else rounded(float(signal.std.max()), STD_DIGITS),
        )
        for signal in simulation.signals
    ]
    print_table(
        Table(
            title=f"From {time_s[0]:g} to {time_s[-1]:g} s",
            columns=(*texts("signal", "unit"), *numbers("lowest", "highest", "largest std")),
            rows=tuple(ranges),
        )
    )
    if model.uncertain:
        say("The standard deviations hold the covariance of the parameters, not noise, weather or load.")
    if model.not_known:
        pronoun = "it" if len(model.not_known) == 1 else "them"
        say(f"The test said nothing of {', '.join(model.not_known)}: the band leaves {pronoun} out.")
    for sentence in simulation.remarks:
        say(sentence)


def _ends(values: FloatArray) -> tuple[float, float]:
    """Return the smallest and the largest value, without what rounding leaves of zero."""
    ends = (float(values.min()), float(values.max()))
    nothing = NOTHING * max(map(abs, ends))
    return tuple(0.0 if abs(end) < nothing else end for end in ends)  # type: ignore[return-value]


def _value(value: float, std: float | None) -> str:
    return rounded(value, VALUE_DIGITS) if std is None else with_deviation(value, std)
