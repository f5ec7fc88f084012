"""What a vessel file states, field by field, and which of its fields an error comes from.

Two tests share the error of the gauge's scale if their vessel files state the same scale: a zero that was taken anew or
another name of the ship does not make the gauge another one. So a fingerprint keeps the fields, not only the hash.
"""

from collections.abc import Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, TypeAlias

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

FieldValue: TypeAlias = bool | float | str

INERTIA = "inertia."
# Fields of the vessel file by the source of the budget whose error they state. The zero of the gauge is not among them:
# it drifts, and each test has its own.
GAUGE = "sensors.shaft_torque"
BEHIND = {
    "gauge scale": (f"{GAUGE}.unit", f"{GAUGE}.scale_nm_per_unit", f"{GAUGE}.scale_std_fraction"),
    "telemetry latency": (f"{GAUGE}.latency_s", f"{GAUGE}.latency_std_s"),
    "set-point bend": ("sensors.set_point.bend_std",),
    "set-point latency": ("sensors.set_point.latency_s", "sensors.set_point.latency_std_s"),
    "demand latency": ("sensors.demand.latency_s", "sensors.demand.latency_std_s"),
    "rack latency": ("sensors.rack.latency_s", "sensors.rack.latency_std_s"),
}
TVC = "TVC"


def vessel_fields(vessel: "Vessel") -> dict[str, FieldValue]:
    """Return every field that a vessel file states of the ship, by its path such as ``sensors.shaft_torque.zero_nm``.

    Rows of a table that have a name are called by it, such as ``inertia.flywheel.inertia_kg_m2``; others are numbered.
    """
    return dict(_flat("", vessel.model_dump(mode="json", exclude_none=True, exclude={"company"})))


def _flat(path: str, content: object) -> Iterator[tuple[str, FieldValue]]:
    if isinstance(content, Mapping):
        for name, value in content.items():
            yield from _flat(f"{path}.{name}" if path else str(name), value)
    elif isinstance(content, Sequence) and not isinstance(content, str):
        for number, value in enumerate(content, start=1):
            name = value.get("name", number) if isinstance(value, Mapping) else number
            yield from _flat(f"{path}.{name}", value)
    elif isinstance(content, bool | str):
        yield path, content
    elif isinstance(content, int | float):
        yield path, float(content)


def stated_behind(source: str, fields: Mapping[str, FieldValue]) -> tuple[object, ...]:
    """Return what a vessel file states of a source of error; nothing where it states none.

    ``source``: name of a source of the budget. ``fields``: fields of the vessel file, see ``vessel_fields``.
    """
    if source == TVC:
        return _upstream(fields)
    return tuple((name, fields[name]) for name in BEHIND.get(source, ()) if name in fields)


def _upstream(fields: Mapping[str, FieldValue]) -> tuple[object, ...]:
    """Return inertia, deviation and shaft of the masses towards the engine, whatever they are called, and the gear."""
    rows = (path.removesuffix(".gauge") for path, value in fields.items() if _is_upstream(path, value))
    masses = sorted(
        tuple(str(fields.get(f"{row}.{name}", "")) for name in ("shaft", "inertia_kg_m2", "std_kg_m2")) for row in rows
    )
    return (fields.get("gearbox.ratio"), *masses) if masses else ()


def _is_upstream(path: str, value: FieldValue) -> bool:
    return path.startswith(INERTIA) and path.endswith(".gauge") and value == "upstream"


def inertia_in_words(fields: Mapping[str, FieldValue], side: str) -> str:
    """Return what a vessel file states of the inertia on one side of the gauge, where a part is at the engine's shaft.

    Nothing where all is at the propeller shaft, at which inertias are told. ``side``: ``upstream`` or ``downstream``.
    """
    rows = [
        path.removesuffix(".gauge")
        for path, value in fields.items()
        if path.startswith(INERTIA) and path.endswith(".gauge") and value == side
    ]
    at: dict[str, float] = {}
    for row in rows:
        shaft = str(fields.get(f"{row}.shaft", ""))
        at[shaft] = at.get(shaft, 0.0) + float(fields.get(f"{row}.inertia_kg_m2", 0.0))
    ratio = float(fields.get("gearbox.ratio", 1.0))
    if ratio == 1.0 or not at.get("engine"):
        return ""
    words = f"{at['engine']:.3g} kg m2 at the engine shaft, times {ratio:g}^2 at the propeller shaft"
    return words + (f", and {at['propeller']:.3g} kg m2 there" if at.get("propeller") else "")
