"""Noise at a speed between those at which it is stated: loads, combustion and governor change with it."""

from collections.abc import Mapping

import numpy as np

from shaftprint.arrays import frozen_float
from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_levels import NoiseLevels


def noise_at(levels: NoiseLevels | Mapping[float, NoiseLevels], speed: float) -> NoiseLevels:
    """Return the noise levels at a speed.

    Densities follow a power of the speed between the stated speeds, coherences a straight line over its logarithm;
    beyond them they are those of the nearest one. Levels of one speed hold for all.

    Parameters
    ----------
    levels
        Levels of one speed, or by speed: share of the working point, or rpm.
    speed
        The speed, in the same unit.

    Raises
    ------
    IdentificationError
        If no speed is stated, one is not positive, or two have other outputs.
    """
    if isinstance(levels, NoiseLevels):
        return levels
    stated = sorted(levels)
    if not stated or not stated[0] > 0.0 or not speed > 0.0:
        raise IdentificationError(
            f"noise levels: expected positive speeds, found {', '.join(f'{one:g}' for one in stated) or 'none'} and "
            f"{speed:g} asked for."
        )
    if len({one.outputs for one in levels.values()}) > 1:
        raise IdentificationError("noise levels: expected the same outputs at every speed, found others.")
    inside = min(max(speed, stated[0]), stated[-1])
    above = next(place for place, one in enumerate(stated) if one >= inside)
    if stated[above] == inside:
        return levels[stated[above]]
    lower, upper = stated[above - 1], stated[above]
    return _between(levels[lower], levels[upper], float(np.log(inside / lower) / np.log(upper / lower)))


def _between(lower: NoiseLevels, upper: NoiseLevels, share: float) -> NoiseLevels:
    """Return levels between two speeds, at all frequencies that are stated at either."""
    last = lower.frequency_hz[-1] ** (1.0 - share) * upper.frequency_hz[-1] ** share
    both = np.union1d(lower.frequency_hz, upper.frequency_hz)
    frequency = np.append(both[both < last], last)
    parts = []
    for one, weight in ((lower, 1.0 - share), (upper, share)):
        density = one.at(frequency)
        deviation = np.sqrt(np.diagonal(density, axis1=1, axis2=2).real)
        parts.append((weight, deviation, density / (deviation[:, :, None] * deviation[:, None, :])))
    deviation = np.exp(sum(weight * np.log(size) for weight, size, _ in parts))
    coherence = sum(weight * shape for weight, _, shape in parts)
    return NoiseLevels(
        frequency_hz=frozen_float(frequency),
        density=coherence * deviation[:, :, None] * deviation[:, None, :],
        outputs=lower.outputs,
        set_point_per_v=float(lower.set_point_per_v ** (1.0 - share) * upper.set_point_per_v**share),
        orders_hz=tuple(
            float(low ** (1.0 - share) * high**share)
            for low, high in zip(lower.orders_hz, upper.orders_hz, strict=False)
        ),
    )
