"""ASAM MDF 3 and 4 by asammdf."""

from datetime import UTC, datetime, timedelta, timezone
from pathlib import Path
from typing import Any

import asammdf
import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, counts, grid, pick

KINDS = ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8")
CONVERSIONS = (
    "none",
    "linear",
    "linear_negative",
    "algebraic",
    "rational",
    "table",
    "interpolated",
    "ranges",
    "partial_text",
    "partial_range",
    "states",
)
ZONES = (None, UTC, timezone(timedelta(hours=2)), timezone(timedelta(hours=-9, minutes=-30)))


def _converted(kind: str, raw: Any) -> tuple[dict[str, Any] | None, Any]:
    """Return the writer's conversion and its values."""
    x = raw.astype(np.float64)
    if kind == "linear":
        return {"a": 0.125, "b": -40.0}, 0.125 * x - 40.0
    if kind == "linear_negative":
        return {"a": -3.0, "b": 7.0}, -3.0 * x + 7.0
    if kind == "algebraic":
        return {"formula": "2 * X + 3"}, 2.0 * x + 3.0
    if kind == "rational":
        return {"P1": 0.0, "P2": 4.0, "P3": 1.0, "P4": 0.0, "P5": 0.0, "P6": 8.0}, (4.0 * x + 1.0) / 8.0
    if kind in ("table", "interpolated"):
        steps = np.linspace(x.min(), x.max() + 1.0, 5)
        given = np.array([10.0, 30.0, -5.0, 8.0, 100.0])
        table: dict[str, Any] = {f"raw_{k}": v for k, v in enumerate(steps)} | {
            f"phys_{k}": v for k, v in enumerate(given)
        }
        if kind == "interpolated":
            return table | {"interpolation": True}, np.interp(x, steps, given)
        nearest = np.clip(np.searchsorted(steps, x), 1, 4)
        lower = x - steps[nearest - 1] <= steps[nearest] - x
        return table, given[np.where(lower, nearest - 1, nearest)]
    if kind == "ranges":
        edges = np.linspace(x.min(), x.max() + 1.0, 4)
        said: dict[str, Any] = {"default": -1.0}
        values = np.full(len(x), -1.0)
        for k, phys in enumerate((5.0, 6.0, 9.0)):
            said |= {f"lower_{k}": edges[k], f"upper_{k}": edges[k + 1], f"phys_{k}": phys}
            values[(x >= edges[k]) & (x < edges[k + 1] if raw.dtype.kind == "f" else x <= edges[k + 1])] = phys
        return said, values
    if kind == "partial_text":
        none = float(x[3])
        values = np.where(x == none, np.nan, 0.5 * x)
        return {"val_0": none, "text_0": "not available", "default_addr": {"a": 0.5, "b": 0.0}}, values
    if kind == "partial_range":
        low = float(np.percentile(x, 90))
        values = np.where(x >= low, np.nan, 0.25 * x + 1.0)
        return {"lower_0": low, "upper_0": 1e300, "text_0": "error", "default_addr": {"a": 0.25, "b": 1.0}}, values
    if kind == "states":
        return {"val_0": 0.0, "text_0": "off", "val_1": 1.0, "text_1": "on", "default_addr": "?"}, x
    return None, x


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    version = str(options.get("version", "4.10"))
    is_v4 = version >= "4"
    channels: dict[str, TrueChannel] = {}
    with asammdf.MDF(version=version) as file:
        began: datetime | None = None
        if "zone" in options:
            zone: Any = options["zone"]
            began = datetime(2026, 7, 3, 9, 30, 15, 250_000, tzinfo=zone)
            file.start_time = began
            if version < "3.2":
                # whole seconds of the place, no zone
                began = began.replace(microsecond=0, tzinfo=None)
            elif not is_v4:
                # a zone has whole hours; without one that of the computer is put in
                began = began.astimezone()
        file.configure(write_fragment_size=int(options.get("fragment", 4 << 20)))
        for group in range(int(options.get("groups", 1))):
            count = int(rng.integers(150, 400))
            rate = float(pick(rng, 10.0, 100.0, 2000.0, 51200.0))
            times = grid(count, rate, float(options.get("start", 0.0)))
            signals = []
            for number in range(int(options.get("signals", 2))):
                kind = str(options.get("kind") or pick(rng, *KINDS))
                how = str(options.get("conversion") or pick(rng, *(CONVERSIONS if is_v4 else CONVERSIONS[:7])))
                raw = counts(rng, count, "u1" if how == "states" else kind)
                if how == "states":
                    raw = (raw % 2).astype("u1")
                if (
                    how in ("table", "interpolated", "ranges", "partial_text", "partial_range")
                    and raw.dtype.itemsize == 8
                    and raw.dtype.kind != "f"
                ):
                    raw = (raw >> raw.dtype.type(16)).astype(raw.dtype)
                conversion, values = _converted(how, raw)
                raw = raw.astype(raw.dtype.newbyteorder(str(options.get("order", "<"))))
                bits = None
                if is_v4 and options.get("invalid"):
                    bits = rng.random(count) < float(options["invalid"])
                    values = np.where(bits, np.nan, values)
                name = f"M_{group}_{number}"
                signals.append(
                    asammdf.Signal(raw, times, name=name, unit="Nm", conversion=conversion, invalidation_bits=bits)
                )
                # single precision in, single precision out
                rounding = (
                    1e-5 * float(np.nanmax(np.abs(values), initial=1.0))
                    if raw.dtype.itemsize < 8 and raw.dtype.kind == "f" and conversion
                    else 0.0
                )
                channels[name] = TrueChannel(
                    times_s=times, values=np.asarray(values, dtype=float), unit="N m", rounding=rounding
                )
            if options.get("text"):
                words = np.array([f"gear {k % 3}" for k in range(count)]).astype("S")
                signals.append(asammdf.Signal(words, times, name="words", encoding="utf-8"))
            file.append(signals, common_timebase=True)
        if began is None and is_v4:
            # the writer puts the present time into the head
            began = file.start_time
        saved = file.save(
            path.with_suffix(".mf4" if is_v4 else ".mdf"),
            overwrite=True,
            compression=int(options.get("compression", 0)),
        )
        saved.rename(path)
    return Truth(channels=channels, began=began, others=("words",))


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    return {
        "version": pick(rng, "3.00", "3.10", "3.20", "3.30", "4.00", "4.10", "4.11", "4.20"),
        "groups": int(rng.integers(1, 4)),
        "signals": int(rng.integers(1, 5)),
        "compression": pick(rng, 0, 1, 2),
        "order": pick(rng, "<", ">"),
        "invalid": pick(rng, 0.0, 0.0, 0.1),
        "fragment": pick(rng, 4 << 20, 1 << 10),
        "start": pick(rng, 0.0, 12.5),
        "text": pick(rng, False, True),
        **({"zone": pick(rng, *ZONES)} if rng.random() < 0.6 else {}),
    }


EXTREMES: tuple[Options, ...] = (
    *({"kind": kind, "conversion": "linear"} for kind in KINDS),
    *({"kind": kind, "order": ">", "conversion": "none"} for kind in KINDS),
    *({"kind": "u2", "conversion": how} for how in CONVERSIONS),
    *({"kind": "i2", "conversion": how, "invalid": 0.1} for how in ("none", "linear", "partial_text")),
    *({"kind": "f4", "conversion": how, "version": "3.30"} for how in CONVERSIONS[:7]),
    *({"zone": zone, "version": version} for zone in ZONES for version in ("3.30", "4.10")),
    *({"version": version, "groups": 3} for version in ("2.14", "3.00", "4.20")),
    *({"compression": compression, "fragment": 1 << 10, "groups": 3} for compression in (1, 2)),
    {"invalid": 1.0},
    {"invalid": 0.5, "kind": "i2"},
    {"text": True},
    {"start": 1e6},
    {"start": -3.0},
)
FAMILY = Family(
    name="MDF",
    writer="asammdf",
    suffix=".mf4",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=100,
    damaged=250,
    protects="compressed blocks have a checksum; links and lengths of blocks",
)
