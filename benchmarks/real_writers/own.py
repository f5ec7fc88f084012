"""Formats that no library of others writes whole, by our own writers or by hand: for the damaged copies alone."""

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import can
import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, pick, signal
from shaftprint.recording import write_by_ending
from shaftprint.recording._from_arrays import Samples, recording_from_arrays
from shaftprint.recording._journal import JournalWriter

SUFFIXES = (".nc", ".lvm", ".journal", ".log")
RATE_HZ, BLOCK = 100.0, 20
# NMEA 2000, engine parameters, rapid update, priority 2, sender 10
BESIDE = {"Boost pressure": "Pa", "Tilt or trim": "%"}
RAPID, RPM_OF_A_COUNT, FIRST_S = 0x09F2000A, 0.25, 1783069200.0


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    if path.suffix == ".log":
        return _nmea_2000(path, rng)
    count, names = BLOCK * int(rng.integers(5, 30)), ("M_s", "n")[: int(str(options["signals"]))]
    values = {name: np.round(signal(rng, count), 3) for name in names}
    if path.suffix == ".journal":
        head = {"unit": "N m", "rate_hz": RATE_HZ, "scale": 1.0, "offset": 0.0, "dtype": "float64"}
        with JournalWriter(path, {"channels": [{"name": name, **head} for name in names]}) as journal:
            for block in range(count // BLOCK):
                part = slice(block * BLOCK, (block + 1) * BLOCK)
                journal.block(block, block * BLOCK / RATE_HZ, BLOCK / RATE_HZ, [one[part] for one in values.values()])
    else:
        path.touch()
        samples = [Samples(name=name, values=one, unit="N m", rate_hz=RATE_HZ) for name, one in values.items()]
        with recording_from_arrays(path, samples, format="arrays") as recording:
            write_by_ending(path, recording.channels.values(), overwrite=True)
    rounding = 5.1e-7 if path.suffix == ".lvm" else 0.0
    shared: dict[str, Any] = {"times_s": grid(count, RATE_HZ), "unit": "N m", "rounding": rounding}
    return Truth(channels={name: TrueChannel(values=one, **shared) for name, one in values.items()})


def _nmea_2000(path: Path, rng: np.random.Generator) -> Truth:
    counts = np.rint(4000.0 + signal(rng, 300)).astype(int)
    times = grid(counts.size, 10.0)
    with can.Logger(str(path)) as logger:
        for time_s, sent in zip(times.tolist(), counts.tolist(), strict=True):
            content = [0, sent & 0xFF, sent >> 8, 0xFF, 0xFF, 0x7F, 0xFF, 0xFF]
            frame = can.Message(timestamp=FIRST_S + time_s, arbitration_id=RAPID, data=content, channel=0)
            logger.on_message_received(frame)
    channel = TrueChannel(times_s=times, values=RPM_OF_A_COUNT * counts, unit="rpm", time_rounding_s=2e-6)
    # what the message holds besides, sent as not available
    others = {name: replace(channel, values=np.full(times.size, np.nan), unit=unit) for name, unit in BESIDE.items()}
    return Truth(channels={"Engine speed": channel, **others}, began=datetime.fromtimestamp(FIRST_S, UTC))


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    return {"suffix": pick(rng, *SUFFIXES), "signals": int(rng.integers(1, 3))}


FAMILY = Family(
    name="own",
    writer="own writers",
    suffix=".nc",
    write=write,
    extremes=tuple({"suffix": suffix, "signals": signals} for suffix in SUFFIXES for signals in (1, 2)),
    drawn=drawn,
    files=24,
    damaged=100,
    protects="native container and journal: checksums",
    is_own=True,
)
