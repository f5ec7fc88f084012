"""NetCDF by netCDF4 (all five kinds) and by SciPy."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, pick, signal

FORMATS = ("NETCDF4", "NETCDF4_CLASSIC", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA")
UNITS = (
    "s",
    "seconds since 2026-03-05 09:00:00",
    "milliseconds since 2026-03-05 09:00:00",
    "days since 2026-03-05",
    "hours since 2026-3-5 9:00:00.0 +02:00",
    "seconds since 1970-01-01T00:00:00Z",
)
_SECONDS = {"s": 1.0, "seconds": 1.0, "milliseconds": 1e-3, "days": 86400.0, "hours": 3600.0}


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    count, rate = int(rng.integers(100, 400)), float(pick(rng, 1.0, 10.0, 100.0))
    unit = str(options.get("unit", "s"))
    second, first = _SECONDS[unit.split()[0]], 0.0
    began: datetime | None = None
    if "since" in unit:
        began = datetime(2026, 3, 5, 9, tzinfo=UTC)
    if unit.startswith("days"):
        first = 9 / 24
    if unit.startswith("hours"):
        began = datetime(2026, 3, 5, 7, tzinfo=UTC)
    if "1970" in unit:
        first = began.timestamp() if began else 0.0
    numbers = first + grid(count, rate) / second
    kind, order = str(options.get("kind", "f8")), str(options.get("order", "native"))
    channels: dict[str, TrueChannel] = {}
    times = grid(count, rate)
    if options.get("scipy"):
        import scipy.io

        with scipy.io.netcdf_file(path, "w", version=int(options.get("version", 1))) as file:
            file.createDimension("time", None if options.get("unlimited") else count)
            _fill_in(file, numbers, unit, kind, options, rng, channels, times)
    else:
        import netCDF4

        with netCDF4.Dataset(path, "w", format=str(options.get("format", "NETCDF4"))) as file:
            folder: Any = file.createGroup("engine") if options.get("group") else file
            folder.createDimension("time", None if options.get("unlimited") else count)
            more = {"endian": order}
            if options.get("zlib"):
                more |= {"zlib": True, "shuffle": True, "fletcher32": bool(options.get("fletcher"))}
            _fill_in(folder, numbers, unit, kind, options, rng, channels, times, **more)
    return Truth(channels=channels, began=began)


def _fill_in(
    folder: Any,
    numbers: Any,
    unit: str,
    kind: str,
    options: Options,
    rng: np.random.Generator,
    channels: dict[str, TrueChannel],
    times: Any,
    **more: Any,
) -> None:
    axis = folder.createVariable("time", "f8", ("time",))
    axis.units = unit
    if options.get("calendar"):
        axis.calendar = options["calendar"]
    axis[:] = numbers
    values = signal(rng, len(times))
    for number in range(int(options.get("signals", 2))):
        name = f"M_{number}"
        is_packed = bool(options.get("packed")) and kind[0] in "iu"
        fill = {"fill_value": np.array(-99).astype(kind)} if options.get("fill") and "endian" in more else {}
        if kind[0] in "iu":
            raw = np.rint(np.clip(values, 0 if kind[0] == "u" else -60, 60)).astype(kind)
        else:
            raw = values.astype(kind)
        wanted = raw.astype(float)
        one = folder.createVariable(name, kind, ("time",), **more, **fill)
        if "endian" in more:
            one.set_auto_maskandscale(False)
        one.units = "N m"
        if options.get("fill"):
            none = np.array(-99).astype(kind)
            if not fill:
                one.missing_value = none
            raw[7:11] = none
            wanted[7:11] = np.nan
        if is_packed:
            one.scale_factor, one.add_offset = 0.5, -3.0
            wanted = 0.5 * wanted - 3.0
        if options.get("range") and kind[0] not in "iu":
            one.valid_min = np.array(-50.0).astype(kind)
            wanted[raw < -50.0] = np.nan
        one[:] = raw
        channels[name] = TrueChannel(times_s=times, values=wanted, unit="N m", time_rounding_s=1e-5)


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    form = pick(rng, *FORMATS)
    has_group = form == "NETCDF4" and rng.random() < 0.3
    return {
        "format": form,
        "scipy": rng.random() < 0.2,
        "unit": pick(rng, *UNITS),
        "unlimited": pick(rng, False, True),
        "kind": pick(rng, "f8", "f4", "i2", "i4", "i1"),
        "packed": pick(rng, False, True),
        "fill": pick(rng, False, True),
        "group": has_group,
        "zlib": pick(rng, False, True) if form.startswith("NETCDF4") else False,
        "signals": int(rng.integers(1, 4)),
        "order": pick(rng, "native", "big") if form == "NETCDF4" else "native",
    }


EXTREMES: tuple[Options, ...] = (
    *({"format": form, "unlimited": True} for form in FORMATS),
    *({"unit": unit} for unit in UNITS),
    *({"kind": kind, "packed": True, "fill": True} for kind in ("i1", "i2", "i4", "u1", "u2", "i8")),
    *(
        {"unit": UNITS[1], "calendar": calendar}
        for calendar in ("standard", "proleptic_gregorian", "julian", "noleap", "360_day")
    ),
    {"zlib": True, "fletcher": True},
    {"group": True},
    {"range": True},
    {"range": True, "kind": "f4", "format": "NETCDF3_CLASSIC"},
    {"scipy": True, "version": 2, "kind": "i2", "packed": True, "fill": True},
    {"order": "big", "kind": "f4"},
)
FAMILY = Family(
    name="NetCDF",
    writer="netCDF4, SciPy",
    suffix=".nc",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=50,
    damaged=200,
    protects="compressed streams in NetCDF-4; sizes in the head",
)
