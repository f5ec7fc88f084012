"""Formats that are not read, by the writers that people have: what is said must name the way."""

import sqlite3
from pathlib import Path

import numpy as np
import pandas as pd

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, signal

FORMS = (
    "parquet",
    "feather",
    "arrow",
    "xlsx",
    "json",
    "pickle",
    "npy",
    "npz",
    "wav",
    "sqlite",
    "hdf_fixed",
    "hdf_table",
    "orc",
    "html",
    "xml",
    "stata",
)


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    form = str(options["form"])
    times = grid(200, 100.0)
    values = signal(rng, 200)
    frame = pd.DataFrame({"time": times, "M_s": values})
    match form:
        case "parquet":
            frame.to_parquet(path)
        case "feather" | "arrow":
            frame.to_feather(path)
        case "orc":
            frame.to_orc(path)
        case "xlsx":
            frame.to_excel(path, index=False, engine="openpyxl")
        case "json":
            frame.to_json(path)
        case "html":
            frame.to_html(path)
        case "xml":
            frame.to_xml(path)
        case "stata":
            frame.to_stata(path)
        case "pickle":
            frame.to_pickle(path)
        case "npy":
            with path.open("wb") as file:
                np.save(file, frame.to_numpy())
        case "npz":
            with path.open("wb") as file:
                np.savez(file, time=times, M_s=values)
        case "wav":
            import scipy.io.wavfile

            scipy.io.wavfile.write(path, 100, values.astype(np.float32))
        case "sqlite":
            with sqlite3.connect(path) as base:
                frame.to_sql("log", base)
        case "hdf_fixed" | "hdf_table":
            frame.to_hdf(path, key="log", format=form.removeprefix("hdf_"))
    return Truth(channels={"M_s": TrueChannel(times_s=times, values=values)})


EXTREMES: tuple[Options, ...] = tuple({"form": form} for form in FORMS)
FAMILY = Family(
    name="others",
    writer="pandas, pyarrow, NumPy, SciPy",
    suffix=".dat",
    write=write,
    extremes=EXTREMES,
    drawn=lambda rng: EXTREMES[int(rng.integers(len(EXTREMES)))],
    files=len(EXTREMES),
)
