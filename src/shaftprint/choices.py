"""Names and numbers that the help of commands shows; the rooms that act on them take them from here.

They stand together so that ``COMMAND --help`` loads none of those rooms.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Final

CLOSED_LOOPS: Final[Mapping[str, str]] = MappingProxyType(
    {"engine": "GAUGE-CLOSED", "motor": "GAUGE-MOTOR", "hybrid": "GAUGE-HYBRID"}
)
"""Names of the closed loops of ships, by what drives the line."""
SAILING_LOOP: Final = "FREE-CLOSED"
"""Name of the closed loop of an engine and a ship that sails free."""
PITCHED_LOOP: Final = "GAUGE-PITCH"
"""Name of the closed loop of an engine and a propeller of controllable pitch, at the quay."""
COMBINED_LOOP: Final = "GAUGE-COMBINATOR"
"""Name of the same with a lever that asks for speed and pitch together."""
CRASH_STOP: Final = "CRASH-STOP"
"""Name of the structure of a ship that is stopped by its clutches."""

NATIVE_ENDINGS: Final = (".nc", ".h5", ".hdf5")
"""Endings of the native container."""
ENDINGS_OF_FORMATS: Final[Mapping[str, tuple[str, ...]]] = MappingProxyType(
    {
        "native": NATIVE_ENDINGS,
        "csv": (".csv",),
        "mat": (".mat",),
        "mdf4": (".mf4",),
        "tdms": (".tdms",),
        "tdms-appended": (".tdms",),
        "lvm": (".lvm",),
        "uff": (".uff", ".unv"),
        "can": (".blf", ".asc", ".log"),
        "nmea2000": (".blf", ".asc", ".log"),
    }
)
"""Endings of the files of each format that can be written; the first of an ending is written where none is named."""
WRITTEN_FORMATS: Final = tuple(ENDINGS_OF_FORMATS)
"""Names of the formats that can be written."""
WRITTEN_ENDINGS: Final = tuple(dict.fromkeys(ending for endings in ENDINGS_OF_FORMATS.values() for ending in endings))
"""Endings of the files that can be written."""

MESSAGES: Final = ("torque", "speed", "set-point")
"""What a simulated ship may send in messages."""
SERVICE_TROUBLES: Final = (
    *("lever-late", "lever-early", "trims", "trims-a-little", "trims-at-moves", "load-controller"),
    *("hidden-load-controller", "lever-once-a-second", "deadband", "orders", "astern", "clutch-out"),
    *("lever-bent", "lever-play", "dynamic-inflow", "gains-by-speed", "delay-in-turns", "governor-deadband"),
    *("demand-rate-limit", "smoke-limiter"),
)
"""What may be wrong with the logs of a simulated ship in service."""
STATED_LIMITS: Final = (
    *("set-point", "rate", "lowest-speed", "highest-speed", "resolution", "cycle", "frequency", "time-over"),
    *("noise-margin", "torque", "motoring", "full-scale", "ripple"),
)
"""Limits of a test that a user may state, by the name that is typed."""
SET_POINT_RATE_HZ: Final = 100.0
"""Samples of a set point a second where nobody says otherwise [Hz]: the steps take 0.2 % of a line of 3.4 Hz."""
LOAD_REPEATABILITY: Final = 0.005
"""Standard deviation of the torque that one propeller takes at one speed from day to day, as a share, beside what the
windows of a test show of it. No test of one day tells it; see docs/watching.md."""
NEWEST_TESTS: Final = 3
"""Tests of a ship that stand for it among its sisters, the newest ones."""
WORK_LIMIT_S: Final = 3600.0
"""How long one recording may take a worker where nothing else is said [s]."""
