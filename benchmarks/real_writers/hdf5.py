"""HDF5 by h5py."""

from pathlib import Path
from typing import Any

import h5py
import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, counts, grid, pick, signal

KINDS = ("<i1", "<u1", "<i2", ">i2", "<u2", ">i4", "<u4", "<i8", ">f4", "<f4", "<f8", ">f8", "<f2")
LAYOUTS: tuple[dict[str, Any], ...] = (
    {},
    {"chunks": (7,)},
    {"chunks": True, "compression": "gzip", "compression_opts": 9},
    {"chunks": True, "compression": "lzf"},
    {"chunks": True, "shuffle": True, "compression": "gzip"},
    {"chunks": True, "fletcher32": True},
    {"maxshape": (None,), "chunks": (64,)},
)


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    count, rate = int(rng.integers(100, 400)), float(pick(rng, 10.0, 100.0, 2000.0))
    times, layout = grid(count, rate), dict(options.get("layout", {}))
    clock, form = str(options.get("clock", "time")), str(options.get("form", "flat"))
    channels: dict[str, TrueChannel] = {}
    with h5py.File(
        path, "w", libver=options.get("libver", "earliest"), userblock_size=int(options.get("block", 0))
    ) as file:
        folder: Any = file.create_group("test/logger") if options.get("deep") else file
        if form == "compound":
            kind = np.dtype([("time", "<f8"), ("M_s", ">f4"), ("n", "<i2")])
            rows = np.zeros(count, dtype=kind)
            rows["time"], rows["M_s"], rows["n"] = times, signal(rng, count), counts(rng, count, "i2")
            folder.create_dataset("log", data=rows, **layout)
            return Truth(
                channels={name: TrueChannel(times_s=times, values=rows[name].astype(float)) for name in ("M_s", "n")}
            )
        if form == "columns":
            table = np.stack([signal(rng, count), signal(rng, count)], axis=1)
            folder.create_dataset("log", data=table)
            folder.create_dataset("time", data=times)
            return Truth(
                channels={f"log column {k + 1}": TrueChannel(times_s=times, values=table[:, k]) for k in range(2)}
            )
        for number in range(int(options.get("signals", 2))):
            raw = counts(rng, count, str(options.get("kind") or pick(rng, *KINDS)))
            data = raw.reshape((-1, 1)) if form == "column" else raw.reshape((1, -1)) if form == "row" else raw
            one = folder.create_dataset(f"M_{number}", data=data, **(layout if form == "flat" else {}))
            name = str(options.get("unit_name", "units"))
            if options.get("fixed"):
                one.attrs.create(name, np.bytes_(b"Nm"))
            else:
                one.attrs[name] = "Nm"
            values = raw.astype(float)
            if options.get("packed"):
                one.attrs["scale_factor"], one.attrs["add_offset"] = np.float64(0.5), np.float64(-3.0)
                values = 0.5 * values - 3.0
            if options.get("fill") and raw.dtype.kind != "f":
                one.attrs["_FillValue"] = raw[5]
                values[raw == raw[5]] = np.nan
            if clock == "rate":
                one.attrs["sample_rate"] = rate
            elif clock == "dt":
                one.attrs["dt"] = 1.0 / rate
            channels[f"M_{number}"] = TrueChannel(times_s=times, values=values, unit="N m")
        if clock == "file":
            file.attrs["sample_rate_hz"] = rate
        elif clock in ("time", "scale", "ms"):
            axis = folder.create_dataset("time", data=times * (1e3 if clock == "ms" else 1.0))
            axis.attrs["units"] = "ms" if clock == "ms" else "s"
            if clock == "scale":
                axis.make_scale("time")
                for number in range(len(channels)):
                    folder[f"M_{number}"].dims[0].attach_scale(axis)
        if options.get("text"):
            folder.create_dataset("words", data=["on"] * count, dtype=h5py.string_dtype())
            folder.create_dataset("letters", data=np.array([b"on"] * count))
            folder.create_dataset("picture", data=np.zeros((20, 90, 90)))
    return Truth(channels=channels, others=("words", "letters", "picture"))


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    return {
        "layout": pick(rng, *LAYOUTS),
        "clock": pick(rng, "time", "scale", "ms", "rate", "dt", "file"),
        "form": pick(rng, "flat", "flat", "column", "row"),
        "deep": pick(rng, False, True),
        "text": pick(rng, False, True),
        "packed": pick(rng, False, True),
        "fill": pick(rng, False, True),
        "fixed": pick(rng, False, True),
        "unit_name": pick(rng, "units", "unit"),
        "libver": pick(rng, "earliest", "latest"),
        "signals": int(rng.integers(1, 5)),
    }


EXTREMES: tuple[Options, ...] = (
    *({"kind": kind} for kind in KINDS),
    *({"layout": layout} for layout in LAYOUTS),
    *({"clock": clock} for clock in ("time", "scale", "ms", "rate", "dt", "file")),
    *({"form": form} for form in ("compound", "columns", "column", "row")),
    {"libver": "latest", "deep": True},
    {"block": 512},
    {"text": True},
    {"packed": True, "fill": True, "kind": "<i2"},
)
FAMILY = Family(
    name="HDF5",
    writer="h5py",
    suffix=".h5",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=45,
    damaged=200,
    protects="compressed streams, Fletcher's checksum where asked for",
)
