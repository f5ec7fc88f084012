"""What the file of an electric line calls a motor, by the names that all of shaftprint has for engine and motor alike.

A file with a table ``[motor]`` says ``shaft = "motor"`` and ``motor_speed_rpm`` where that of a diesel says ``engine``.
"""

from collections.abc import Mapping
from typing import Any

_SPEED, _COMMON_SPEED = "motor_speed_rpm", "engine_speed_rpm"


def in_file_words(content: Any) -> Any:
    """Return what was read of a vessel file with the motor's shaft named as that of an engine; others as they are."""
    if not isinstance(content, Mapping) or "motor" not in content:
        return content
    common = dict(content)
    point = content.get("working_point")
    if isinstance(point, Mapping) and _SPEED in point and _COMMON_SPEED not in point:
        common["working_point"] = {_COMMON_SPEED if key == _SPEED else key: value for key, value in point.items()}
    if "inertia" in content:
        common["inertia"] = _of_one_shaft(content["inertia"])
    sensors = content.get("sensors")
    if isinstance(sensors, Mapping) and "speed" in sensors:
        common["sensors"] = {**sensors, "speed": _of_one_shaft(sensors["speed"])}
    return common


def _of_one_shaft(rows: Any) -> Any:
    if not isinstance(rows, list | tuple):
        return rows
    return [
        {**row, "shaft": "engine"} if isinstance(row, Mapping) and row.get("shaft") == "motor" else row for row in rows
    ]
