"""Text by pandas, csv, NumPy, pyarrow and FMPy."""

import csv
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any
from zoneinfo import ZoneInfo

import numpy as np
import pandas as pd

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, pick, signal

DATES = (
    "%Y-%m-%d %H:%M:%S.%f",
    "%Y-%m-%dT%H:%M:%S.%f",
    "%d.%m.%Y %H:%M:%S.%f",
    "%Y/%m/%d %H:%M:%S.%f",
    "%m/%d/%Y %H:%M:%S.%f",
    "%d/%m/%Y %H:%M:%S.%f",
    "%d-%b-%Y %H:%M:%S.%f",
    "%Y-%m-%d %I:%M:%S.%f %p",
    "%d-%m-%Y %H:%M:%S.%f",
    "%H:%M:%S.%f",
    "%Y%m%dT%H%M%S.%f",
    "%d.%m.%y %H:%M:%S.%f",
)


def _times(clock: str, times: Any, stamp: str) -> tuple[str, Any, datetime | None]:
    """Return title and column of the times, and the date of the first."""
    zone = {"utc": UTC, "zone": ZoneInfo("Europe/Amsterdam")}.get(str(clock))
    if clock in ("date", "utc", "zone"):
        index = pd.DatetimeIndex(
            np.datetime64("2026-03-05T09:00:00", "ns") + np.rint(times * 1e9).astype("timedelta64[ns]")
        )
        began = None if stamp.startswith("%H") else datetime.fromisoformat("2026-03-05T09:00")
        if zone is not None:
            index = index.tz_localize("UTC").tz_convert(zone)
            began = datetime(2026, 3, 5, 9, tzinfo=UTC)
        return "Timestamp", index, began
    if clock == "ms":
        return "time [ms]", 1e3 * times, None
    if clock == "epoch_ms":
        return "timestamp", np.rint(1772701200e3 + 1e3 * times).astype(np.int64), datetime(2026, 3, 5, 9, tzinfo=UTC)
    if clock == "excel":
        return "Date", 46086.375 + times / 86400.0, datetime.fromisoformat("2026-03-05T09:00")
    return "time [s]", times, None


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    count, rate = int(options.get("count", rng.integers(60, 400))), float(pick(rng, 10.0, 100.0, 200.0))
    times, by = grid(count, rate), str(options.get("by", "pandas"))
    if by == "fmpy":
        return _by_fmpy(path, rng, times)
    stamp = str(options.get("stamp", DATES[0]))
    title, column, began = _times(str(options.get("clock", "s")), times, stamp)
    data: dict[str, Any] = {title: column}
    channels: dict[str, TrueChannel] = {}
    digits = options.get("float_format")
    mark = str(options["na"]) if "99" in str(options.get("na", "")) else ""
    is_rough = digits is not None or options.get("clock") == "excel"
    time_rounding_s = 0.6e-2 if str(digits).endswith("e") else 0.6e-3 if is_rough else 2e-6
    for number in range(int(options.get("signals", 2))):
        values = signal(rng, count, size=float(options.get("size", 100.0)))
        if options.get("gaps"):
            values[rng.random(count) < 0.1] = np.nan
        data[f"M_{number} [Nm]" if options.get("titled_units", True) else f"M_{number}"] = values
        rounding = 0.0 if digits is None else 0.051 if str(digits).endswith("e") else 0.51e-3
        channels[f"M_{number}"] = TrueChannel(
            times_s=times,
            values=values,
            unit="N m" if options.get("titled_units", True) else "",
            rounding=rounding,
            mark=mark,
            time_rounding_s=time_rounding_s,
        )
    if options.get("words"):
        data["state"] = ["run" if k % 2 else "stop" for k in range(count)]
    frame = pd.DataFrame(data)
    encoding = str(options.get("encoding", "utf-8"))
    _save(frame, path, by, encoding, options)
    if by == "numpy":
        channels = {name: replace(one, time_rounding_s=0.0) for name, one in channels.items()}
    if options.get("units_row"):
        lines = path.read_text(encoding=encoding).split("\n")
        sep = str(options.get("sep", ","))
        lines.insert(1, sep.join(["s"] + ["Nm"] * len(channels)))
        path.write_text("\n".join(lines), encoding=encoding)
        channels = {name: replace(one, unit="N m") for name, one in channels.items()}
    return Truth(channels=channels, began=began, others=("state",))


def _save(frame: pd.DataFrame, path: Path, by: str, encoding: str, options: Options) -> None:
    """Let a library write a table."""
    if by == "arrow":
        import pyarrow as pa
        import pyarrow.csv

        pyarrow.csv.write_csv(pa.Table.from_pandas(frame, preserve_index=False), path)
    elif by == "csv":
        dialect: Any = options.get("dialect", "excel")
        with path.open("w", newline="", encoding=encoding) as file:
            writer = csv.writer(file, dialect=dialect)
            writer.writerow(list(frame.columns))
            writer.writerows(frame.itertuples(index=False))
    elif by == "numpy":
        header = str(options.get("sep", " ")).join(name.replace(" ", "") for name in frame.columns)
        np.savetxt(path, frame.to_numpy(), header=header, delimiter=str(options.get("sep", " ")))
    else:
        frame.to_csv(
            path,
            sep=str(options.get("sep", ",")),
            decimal=str(options.get("decimal", ".")),
            index=bool(options.get("index", False)),
            quoting=int(options.get("quoting", csv.QUOTE_MINIMAL)),
            encoding=encoding,
            date_format=None if options.get("clock") in ("utc", "zone") else str(options.get("stamp", DATES[0])),
            lineterminator=str(options.get("line", "\n")),
            float_format=options.get("float_format"),
            na_rep=str(options.get("na", "")),
            compression=options.get("compression"),
        )


def _by_fmpy(path: Path, rng: np.random.Generator, times: Any) -> Truth:
    from fmpy.util import write_csv

    rows = np.zeros(len(times), dtype=[("time", "f8"), ("M_s", "f8"), ("is_on", "?")])
    rows["time"], rows["M_s"] = times, signal(rng, len(times))
    rows["is_on"] = rows["M_s"] > 0.0
    write_csv(str(path), rows)
    return Truth(
        channels={
            "M_s": TrueChannel(times_s=times, values=rows["M_s"]),
            "is_on": TrueChannel(times_s=times, values=rows["is_on"].astype(float)),
        }
    )


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    sep = pick(rng, ",", ";", "\t", "|")
    clock = pick(rng, "s", "s", "ms", "epoch_ms", "date", "utc", "zone", "excel")
    return {
        "sep": sep,
        "decimal": "," if sep in ";\t|" and rng.random() < 0.5 else ".",
        "clock": clock,
        "stamp": pick(rng, *DATES[:4], DATES[7]),
        "index": pick(rng, False, True),
        "quoting": pick(rng, 0, 1, 2),
        "encoding": pick(rng, "utf-8", "utf-8-sig", "cp1252", "utf-16", "latin-1"),
        "line": pick(rng, "\n", "\r\n"),
        "gaps": pick(rng, False, True),
        "na": pick(rng, "", "NaN", "n/a", "-"),
        "words": pick(rng, False, True),
        "signals": int(rng.integers(1, 6)),
        "float_format": pick(rng, None, None, "%.3f") if clock == "s" else None,
    }


EXTREMES: tuple[Options, ...] = (
    *({"clock": "date", "stamp": stamp} for stamp in DATES),
    *({"clock": "date", "stamp": stamp, "signals": 1} for stamp in (DATES[0], DATES[7])),
    *({"clock": clock} for clock in ("ms", "epoch_ms", "excel", "utc", "zone")),
    *({"sep": sep, "decimal": ","} for sep in (";", "\t", "|")),
    *({"quoting": quoting} for quoting in (0, 1, 2, 3)),
    {"quoting": 1, "sep": ";", "decimal": ","},
    *({"encoding": encoding} for encoding in ("utf-8-sig", "utf-16", "utf-16-le", "cp1252", "latin-1", "utf-32")),
    {"line": "\r\n"},
    {"line": "\r"},
    {"index": True},
    {"words": True, "signals": 4},
    {"units_row": True, "titled_units": False},
    {"units_row": True, "titled_units": False, "sep": ";", "decimal": ","},
    *({"gaps": True, "na": na} for na in ("", "NaN", "n/a", "null", "-", "--")),
    *({"gaps": True, "na": na, "signals": 3} for na in ("-9999", "-999.25", "9999")),
    {"compression": "gzip"},
    {"size": 1e300},
    {"size": 1e-300},
    {"count": 3},
    {"count": 1},
    {"float_format": "%.3e"},
    *({"by": "csv", "dialect": dialect} for dialect in ("excel", "excel-tab", "unix")),
    *({"by": "numpy", "sep": sep} for sep in (" ", ",", "\t")),
    {"by": "arrow"},
    {"by": "arrow", "clock": "date"},
    {"by": "fmpy"},
)
FAMILY = Family(
    name="text",
    writer="pandas, csv, NumPy, pyarrow, FMPy",
    suffix=".csv",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=110,
    damaged=300,
    protects="number of fields a row",
)
