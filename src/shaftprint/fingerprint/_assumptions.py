"""What the numbers of a fingerprint rest on and no recording can show: it is stated with them."""

from collections.abc import Iterator
from typing import TYPE_CHECKING

from shaftprint.catalogue import ShipRole
from shaftprint.digits import stated
from shaftprint.identify.judgement import listed, unseen_drift
from shaftprint.units import MILLI

if TYPE_CHECKING:
    from shaftprint.identify import Identification
    from shaftprint.vessel import Vessel

PERCENT = 100.0
# So much is in the intervals already, as the resolution of a delay.
LEAST_S = 0.0005


def assumptions_of(identification: "Identification", vessel: "Vessel") -> tuple[str, ...]:
    """Return the assumptions behind the numbers of one fit, in sentences."""
    return tuple(_assumptions(identification, vessel))


def _assumptions(identification: "Identification", vessel: "Vessel") -> Iterator[str]:
    by_role = {parameter.role: parameter.name for parameter in identification.structure.free}
    sensors, propeller = vessel.sensors, vessel.propeller
    if latency := by_role.get(ShipRole.SET_POINT_LATENCY):
        totals = [c.name for c in identification.structure.combinations if c.role == ShipRole.TOTAL_DELAY]
        resting = f"{' and '.join((latency, *totals))} {'rest' if totals else 'rests'}"
        channel = sensors.set_point.channel
        yield (
            f"{resting} on the clock of the set point, and on no filter and no hold between the voltage that the "
            f"governor sees and {channel}: {_widths(identification)}a constant shift of {channel} against the other "
            "channels shows in nothing else."
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


def _widths(identification: "Identification") -> str:
    """Return what to count beside the intervals for what the recording cannot exclude."""
    response = identification.response
    clock_s = unseen_drift(identification) * float(response.middle_s.max(initial=0.0))
    widths = [
        (response.input_late_s or 0.0, "a filter or hold that its sines would not show"),
        (clock_s, "a clock of its own"),
    ]
    parts = [f"{MILLI * late_s:.2g} ms for {what}" for late_s, what in widths if late_s > LEAST_S]
    return f"count {listed(parts)} beside their intervals; " if parts else ""
