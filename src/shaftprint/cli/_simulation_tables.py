"""A simulation on the terminal: what it was made with, and what came out."""

import math
from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._simulated_model import SimulatedModel
from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.report import SimulatedSignal


def print_simulation(
    model: SimulatedModel, time_s: FloatArray, signals: Sequence[SimulatedSignal], *, warnings: Sequence[str]
) -> None:
    """Print the parameters with where they come from, the range of every signal, and what a reader must know.

    Parameters
    ----------
    warnings
        What a reader must know, in sentences.
    """
    structure = model.structure
    std = dict(zip(model.uncertain, np.sqrt(np.diag(model.covariance)), strict=True))
    std |= dict.fromkeys(model.not_known, math.inf)
    rows = [
        (p.name, with_uncertainty(value, std[p.name]) if p.name in std else f"{value:.6g}", p.unit, origin, p.meaning)
        for p, value, origin in zip(structure.parameters, model.values, model.origins, strict=True)
        if not (p.held and value == 0.0 and origin != "--set")
    ]
    print_table(
        f"{structure.name}: {structure.title}", ("parameter", "value", "unit", "from", "meaning"), rows, spare=True
    )
    rows = [
        (
            signal.title,
            signal.unit,
            f"{signal.values.min():.5g}",
            f"{signal.values.max():.5g}",
            "" if signal.std is None else f"{signal.std.max():.2g}",
        )
        for signal in signals
    ]
    columns = ("signal", "unit", "lowest", "highest", "largest std")
    print_table(f"From {time_s[0]:g} to {time_s[-1]:g} s", columns, rows, numbers=(2, 3, 4))
    if model.uncertain:
        echo("The standard deviations hold the covariance of the parameters, not noise, weather or load.")
    if model.not_known:
        left = "it" if len(model.not_known) == 1 else "them"
        echo(f"The test said nothing of {', '.join(model.not_known)}: the band leaves {left} out.")
    for sentence in warnings:
        echo(sentence)
