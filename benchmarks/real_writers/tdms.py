"""NI TDMS by npTDMS."""

from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import nptdms
import numpy as np

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, counts, grid, pick

KINDS = ("i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8")
SCALES = ("none", "linear", "polynomial", "table", "two")


def _scale(how: str, x: Any) -> tuple[dict[str, Any], Any]:
    if how == "linear":
        said = {
            "NI_Scale[0]_Scale_Type": "Linear",
            "NI_Scale[0]_Linear_Slope": 0.125,
            "NI_Scale[0]_Linear_Y_Intercept": -3.0,
        }
        return said | {"NI_Number_Of_Scales": 1, "NI_Scaling_Status": "unscaled"}, 0.125 * x - 3.0
    if how == "polynomial":
        said = {"NI_Scale[0]_Scale_Type": "Polynomial", "NI_Scale[0]_Polynomial_Coefficients_Size": 3}
        said |= {f"NI_Scale[0]_Polynomial_Coefficients[{k}]": c for k, c in enumerate((1.0, 0.5, 1e-6))}
        return said | {"NI_Number_Of_Scales": 1, "NI_Scaling_Status": "unscaled"}, 1.0 + 0.5 * x + 1e-6 * x * x
    if how == "table":
        pre, scaled = np.linspace(x.min(), x.max(), 4), (0.0, 10.0, 40.0, 50.0)
        said = {"NI_Scale[0]_Scale_Type": "Table", "NI_Scale[0]_Table_Pre_Scaled_Values_Size": 4}
        said |= {"NI_Scale[0]_Table_Scaled_Values_Size": 4}
        said |= {f"NI_Scale[0]_Table_Pre_Scaled_Values[{k}]": float(v) for k, v in enumerate(pre)}
        said |= {f"NI_Scale[0]_Table_Scaled_Values[{k}]": v for k, v in enumerate(scaled)}
        return said | {"NI_Number_Of_Scales": 1, "NI_Scaling_Status": "unscaled"}, np.interp(x, pre, scaled)
    if how == "two":
        said, once = _scale("linear", x)
        said |= {
            "NI_Scale[1]_Scale_Type": "Linear",
            "NI_Scale[1]_Linear_Slope": -2.0,
            "NI_Scale[1]_Linear_Y_Intercept": 1.0,
        }
        return said | {"NI_Scale[1]_Linear_Input_Source": 0, "NI_Number_Of_Scales": 2}, -2.0 * once + 1.0
    return {}, x


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    channels: dict[str, TrueChannel] = {}
    rate = float(options.get("rate", 100.0))
    segments, pause = int(options.get("segments", 1)), float(options.get("pause", 0.0))
    each = int(rng.integers(100, 300))
    first = np.datetime64("2026-03-05T09:00:00.250000", "us")
    clock = str(options.get("clock", "wf"))
    described = []
    for group in range(int(options.get("groups", 1))):
        for number in range(int(options.get("signals", 2))):
            kind = str(options.get("kind") or pick(rng, *KINDS))
            how = str(options.get("scale") or pick(rng, *SCALES))
            if how == "polynomial" and kind in ("i8", "u8"):
                kind = "i4"
            raw = counts(rng, segments * each, kind)
            said, values = _scale(how, raw.astype(float))
            described.append((f"group {group}", f"M_{group}_{number}", raw, said, values, how))
    with nptdms.TdmsWriter(str(path), mode="w", version=int(options.get("version", 4712))) as writer:
        for part in range(segments):
            rows = slice(part * each, (part + 1) * each)
            objects: list[Any] = []
            begin_s = part * (each / rate + pause)
            for group, name, raw, said, _, _ in described:
                said = {**said, "unit_string": "N*m" if options.get("star") else "Nm"}
                if clock == "wf":
                    said |= {"wf_increment": 1.0 / rate, "wf_start_offset": float(options.get("offset", 0.0))}
                    if options.get("dated"):
                        said |= {"wf_start_time": first + np.timedelta64(round(begin_s * 1e6), "us")}
                objects.append(nptdms.ChannelObject(group, name, raw[rows], said))
            for group in dict.fromkeys(one[0] for one in described):
                times = begin_s + np.arange(each) / rate
                if clock == "column":
                    objects.append(nptdms.ChannelObject(group, "Time", times, {"unit_string": "s"}))
                elif clock == "ms":
                    objects.append(nptdms.ChannelObject(group, "Time", 1e3 * times, {"unit_string": "ms"}))
                elif clock == "dates":
                    stamps = first + np.rint(times * 1e6).astype("timedelta64[us]")
                    objects.append(nptdms.ChannelObject(group, "Time", stamps))
                if options.get("text"):
                    objects.append(nptdms.ChannelObject(group, "words", ["on", "off"] * (each // 2)))
            writer.write_segment(objects)
    times = np.concatenate([part * (each / rate + pause) + grid(each, rate) for part in range(segments)])
    if clock == "wf":
        times = times + float(options.get("offset", 0.0))
    is_dated = clock == "dates" or (clock == "wf" and bool(options.get("dated")))
    for _, name, raw, _, values, how in described:
        rounding = 1e-5 * float(np.max(np.abs(values))) if raw.dtype == np.float32 and how != "none" else 0.0
        rounding = rounding or 1e-9 * float(np.max(np.abs(values)))
        channels[name] = TrueChannel(
            times_s=times, values=np.asarray(values), unit="N m", rounding=rounding, time_rounding_s=2e-6
        )
    began = datetime(2026, 3, 5, 9, 0, 0, 250_000, tzinfo=UTC) if is_dated else None
    return Truth(channels=channels, began=began, others=("words",))


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    clock = pick(rng, "wf", "wf", "column", "ms", "dates")
    return {
        "clock": clock,
        "rate": pick(rng, 10.0, 100.0, 2000.0),
        "segments": int(rng.integers(1, 5)),
        "groups": int(rng.integers(1, 4)),
        "signals": int(rng.integers(1, 4)),
        "version": pick(rng, 4712, 4713),
        "dated": pick(rng, False, True),
        "offset": pick(rng, 0.0, 0.25),
        "text": pick(rng, False, True),
    }


EXTREMES: tuple[Options, ...] = (
    *({"kind": kind, "scale": "linear"} for kind in KINDS),
    *({"kind": "i2", "scale": scale, "segments": 3} for scale in SCALES),
    *({"clock": clock, "segments": 2} for clock in ("wf", "column", "ms", "dates")),
    {"segments": 3, "dated": True, "pause": 5.0},
    {"segments": 2, "clock": "column", "pause": 5.0},
    {"segments": 2, "clock": "dates", "pause": 5.0},
    {"segments": 40, "signals": 4},
    {"rate": 51200.0, "dated": True},
    {"text": True, "groups": 3},
    {"star": True},
)
FAMILY = Family(
    name="TDMS",
    writer="npTDMS",
    suffix=".tdms",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=50,
    damaged=200,
    protects="lengths of segments in their heads",
)
