"""Logs of a CAN bus by python-can, with a DBC file by cantools or canmatrix as the truth of each signal."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import can
import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, pick, signal

SUFFIXES = (".blf", ".asc", ".trc", ".log", ".mf4")
DBC = """VERSION ""

NS_ :

BS_:

BU_: ECU

BO_ {id} Drive: 8 ECU
{signals}
"""
# start, length, byte order (1 is Intel), sign, factor, offset, low, high
LAYOUTS: dict[str, tuple[tuple[int, int, int, str, float, float], ...]] = {
    "intel": ((0, 16, 1, "+", 0.125, 0.0), (16, 12, 1, "-", 0.5, 0.0), (28, 9, 1, "+", 1.0, -40.0)),
    "motorola": ((7, 16, 0, "+", 0.125, 0.0), (23, 12, 0, "-", 0.5, 0.0), (39, 10, 0, "+", 1.0, -40.0)),
    "wide": ((0, 32, 1, "-", 0.001, 0.0), (39, 32, 0, "-", 0.01, 5.0)),
    "bits": ((0, 1, 1, "+", 1.0, 0.0), (1, 3, 1, "+", 1.0, 0.0), (4, 20, 1, "-", -0.25, 3.0)),
}


def _dbc(path: Path, layout: str, identifier: int, *, mode: str) -> list[tuple[str, float, float]]:
    lines, described = [], []
    if mode == "float":
        lines.append(' SG_ S0 : 0|32@1- (1,0) [0|0] "Nm" Vector__XXX')
        described.append(("S0", 1.0, 0.0))
        lines.append(' SG_ S1 : 39|32@0- (1,0) [0|0] "Nm" Vector__XXX')
        described.append(("S1", 1.0, 0.0))
    elif mode == "multiplexed":
        lines.append(' SG_ Which M : 0|8@1+ (1,0) [0|0] "" Vector__XXX')
        described.append(("Which", 1.0, 0.0))
        for number in range(2):
            lines.append(f' SG_ S{number} m{number} : 8|16@1- (0.5,0) [0|0] "Nm" Vector__XXX')
            described.append((f"S{number}", 0.5, 0.0))
    else:
        for number, (start, length, order, sign, factor, offset) in enumerate(LAYOUTS[layout]):
            lines.append(f' SG_ S{number} : {start}|{length}@{order}{sign} ({factor},{offset}) [0|0] "Nm" Vector__XXX')
            described.append((f"S{number}", factor, offset))
    text = DBC.format(id=identifier | (1 << 31 if identifier > 0x7FF else 0), signals="\n".join(lines))
    if mode == "float":
        text += f"SIG_VALTYPE_ {identifier | (1 << 31 if identifier > 0x7FF else 0)} S0 : 1;\n"
        text += f"SIG_VALTYPE_ {identifier | (1 << 31 if identifier > 0x7FF else 0)} S1 : 1;\n"
    path.write_text(text)
    return described


def _raw(one: Any, wave: float, mode: str) -> float:
    """Return the number that a signal sends."""
    if mode == "float":
        return float(np.float32(wave))
    top = 2 ** (one.length - 1) - 1 if one.is_signed else 2**one.length - 2
    return int(np.clip(wave if one.is_signed else abs(wave), -top, top))


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file and the DBC file beside it."""
    import cantools

    suffix = str(options.get("suffix", ".blf"))
    log = path.with_name(path.name.removesuffix("".join(path.suffixes)) + suffix)
    layout, mode = str(options.get("layout", "intel")), str(options.get("mode", "plain"))
    identifier = 0x18FF1023 if options.get("extended") else 0x123
    beside = log.with_suffix(".dbc")
    described = _dbc(beside, layout, identifier, mode=mode)
    database: Any = cantools.database.load_file(str(beside), strict=False)
    message = database.messages[0]
    count, rate = 300, 50.0
    first = datetime(2026, 7, 3, 9, tzinfo=UTC).timestamp()
    times = np.arange(count) / rate
    if options.get("jitter", True):
        times = times + 0.1 / rate * rng.random(count)
    times = np.rint(times * 1e4) / 1e4
    values: dict[str, list[float]] = {name: [] for name, _, _ in described}
    at: dict[str, list[float]] = {name: [] for name, _, _ in described}
    waves = {name: signal(rng, count) for name, _, _ in described}
    with can.Logger(str(log)) as logger:
        for k in range(count):
            content: dict[str, float] = {}
            for name, factor, offset in described:
                if mode == "multiplexed" and name[0] == "S" and int(name[1]) != k % 2:
                    continue
                raw = k % 2 if name == "Which" else _raw(message.get_signal_by_name(name), waves[name][k], mode)
                value = raw * factor + offset
                content[name] = value
                values[name].append(value)
                at[name].append(float(times[k]))
            data = message.encode(content, strict=False, scaling=True)
            frame = can.Message(
                timestamp=float(first + times[k]),
                arbitration_id=identifier,
                is_extended_id=identifier > 0x7FF,
                data=data,
                channel=int(options.get("bus", 0)),
                is_fd=bool(options.get("fd", False)),
                is_rx=True,
            )
            logger.on_message_received(frame)
    if log != path:
        path.symlink_to(log.name)
    channels = {
        name: TrueChannel(
            times_s=np.array(at[name]),
            values=np.array(values[name]),
            unit="" if name == "Which" else "N m",
            time_rounding_s=1.1e-3 if suffix.startswith(".asc") else 2e-4,
        )
        for name, _, _ in described
    }
    # candump counts from 1970, the others write a date without a zone
    began = datetime(2026, 7, 3, 9, tzinfo=UTC if suffix.startswith(".log") else None)
    return Truth(channels=channels, began=began, hints={"dbc": str(beside)})


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    mode = pick(rng, "plain", "plain", "float", "multiplexed")
    return {
        "suffix": pick(rng, *SUFFIXES),
        "layout": pick(rng, *LAYOUTS),
        "mode": mode,
        "extended": pick(rng, False, True),
        "bus": int(rng.integers(0, 3)),
        "fd": rng.random() < 0.2,
    }


EXTREMES: tuple[Options, ...] = (
    *({"suffix": suffix, "layout": layout} for suffix in SUFFIXES for layout in LAYOUTS),
    *({"suffix": suffix, "mode": mode} for suffix in SUFFIXES for mode in ("float", "multiplexed")),
    *({"suffix": suffix, "extended": True, "bus": 2} for suffix in SUFFIXES),
    *({"suffix": suffix, "jitter": False} for suffix in (".csv", ".db")),
    {"suffix": ".log.gz"},
    {"suffix": ".asc.gz"},
)
FAMILY = Family(
    name="CAN logs",
    writer="python-can, cantools",
    suffix=".blf",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=60,
    damaged=250,
    protects="BLF: compressed containers; text: lengths of frames",
)
