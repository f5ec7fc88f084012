"""The cheap check for limits: third harmonics, and steps that a linear model does not predict.

Torque with the square of the speed gives a second harmonic and a mean; saturation, rate limits and deadbands act up and
down alike and give odd ones (Gelb and Vander Velde, Multiple-Input Describing Functions, 1968, chapter 2). Steps are
larger than sines and reach limits that sines do not.
"""

from collections.abc import Sequence

import numpy as np

from shaftprint.spectra.lines._harmonics import Harmonics

# A harmonic counts where noise is as large in one of a million lines, and where it is this share of the line.
LEAST_POWER, LEAST_SHARE = 14.0, 0.02
THIRD = 3


def limit_hints(
    harmonics: Harmonics, failed_steps: Sequence[str] | None = None, *, named: Sequence[str] = ()
) -> tuple[str, ...]:
    """Return whether sines and steps of a test hint at a limit, in words; levels are not looked for.

    Parameters
    ----------
    harmonics
        Those of the test lines, from ``estimate_spectra``.
    failed_steps
        Steps that a model identified from the sines does not predict; None where no model was held against them.
    named
        The limits that a search for them has found already, in words.
    """
    if failed_steps is None and not np.isfinite(harmonics.amplitude).any():
        return (
            "The lines of a leg have no harmonics of their own by which a limit would be seen: one that acts makes the "
            "fit fail.",
        )
    sentences = _third_harmonics(harmonics)
    hints = []
    if sentences:
        hints.append(
            f"Third harmonics stand out of the noise ({'; '.join(sentences)} of the line): a limit or a deadband acts "
            "there, which a propeller does not do."
        )
    if failed_steps:
        hints.append(
            f"The model of the sines does not predict larger moves ({', '.join(failed_steps)}): a limit may act there."
        )
    if hints:
        return (*hints, _found(named) if named else "shaftprint limits names what acts and finds its level.")
    if failed_steps is None:
        return ("No sine has a third harmonic above the noise: if a limit acts, then in the steps alone.",)
    if named:
        return (f"No sine has a third harmonic above the noise, and no step fails the model. {_found(named)}",)
    return ("Nothing hints at a limit: no sine has a third harmonic above the noise, and no step fails the model.",)


def _found(named: Sequence[str]) -> str:
    return f"The search for limits has found: {', '.join(named)}."


def _third_harmonics(harmonics: Harmonics) -> list[str]:
    """Return the third harmonics that are above the noise, in words."""
    row = harmonics.orders.index(THIRD)
    amplitude, std = harmonics.amplitude[:, :, row], harmonics.standard_deviation[:, :, row]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = amplitude / harmonics.fundamental
        seen = (0.5 * (amplitude / std) ** 2 > LEAST_POWER) & (share > LEAST_SHARE)
    return [
        f"{line}, {output} {100.0 * share[i, j]:.1f} %"
        for i, line in enumerate(harmonics.lines)
        for j, output in enumerate(harmonics.outputs)
        if seen[i, j]
    ]
