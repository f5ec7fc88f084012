"""Where the search for an elastic line begins: at the rigid line that was found, with modes all over the lines.

A mode is a narrow valley in the cost: a start whose mode lies between other lines does not see it, and starts that are
drawn between the bounds hardly ever have governor and mode right at once.
"""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._structure import Structure

_MODES, _LOWEST_HZ = 16, 1.0
# Modes beyond the highest line that still show, as multiples of it: the twist itself shows from a third of the mode on
# where a speed ahead of the coupling stands beside a torque behind it, else what it does to the loop alone.
_BEYOND = {"GAUGE-ELASTIC": 1.5, "GAUGE-ELASTIC-ENGINE": 3.0}
# Share of the line that either body has at least, and inertia time of the line [s].
_LEAST_BODY, _LEAST_LINE_S = 0.01, 0.01
# Of rubber couplings.
_DAMPING_RATIO = 0.07
# Optima of the rigid line that are taken along.
_OPTIMA = 3


def highest_hz(fit: Identification) -> float:
    """Return the highest frequency of the lines that were fitted [Hz]."""
    return max(float(np.max(one.s.imag)) for one in fit.objective.experiments) / (2.0 * np.pi)


def beyond_lines(elastic: Structure) -> float:
    """Return up to which multiple of the highest line a mode of an elastic line shows."""
    return _BEYOND[elastic.name]


def with_elastic_starts(settings: Settings, elastic: Structure, rigid: Identification) -> Settings:
    """Return settings with starts at the optima of the rigid line for modes up to beyond the lines, and those before.

    ``settings``: how the elastic line is fitted; its priors give the start of what the rigid line does not have.
    ``elastic``: the elastic line. ``rigid``: the fit of the rigid one.
    """
    modes_hz = np.geomspace(_LOWEST_HZ, beyond_lines(elastic) * highest_hz(rigid), _MODES)
    optima = [dict(zip(rigid.objective.names, one.values.tolist(), strict=True)) for one in rigid.clusters[:_OPTIMA]]
    starts = [_start(elastic, settings, optimum, float(mode_hz)) for optimum in optima for mode_hz in modes_hz]
    draw = GivenStarts(np.array(starts), settings.draw)
    return replace(settings, starts=settings.starts + len(starts), draw=draw)


def _start(elastic: Structure, settings: Settings, optimum: dict[str, float], mode_hz: float) -> FloatArray:
    """Return the free parameters of the elastic line, as far as they are those of the rigid one, with a mode."""
    stated = {name: prior.mean for name, prior in settings.priors.items()}
    values = {p.name: optimum.get(p.name, stated.get(p.name, p.value)) for p in elastic.parameters}
    upstream, driven, downstream, stiffness, damping = (
        str(elastic.named_as(role))
        for role in (
            ShipRole.INERTIA_UPSTREAM,
            ShipRole.INERTIA_DRIVEN,
            ShipRole.INERTIA_DOWNSTREAM,
            ShipRole.COUPLING_STIFFNESS,
            ShipRole.COUPLING_DAMPING,
        )
    )
    # an optimum of the rigid line may have lost one of its bodies, and nothing swings against nothing
    least = _LEAST_BODY * max(values[upstream] + values[downstream], _LEAST_LINE_S)
    pair = sum(
        1.0 / max(body, least) for body in (values[upstream] - values[driven], values[driven] + values[downstream])
    )
    omega = 2.0 * np.pi * mode_hz
    values |= {stiffness: omega**2 / pair, damping: 2.0 * _DAMPING_RATIO * omega / pair}
    return np.array([values[p.name] for p in elastic.free])
