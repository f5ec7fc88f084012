"""What was tested, as a sketch: governor, engine, gearbox, gauge, pick-ups and propeller, from the vessel file."""

from typing import TYPE_CHECKING

from shaftprint.digits import plain, rounded
from shaftprint.report.sections._sketch import Label, Outline, Sketch, box

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

SHAFT = 92.0
ENGINE_SHAFT, PROPELLER_SHAFT = 288.0, 515.0
DETAIL, PICK_UP = 158.0, 192.0
BLADE = ((588.0, SHAFT), (574.0, SHAFT - 46.0), (596.0, SHAFT - 50.0), (600.0, SHAFT), (614.0, SHAFT + 46.0))


def line_sketch(vessel: "Vessel") -> Sketch:
    """Return the sketch of a propulsion line."""
    machine = vessel.machine
    return Sketch(
        width=640.0,
        height=204.0,
        alt=_alt(vessel),
        outlines=(
            box(8.0, 64.0, 104.0, 56.0),
            Outline(points=((112.0, SHAFT), (142.0, SHAFT)), arrow=True),
            box(144.0, 46.0, 118.0, 92.0),
            Outline(points=((262.0, SHAFT), (314.0, SHAFT)), heavy=True),
            box(314.0, 56.0, 92.0, 72.0),
            Outline(points=((406.0, SHAFT), (590.0, SHAFT)), heavy=True),
            box(446.0, 78.0, 26.0, 28.0, filled=True),
            Outline(points=((459.0, 78.0), (459.0, 42.0))),
            Outline(points=(*BLADE, (592.0, SHAFT + 50.0)), closed=True, filled=True),
            *_pick_ups(vessel, "engine", ENGINE_SHAFT),
            *_pick_ups(vessel, "propeller", PROPELLER_SHAFT),
        ),
        labels=(
            Label(x=60.0, y=99.0, text="Governor" if vessel.motor is None else "Controller"),
            Label(x=203.0, y=99.0, text=machine.word.capitalize()),
            Label(x=203.0, y=DETAIL, text=f"{plain(machine.rated_power_kw, 0)} kW"),
            Label(x=360.0, y=99.0, text="Gearbox" if vessel.gearbox.ratio != 1.0 else "No gearbox"),
            Label(x=360.0, y=DETAIL, text=f"{rounded(vessel.gearbox.ratio, 3)} : 1"),
            Label(x=459.0, y=34.0, text="Torque gauge"),
            Label(x=592.0, y=24.0, text="Propeller"),
            Label(x=592.0, y=DETAIL + 8.0, text=f"{rounded(vessel.propeller.diameter_m, 3)} m"),
            *_pick_up_labels(vessel),
        ),
    )


def _count(vessel: "Vessel", shaft: str) -> int:
    return sum(sensor.shaft == shaft for sensor in vessel.sensors.speed)


def _pick_ups(vessel: "Vessel", shaft: str, x: float) -> list[Outline]:
    """Return the mark of the pick-ups of one shaft, a triangle that points at it, and the way to its label."""
    if not _count(vessel, shaft):
        return []
    tip, foot = SHAFT + 6.0, SHAFT + 24.0
    return [
        Outline(points=((x, tip), (x - 9.0, foot), (x + 9.0, foot)), closed=True, filled=True),
        Outline(points=((x, foot), (x, PICK_UP - 18.0))),
    ]


def _pick_up_labels(vessel: "Vessel") -> list[Label]:
    labels = []
    for shaft, x in (("engine", ENGINE_SHAFT), ("propeller", PROPELLER_SHAFT)):
        count = _count(vessel, shaft)
        if count:
            labels.append(Label(x=x, y=PICK_UP, text="Speed pick-up" if count == 1 else f"{count} speed pick-ups"))
    return labels


def _alt(vessel: "Vessel") -> str:
    shafts = {"engine": vessel.machine.word, "propeller": "propeller"}
    where = [f"{_count(vessel, shaft)} on the {name} shaft" for shaft, name in shafts.items()]
    governor = "governor" if vessel.motor is None else "speed controller"
    return (
        f"Sketch of the line from left to right: {governor}, {vessel.machine.word}, gearbox, "
        "torque gauge on the propeller shaft, "
        f"propeller. Speed pick-ups: {' and '.join(where)}."
    )
