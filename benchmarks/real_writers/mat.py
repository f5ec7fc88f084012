"""MATLAB files by SciPy (4 to 7), h5py (7.3 as MATLAB lays it out) and mat-io (timetables, tables, durations)."""

import warnings
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import h5py
import numpy as np
import pandas as pd
import scipy.io

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, pick, signal

KINDS = ("f8", "f4", "i1", "u1", "i2", "u2", "i4", "u4", "i8", "?")
_CLASSES = {
    "f8": "double",
    "f4": "single",
    "?": "logical",
    "i1": "int8",
    "u1": "uint8",
    "i2": "int16",
    "u2": "uint16",
    "i4": "int32",
    "u4": "uint32",
    "i8": "int64",
}


def _vector(rng: np.random.Generator, count: int, kind: str) -> Any:
    values = signal(rng, count)
    if kind == "?":
        return values > 0.0
    return np.abs(values).astype(kind) if kind[0] == "u" else values.astype(kind)


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    count, rate = int(rng.integers(100, 400)), float(pick(rng, 10.0, 100.0, 2000.0))
    times, version = grid(count, rate), str(options.get("version", "5"))
    if options.get("object"):
        return _objects(path, rng, options, times)
    clock, where = str(options.get("clock", "t")), str(options.get("where", "top"))
    values: dict[str, Any] = {}
    wanted: dict[str, TrueChannel] = {}
    for number in range(int(options.get("signals", 2))):
        kind = str(options.get("kind") or pick(rng, *KINDS))
        if version == "4" and kind == "?":
            kind = "f8"
        one = _vector(rng, count, kind)
        values[f"M_{number}"] = one
        values[f"M_{number}_unit"] = "Nm"
        wanted[f"M_{number}"] = TrueChannel(times_s=times, values=one.astype(float), unit="N m", time_rounding_s=1e-6)
    began = None
    match clock:
        case "t" | "time":
            values[clock] = times
        case "time_ms":
            values["time_ms"] = 1e3 * times
        case "fs":
            values["fs"] = rate
        case "dt":
            values["dt"] = 1.0 / rate
        case "datenum":
            # 5 March 2026, 9:00
            values["time"] = 740046.375 + times / 86400.0
            began = datetime.fromisoformat("2026-03-05T09:00")
            wanted = {name: replace(one, time_rounding_s=2e-4) for name, one in wanted.items()}
        case "epoch":
            values["time"] = 1772701200.0 + times
            began = datetime(2026, 3, 5, 9, tzinfo=UTC)
    if options.get("text"):
        values["note"] = "sea trial"
    if version == "7.3":
        _like_matlab(path, {"log": values} if where == "struct" else values, column=bool(options.get("column", True)))
    else:
        content: dict[str, Any] = {"log": values} if where == "struct" and version == "5" else values
        scipy.io.savemat(
            path,
            content,
            format=version,
            do_compression=bool(options.get("compressed", False)),
            oned_as="column" if options.get("column", True) else "row",
        )
    return Truth(channels=wanted, began=began, others=("note",))


def _like_matlab(path: Path, values: dict[str, Any], *, column: bool) -> None:
    def put(folder: Any, name: str, value: Any) -> None:
        if isinstance(value, dict):
            group = folder.create_group(name)
            group.attrs["MATLAB_class"] = np.bytes_(b"struct")
            for key, inner in value.items():
                put(group, key, inner)
        elif isinstance(value, str):
            one = folder.create_dataset(name, data=np.array([[ord(letter)] for letter in value], dtype="<u2"))
            one.attrs["MATLAB_class"] = np.bytes_(b"char")
            one.attrs["MATLAB_int_decode"] = np.int32(2)
        else:
            array = np.atleast_1d(value)
            kind = "?" if array.dtype == bool else array.dtype.str[1:]
            stored = array.astype("u1") if kind == "?" else array
            one = folder.create_dataset(name, data=stored.reshape((1, -1) if column else (-1, 1)))
            one.attrs["MATLAB_class"] = np.bytes_(_CLASSES[kind].encode())
            if kind == "?":
                one.attrs["MATLAB_int_decode"] = np.int32(1)

    with h5py.File(path, "w", userblock_size=512) as file:
        for key, value in values.items():
            put(file, key, value)
    with path.open("r+b") as raw:
        raw.write(b"MATLAB 7.3 MAT-file, Platform: GLNXA64".ljust(124) + b"\x00\x02IM")


def _objects(path: Path, rng: np.random.Generator, options: Options, times: Any) -> Truth:
    import matio

    what, version = str(options["object"]), str(options.get("container", "v7"))
    values = signal(rng, len(times))
    steps = np.rint(times * 1e9).astype("timedelta64[ns]")
    began = None
    if what == "timetable":
        content: Any = {"tt": pd.DataFrame({"M_s": values}, index=pd.to_timedelta(steps).rename("Time"))}
    elif what == "dates":
        index = pd.DatetimeIndex(np.datetime64("2026-03-05T09:00", "ns") + steps).rename("Time")
        content = {"tt": pd.DataFrame({"M_s": values}, index=index)}
        began = datetime.fromisoformat("2026-03-05T09:00")
    elif what == "duration":
        content = {"time": steps.reshape(-1, 1), "M_s": values.reshape(-1, 1)}
    else:
        content = {"tab": pd.DataFrame({"time": times, "M_s": values, "note": ["a"] * len(times)})}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        matio.save_to_mat(str(path), content, version=version)
    return Truth(
        channels={"M_s": TrueChannel(times_s=times, values=values, time_rounding_s=1e-4)}, began=began, others=("note",)
    )


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    if rng.random() < 0.15:
        return {"object": pick(rng, "timetable", "dates", "duration", "table"), "container": pick(rng, "v7", "v7.3")}
    return {
        "version": pick(rng, "4", "5", "5", "7.3"),
        "clock": pick(rng, "t", "time", "time_ms", "fs", "dt", "datenum", "epoch"),
        "where": pick(rng, "top", "struct"),
        "compressed": pick(rng, False, True),
        "column": pick(rng, False, True),
        "text": pick(rng, False, True),
        "signals": int(rng.integers(1, 5)),
    }


EXTREMES: tuple[Options, ...] = (
    *({"version": version, "kind": kind} for version in ("5", "7.3") for kind in KINDS),
    *({"version": "4", "kind": kind} for kind in ("f8", "f4", "i2", "u1")),
    *(
        {"clock": clock, "version": version}
        for clock in ("time", "time_ms", "fs", "dt", "datenum", "epoch")
        for version in ("5", "7.3")
    ),
    *(
        {"where": "struct", "version": version, "column": column}
        for version in ("5", "7.3")
        for column in (False, True)
    ),
    *(
        {"object": what, "container": version}
        for what in ("timetable", "dates", "duration", "table")
        for version in ("v7", "v7.3")
    ),
    {"compressed": True, "signals": 5},
)
FAMILY = Family(
    name="MATLAB",
    writer="SciPy, h5py, mat-io",
    suffix=".mat",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=60,
    damaged=250,
    protects="compressed streams in version 7; sizes of variables",
)
