"""What the numbers of a fingerprint rest on and no recording can show: it is stated with them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from shaftprint.catalogue import ShipRole
from shaftprint.digits import stated

if TYPE_CHECKING:
    from shaftprint.identify import Identification
    from shaftprint.vessel import Vessel

PERCENT = 100.0


def assumptions_of(identification: "Identification", vessel: "Vessel") -> tuple[str, ...]:
    """Return the assumptions behind the numbers of one fit, in sentences."""
    return tuple(_assumptions(identification, vessel))


def _assumptions(identification: "Identification", vessel: "Vessel") -> Iterator[str]:
    by_role = {parameter.role: parameter.name for parameter in identification.structure.free}
    sensors, propeller = vessel.sensors, vessel.propeller
    if latency := by_role.get(ShipRole.SET_POINT_LATENCY):
        totals = [c.name for c in identification.structure.combinations if c.role == ShipRole.TOTAL_DELAY]
        resting = f"{' and '.join((latency, *totals))} {'rest' if totals else 'rests'}"
        yield (
            f"{resting} on the clock of the set point: a constant shift of {sensors.set_point.channel} against the "
            "other channels shows in nothing else."
        )
    if by_role.get(ShipRole.INERTIA_UPSTREAM) in identification.settings.priors:
        yield (
            "Gains, margins and the parts of the delay rest on the inertia upstream of the gauge, "
            f"{stated(vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2, 'kg m2')}, and on "
            + (
                "an engine torque that hardly changes with speed (g)."
                if vessel.motor is None
                else "a motor torque that does not change with speed."
            )
        )
    scale = sensors.shaft_torque.scale_std
    yield (
        f"What is in N m or kg m2 rests on the scale of the torque gauge, known to {PERCENT * scale:.2g} %; K_Q "
        f"besides on the diameter of the propeller, {propeller.diameter_m:g} m, and a density of "
        f"{vessel.water_density_kg_m3:g} kg/m3."
    )
    if vessel.taken_as_usual:
        yield (
            f"The vessel file does not state, and as usual is taken: {'; '.join(vessel.taken_as_usual)}. State them."
        )
