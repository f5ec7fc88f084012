"""The noise that is assumed of a ship without a recording: that of the simulated ship that is most like it."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import IdentificationError
from shaftprint.identify.prediction._noise_at_speeds import noise_at
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.identify.prediction._noise_of_line import noise_of_line
from shaftprint.models._structure import Structure
from shaftprint.models._working_point import at_working_point
from shaftprint.signals._channel_signals import HIGHEST_SHARE_OF_RATE
from shaftprint.signals._moved_beside import moved_beside
from shaftprint.spectra._line_responses import NOT_MEASURED_STD
from shaftprint.survey._shipped_noise import (
    COMBINATOR_NOISE,
    PITCH_NOISE,
    RESEARCH_VESSEL_NOISE,
    STAN_TUG_LINE,
    STAN_TUG_NOISE,
    STAN_TUG_NOISE_AT_SPEEDS,
    STAN_TUG_NOISE_UNDERWAY,
)
from shaftprint.vessel._vessel import Vessel

# What ships of the same kind have of the density of the simulated ship's noise, 19 of 20 of them.
_LEAST_DENSITY, _MOST_DENSITY = 0.5, 3.0
MIDDLE_DENSITY = math.sqrt(_LEAST_DENSITY * _MOST_DENSITY)
"""Density of the noise of a usual ship over that of the simulated one."""
NOISE_SPREAD = 0.25 * math.log(_MOST_DENSITY / _LEAST_DENSITY) / NORMAL_95
"""Standard deviation of the logarithm of the amplitude of that noise."""
RECORDED_SPREAD = 0.15
"""The same of the noise of a recording of the ship, which is known from few samples and of another hour: so far are
stated deviations from those that follow from it at the true values."""
# Slowest lines of a recording, at whose mean level the noise below them begins.
_MEETING_LINES = 3
_LOG, _PITCH = "v_s", "theta_set"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class AssumedNoise:
    """Noise of a simulated ship, over the values of the working point as everywhere."""

    sines: NoiseLevels
    """Under sines of the speed's set point; one volt is that of the simulated ship."""
    legs: Mapping[float, NoiseLevels]
    """The same in legs, by their speed over that of the working point."""
    beside: Mapping[str, NoiseLevels] = field(default_factory=dict)
    """Under what a campaign moves beside the speed, by its symbol; one volt is that of the vessel file."""
    words: str
    """Where it is from, such as ``noise of the Stan Tug 1205 assumed for Stan Tug 1205, port``."""


def assumed_noise(vessel: Vessel | None = None, campaign: Campaign | None = None) -> AssumedNoise:
    """Return the noise that is assumed of a ship without a recording.

    At the quay it is that of the simulated Stan Tug in bollard pull; underway that of the same tug at 9 knots, with a
    log where the vessel file has one: of its cycle, and of the noise of a value of the tug's. Where a pitch is moved
    at the quay, or a combinator moves it, it is that of the simulated research vessel, with the feedback of the pitch.

    ``vessel``: the installation; the Stan Tug at the quay where it is not given. ``campaign``: what is asked of it, for
    what moves beside the speed.
    """
    whose = "" if vessel is None else f" for {vessel.name}"
    beside = {} if vessel is None or campaign is None else _beside(vessel, campaign)
    if vessel is not None and vessel.is_underway:
        levels, words = _underway(vessel), f"noise of the Stan Tug 1205 underway assumed{whose}"
        return AssumedNoise(sines=levels, legs={1.0: levels}, beside=beside, words=words)
    combined = vessel is not None and vessel.combinator is not None
    if combined or _PITCH in beside:
        levels = COMBINATOR_NOISE if combined else RESEARCH_VESSEL_NOISE
        words = f"noise of the simulated research vessel assumed{whose}"
        return AssumedNoise(sines=levels, legs={1.0: levels}, beside=beside, words=words)
    words = f"noise of the Stan Tug 1205 assumed{whose}"
    return AssumedNoise(sines=STAN_TUG_NOISE, legs=STAN_TUG_NOISE_AT_SPEEDS, beside=beside, words=words)


def noise_of_unknown_ship(vessel: Vessel, structure: Structure, values: Mapping[str, float]) -> AssumedNoise:
    """Return the noise that is usual on a ship of which no recording is there, for a plan of its first test.

    What disturbs the torques of the simulated ship goes through the loop of the line that is assumed, and has the
    middle of the densities that ships of the kind have; how far they are from it says ``NOISE_SPREAD``.

    ``vessel``: the installation. ``structure``: the structure that the test is to find. ``values``: what is assumed of
    the ship, by parameter.
    """
    assumed = assumed_noise(vessel)
    names = {name: role for name, role in structure.roles.items() if role in STAN_TUG_LINE}
    is_closed_loop = assumed.legs is STAN_TUG_NOISE_AT_SPEEDS and len(names) == len(STAN_TUG_LINE)
    measured_at = {name: STAN_TUG_LINE[role] for name, role in names.items()}
    legs = {
        share: noise_of_line(
            level, at_working_point(structure, speed_share=share), measured_at=measured_at, values=values
        )
        if is_closed_loop
        else level
        for share, level in assumed.legs.items()
    }
    return replace(
        assumed,
        legs={share: level.times(MIDDLE_DENSITY) for share, level in legs.items()},
        words=f"{assumed.words}, which may have {_LEAST_DENSITY:g} to {_MOST_DENSITY:g} times its density",
    )


def continued_below(
    recorded: Mapping[float, NoiseLevels], usual: Mapping[float, NoiseLevels]
) -> dict[float, NoiseLevels]:
    """Return recorded noise with what is usual below its slowest line, where a short test has seen nothing.

    What is usual has there the level at which it meets the slowest recorded lines, output by output: the speed is held
    by its governor and the torque wanders, so that neither stays as it was at that line.

    ``recorded``: noise of a recording, by engine speed. ``usual``: noise of a ship of the kind, such as
    ``noise_of_unknown_ship`` states, by the same speed; where it has not the same outputs nothing is continued.
    """
    return {
        speed: _continued(levels, noise_at(usual, speed))
        if usual and set(levels.outputs) <= set(next(iter(usual.values())).outputs)
        else levels
        for speed, levels in recorded.items()
    }


def _continued(levels: NoiseLevels, usual: NoiseLevels) -> NoiseLevels:
    usual = usual.of_outputs(*levels.outputs)
    slower = usual.frequency_hz[usual.frequency_hz < levels.frequency_hz[0]]
    if not slower.size:
        return levels
    shared = levels.frequency_hz[:_MEETING_LINES]
    seen, expected = (
        np.diagonal(one, axis1=1, axis2=2).real for one in (levels.density[:_MEETING_LINES], usual.at(shared))
    )
    scale = np.exp(0.5 * np.mean(np.log(seen / expected), axis=0))
    return replace(
        levels,
        frequency_hz=np.concatenate([slower, levels.frequency_hz]),
        density=np.concatenate([usual.at(slower) * np.outer(scale, scale), levels.density]),
    )


def _beside(vessel: Vessel, campaign: Campaign) -> dict[str, NoiseLevels]:
    """Return the noise under what a campaign moves beside the speed; of an electric machine that of the Stan Tug."""
    return {
        moved.symbol: replace(
            PITCH_NOISE if moved.symbol == _PITCH else STAN_TUG_NOISE, set_point_per_v=moved.share_per_v
        )
        for moved in moved_beside(vessel, campaign)
    }


def _underway(vessel: Vessel) -> NoiseLevels:
    log, speed_m_s = vessel.sensors.ship_speed, vessel.working_point.ship_speed_m_s
    if log is None or speed_m_s is None:
        return STAN_TUG_NOISE_UNDERWAY.of_outputs(*(name for name in STAN_TUG_NOISE_UNDERWAY.outputs if name != _LOG))
    return with_log(
        STAN_TUG_NOISE_UNDERWAY,
        cycle_s=log.cycle_s,
        highest_hz=HIGHEST_SHARE_OF_RATE / log.cycle_s,
        ship_speed_m_s=speed_m_s,
    )


SHIP_SPEED, TORQUE = "v_s", "M_s"
"""Speed of the ship as its log shows it, and torque at the gauge."""
LOG_CYCLE_S, LOG_SPEED_M_S = 0.2, 4.75
"""Time between values of the log of the Stan Tug 1205 [s], and the speed that it shows [m/s]."""
# Faster than this no ship moves.
_SHIP_STANDS_HZ = 0.5
# So near to each other are the frequencies at which a log still shows something and no longer does.
_EDGE = 1e-3


def with_log(levels: NoiseLevels, *, cycle_s: float, highest_hz: float, ship_speed_m_s: float) -> NoiseLevels:
    """Return noise levels of the Stan Tug 1205 as a ship of another speed with a log of another cycle has them.

    White noise of single values spreads over fewer frequencies where values are fewer, and is less of a higher speed.

    ``levels``: levels with the log among the outputs. ``cycle_s``: time from one value of the log to the next [s].
    ``highest_hz``: frequency above which the log shows no line [Hz]. ``ship_speed_m_s``: mean speed of the ship [m/s].
    Raises IdentificationError if the levels have no log, or a number is not positive.
    """
    if SHIP_SPEED not in levels.outputs or not min(cycle_s, highest_hz, ship_speed_m_s) > 0.0:
        raise IdentificationError(
            f"noise of a log: expected {SHIP_SPEED} among the outputs and positive numbers, found "
            f"{', '.join(levels.outputs)}, {cycle_s:g} s, {highest_hz:g} Hz and {ship_speed_m_s:g} m/s."
        )
    place, stated = levels.outputs.index(SHIP_SPEED), levels.frequency_hz
    edges = [one for one in (highest_hz, (1.0 + _EDGE) * highest_hz) if stated[0] < one < stated[-1]]
    frequency = np.union1d(stated, edges)
    density = levels.at(frequency)
    # a log of values closer together than the tug's has, as far as is known, no less noise
    times = max(cycle_s, LOG_CYCLE_S) / LOG_CYCLE_S * (LOG_SPEED_M_S / ship_speed_m_s) ** 2
    # what the torque has no part in is noise of single values, but slowly, where it is the ship that moves
    torque = levels.outputs.index(TORQUE)
    moved = np.abs(density[:, place, torque]) ** 2 / density[:, torque, torque].real
    alone = density[:, place, place].real - moved
    density[:, place, place] += (times - 1.0) * np.minimum(alone, alone[frequency > _SHIP_STANDS_HZ].max())
    lost = frequency > (1.0 + 0.5 * _EDGE) * highest_hz
    density[lost, place, :] = density[lost, :, place] = 0.0
    density[lost, place, place] = NOT_MEASURED_STD**2
    return replace(levels, frequency_hz=frequency, density=density)
