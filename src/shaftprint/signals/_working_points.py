"""Steady states: of the whole recording, and of each leg of a campaign."""

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True, slots=True)
class WorkingPoint:
    """The steady state around which the responses are normalised."""

    engine_speed_rev_s: float
    """Mean engine speed ``n_0`` [rev/s]."""
    shaft_torque_nm: float
    """Shaft torque ``M_s0`` [N m] that the gauge shows at ``n_0`` under the mean load of the recording."""
    engine_speed_std_rev_s: float
    """Standard deviation of ``n_0`` [rev/s]."""
    shaft_torque_std_nm: float
    """Standard deviation of ``M_s0`` [N m], without the gauge's scale error: ``load_std`` and twice that of ``n_0``."""
    set_point_v: float
    """Mean set-point voltage [V] of the stretches that were used."""
    load_std: float
    """Standard deviation of the mean load ``M_s0 / n_0^2`` over its value [-]: the load of a propeller wanders."""
    zero_share: float = 1.0
    """Share of a zero of the gauge that is in ``M_s0`` [-]: more than 1 where the speed swung."""
    unseen_gain: float = 0.0
    """By how much the gain of the gauge may be off that in the other legs and no check would see it, for one standard
    deviation [-]; its sign says which legs are off together."""


@dataclass(frozen=True, kw_only=True, slots=True)
class LegState:
    """The whole periods of a leg that a recording holds, and the steady state about which they move."""

    name: str
    """Name of the leg."""
    start_s: float
    """When the first of its whole periods begins, in seconds of the recording."""
    period_s: float
    """Length of one [s], as the campaign says."""
    periods: int
    """How many follow each other without interruption."""
    working_point: WorkingPoint
    """Mean speed, and the torque that a propeller has there whose mean torque was measured."""

    @property
    def stop_s(self) -> float:
        """When the last one ends [s]."""
        return self.start_s + self.periods * self.period_s
