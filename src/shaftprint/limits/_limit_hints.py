"""The cheap check for limits: a third harmonic, which a propeller does not make and a limit does.

Torque with the square of the speed gives a second harmonic and a mean; saturation, rate limits and deadbands act up and
down alike and give odd ones (Gelb and Vander Velde, Multiple-Input Describing Functions, 1968, chapter 2).
"""

import numpy as np

from shaftprint.spectra import Harmonics

# A harmonic counts where noise is as large in one of a million lines, and where it is this share of the line.
LEAST_POWER, LEAST_SHARE = 14.0, 0.02
THIRD = 3


def limit_hints(harmonics: Harmonics) -> tuple[str, ...]:
    """Return whether the sines of a test hint at a limit, in words; levels are not looked for.

    Parameters
    ----------
    harmonics
        Those of the test lines, from ``estimate_spectra``.
    """
    place = harmonics.orders.index(THIRD)
    amplitude, std = harmonics.amplitude[:, :, place], harmonics.standard_deviation[:, :, place]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = amplitude / harmonics.fundamental
        seen = (0.5 * (amplitude / std) ** 2 > LEAST_POWER) & (share > LEAST_SHARE)
    found = [
        f"{line}, {output} {100.0 * share[i, j]:.1f} %"
        for i, line in enumerate(harmonics.lines)
        for j, output in enumerate(harmonics.outputs)
        if seen[i, j]
    ]
    if not found:
        return ("No sine has a third harmonic above the noise: if a limit acts, then in the steps alone.",)
    return (
        f"Third harmonics stand out of the noise ({'; '.join(found)} of the line): a limit or a deadband acts there, "
        "which a propeller does not do. shaftprint limits names it and finds its level.",
    )
