"""The truth of a controllable-pitch propeller at the quay: its hydraulics, its blades, its feedback."""

import math
from dataclasses import dataclass

from shaftprint.errors import SettingsError
from shaftprint.tug._pitch_series import torque_over_pitch
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class PitchActuation:
    """How the pitch follows its set point, and what it does to the torque of a propeller without advance.

    The set point acts after a delay; a servo valve moves the piston in proportion to what it lacks, beyond a deadband
    and up to a highest rate; the blades follow the piston through the play of crank pins and sliding blocks.
    """

    lag_s: float = 0.6
    """Time constant of the servo [s]."""
    delay_s: float = 0.15
    """Time after which it begins to follow [s]."""
    rate_per_s: float = 0.06
    """Fastest change of ``P/D`` [1/s]: all of it in 20 to 30 s."""
    deadband: float = 0.0
    """Error of ``P/D`` within which the valve stays shut, to either side."""
    play: float = 0.0
    """Play between piston and blades, all of it, as ``P/D``."""
    set_point_scale: float = 1.0
    """Change of pitch that is reached over that which is asked for by the line of the vessel file."""
    sensor_scale: float = 1.0
    """Change of pitch that the feedback shows over that which there is, over the pitch of the working point."""
    sensor_rms: float = 0.0005
    """Noise of a sample of the feedback, as ``P/D``."""
    sensor_wander_rms: float = 0.0005
    """Slow noise of the feedback, of a wiper, a rod and its joints, as ``P/D``."""
    sensor_wander_s: float = 1.0
    """Time in which the slow noise forgets what it was [s]."""
    torque_powers: tuple[float, ...] | None = None
    """``K_Q`` at zero advance: coefficients of ``(P/D)^0, (P/D)^1, ...``, of which only the shape matters; ``None``:
    those of the vessel's series."""


def pitch_torque(actuation: PitchActuation, vessel: Vessel) -> tuple[float, ...]:
    """Return the torque of the propeller over that of the working point: coefficients of the deviation of ``P/D``.

    Raises SettingsError if the truth is not physical, or the vessel file names no series where the truth has no curve.
    """
    _check(actuation)
    powers = torque_over_pitch(vessel) if actuation.torque_powers is None else actuation.torque_powers
    rest = vessel.propeller.pitch_ratio
    # the same polynomial about the pitch of the working point
    about = [
        math.fsum(c * math.comb(k, order) * rest ** (k - order) for k, c in enumerate(powers) if k >= order)
        for order in range(len(powers))
    ]
    if not about[0] > 0.0:
        raise SettingsError(
            f"tug: expected a torque above 0 at the pitch of the working point, P/D = {rest:g}, found K_Q = "
            f"{about[0]:.3g}; correct torque_powers."
        )
    return tuple(coefficient / about[0] for coefficient in about)


def pitch_truth(actuation: PitchActuation, vessel: Vessel) -> dict[str, float]:
    """Return what a test is to find of the pitch, by the names of the symbols."""
    reached = {"c_th": actuation.set_point_scale}
    if vessel.combinator is not None:
        slope = vessel.combinator.combinator_slope(vessel.working_point.engine_speed_rpm)
        reached = {"c_comb": slope * actuation.set_point_scale}
    return {
        "q": vessel.propeller.pitch_ratio * pitch_torque(actuation, vessel)[1],
        "tau_th": actuation.lag_s,
        "t_th": actuation.delay_s,
        **reached,
        "c_pitch": actuation.sensor_scale,
    }


def _check(actuation: PitchActuation) -> None:
    for name in ("lag_s", "rate_per_s", "set_point_scale", "sensor_scale", "sensor_wander_s"):
        value = getattr(actuation, name)
        if not value > 0.0:
            raise SettingsError(f"tug: expected pitch.{name} above 0, found {value:g}; give a positive value.")
    for name in ("delay_s", "deadband", "play", "sensor_rms", "sensor_wander_rms"):
        value = getattr(actuation, name)
        if not value >= 0.0:
            raise SettingsError(f"tug: expected pitch.{name} of at least 0, found {value:g}.")
