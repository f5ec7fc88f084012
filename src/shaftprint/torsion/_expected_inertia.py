"""Inertias and inertia times by calculation from the vessel file, each with its uncertainty by source."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from shaftprint.normalisation import inertia_time_s
from shaftprint.torsion._entrained_water import WaterEstimate, water_estimates
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.vessel._inertia import InertiaRow
    from shaftprint.vessel._vessel import Vessel

GAUGE_SCALE = "gauge scale"
SIDES: tuple[tuple[Literal["upstream", "downstream"], str], ...] = (("upstream", "up"), ("downstream", "dn"))


@dataclass(frozen=True, kw_only=True, slots=True)
class ExpectedValue:
    """A number by calculation, with what its uncertainty is made of."""

    name: str
    """Symbol, such as ``tau_dn``."""
    unit: str
    """Unit."""
    value: float
    """Expected value."""
    changes: Mapping[str, float]
    """Change of the number, with sign, for one standard deviation of each source; the sources are independent."""
    meaning: str
    """What it stands for."""

    @property
    def std(self) -> float:
        """Standard deviation of all sources together."""
        return math.hypot(*self.changes.values())

    @property
    def shares(self) -> dict[str, float]:
        """Share of each source in the variance, largest first; they add up to 1."""
        total = self.std**2
        shares = {name: change**2 / total for name, change in self.changes.items()} if total > 0.0 else {}
        return dict(sorted(shares.items(), key=lambda item: -item[1]))


@dataclass(frozen=True, kw_only=True, slots=True)
class WetLine:
    """What one estimate of the entrained water makes of the downstream side."""

    water: WaterEstimate
    """The estimate."""
    downstream_kg_m2: float
    """``I_dn`` [kg m2] with it instead of the water row."""
    downstream_std_kg_m2: float
    """Its standard deviation [kg m2]."""
    tau_dn_s: float
    """``tau_dn`` [s]."""
    tau_dn_std_s: float
    """Its standard deviation [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class ExpectedInertia:
    """What follows from the inertia table of a vessel."""

    sums: tuple[ExpectedValue, ...]
    """Sums of the table, at the propeller shaft [kg m2]."""
    times: tuple[ExpectedValue, ...]
    """``tau_up`` and ``tau_dn`` [s] at the working point."""
    wet: tuple[WetLine, ...]
    """The downstream side by each estimate of the entrained water."""

    def value(self, name: str) -> ExpectedValue | None:
        """Return a sum or inertia time by its name; None if there is none."""
        return next((item for item in (*self.sums, *self.times) if item.name == name), None)


@dataclass(frozen=True, kw_only=True, slots=True)
class InertiaComparison:
    """An inertia by calculation and the one that a test identified."""

    expected: ExpectedValue
    """By calculation."""
    identified: float
    """By the test."""
    identified_std: float
    """Its standard deviation."""
    independent: bool
    """Whether the test identified it without it as a prior."""

    @property
    def deviations(self) -> float:
        """Identified minus calculated over its standard deviation; not a number where they are not independent."""
        together = math.hypot(self.expected.std, self.identified_std)
        return (self.identified - self.expected.value) / together if self.independent and together > 0.0 else math.nan


def expected_inertia(
    vessel: "Vessel", *, engine_speed_rev_s: float | None = None, shaft_torque_nm: float | None = None
) -> ExpectedInertia:
    """Return inertia sums, inertia times and the entrained water of a vessel.

    ``tau = 2 pi I n_s0 / M_s0`` (thesis eq. 2.23). Every row of the table is a separate source. A gauge that shows
    too much makes the inertia times too small; it counts in them as it does in ``priors_from_vessel``.

    Parameters
    ----------
    vessel
        The installation.
    engine_speed_rev_s, shaft_torque_nm
        Measured working point; that of the vessel file when not given.
    """
    point = vessel.working_point
    speed = rev_s_from_rpm(point.engine_speed_rpm) if engine_speed_rev_s is None else engine_speed_rev_s
    torque = point.driving_torque_nm if shaft_torque_nm is None else shaft_torque_nm
    factor = inertia_time_s(1.0, shaft_speed_rev_s=speed / vessel.gearbox.ratio, shaft_torque_nm=torque)
    scale = vessel.sensors.shaft_torque.scale_std
    sides = {side: [row for row in vessel.inertia if row.gauge == side] for side, _ in SIDES}
    times = tuple(_time(vessel, sides[side], index, side, factor, scale) for side, index in SIDES)
    return ExpectedInertia(sums=_sums(vessel), times=times, wet=_wet(vessel, sides["downstream"], factor, scale))


def compare_inertia(
    expected: ExpectedInertia, identified: Mapping[str, tuple[float, float]], *, assumed: frozenset[str] = frozenset()
) -> tuple[InertiaComparison, ...]:
    """Return pairs of a calculated and an identified number of the same name.

    ``identified``: value and standard deviation by name, such as ``tau_dn``. ``assumed``: names of numbers that were
    priors of the test.
    """
    rows = ((item, identified[item.name]) for item in (*expected.times, *expected.sums) if item.name in identified)
    return tuple(
        InertiaComparison(expected=item, identified=value, identified_std=std, independent=item.name not in assumed)
        for item, (value, std) in rows
    )


def _sum(
    vessel: "Vessel", rows: "list[InertiaRow]", name: str, meaning: str, *, own_shaft: bool = False
) -> ExpectedValue:
    ratio = 1.0 if own_shaft else vessel.gearbox.ratio
    return ExpectedValue(
        name=name,
        unit="kg m2",
        value=math.fsum(row.referred_kg_m2(ratio) for row in rows),
        changes={row.name: row.referred_std_kg_m2(ratio) for row in rows if row.referred_std_kg_m2(ratio)},
        meaning=meaning,
    )


def _sums(vessel: "Vessel") -> tuple[ExpectedValue, ...]:
    rows = vessel.inertia
    engine = [row for row in rows if row.shaft == "engine"]
    upstream = [row for row in rows if row.gauge == "upstream"]
    downstream = [row for row in rows if row.gauge == "downstream"]
    propeller = [row for row in rows if row.part == "propeller"]
    sums = [
        _sum(vessel, engine, "I_e", "all on the engine shaft, at the engine shaft", own_shaft=True),
        _sum(vessel, engine, "I_e i^2", "the same at the propeller shaft"),
        _sum(vessel, upstream, "I_up", "upstream of the torque gauge"),
    ]
    if propeller:
        sums.append(_sum(vessel, propeller, "I_p", "propeller as in the table"))
        sums.append(_sum(vessel, [*upstream, *propeller], "I_up + I_p", "the table's total: upstream and propeller"))
    return (
        *sums,
        _sum(vessel, downstream, "I_dn", "downstream of the torque gauge, with shaft and water"),
        _sum(vessel, list(rows), "I_up + I_dn", "the whole line"),
    )


def _time(
    vessel: "Vessel", rows: "list[InertiaRow]", index: str, side: str, factor: float, scale: float
) -> ExpectedValue:
    inertia = _sum(vessel, rows, f"I_{index}", side)
    changes = {name: factor * change for name, change in inertia.changes.items()}
    value = factor * inertia.value
    return ExpectedValue(
        name=f"tau_{index}",
        unit="s",
        value=value,
        changes=changes | ({GAUGE_SCALE: -value * scale} if scale else {}),
        meaning=f"inertia time {side} of the torque gauge",
    )


def _wet(vessel: "Vessel", rows: "list[InertiaRow]", factor: float, scale: float) -> tuple[WetLine, ...]:
    dry = _sum(vessel, [row for row in rows if row.part != "water"], "I_dn", "without water")
    wet = []
    for water in water_estimates(vessel):
        inertia = dry.value + water.water_kg_m2
        std = math.hypot(dry.std, water.std_kg_m2)
        tau = factor * inertia
        wet.append(
            WetLine(
                water=water,
                downstream_kg_m2=inertia,
                downstream_std_kg_m2=std,
                tau_dn_s=tau,
                tau_dn_std_s=math.hypot(factor * std, tau * scale),
            )
        )
    return tuple(wet)
