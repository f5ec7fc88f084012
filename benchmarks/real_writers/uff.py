"""Universal files, data sets 58 and 58b, by pyuff."""

from pathlib import Path
from typing import Any

import numpy as np
import pyuff

from benchmarks.real_writers._truth import Family, Options, TrueChannel, Truth, grid, pick, signal


def write(path: Path, rng: np.random.Generator, options: Options) -> Truth:
    """Write one file."""
    channels: dict[str, TrueChannel] = {}
    rate, count = float(options.get("rate", 100.0)), int(options.get("count", 301))
    data_type, is_binary = int(options.get("type", 4)), bool(options.get("binary", False))
    is_single, uneven = data_type in (2, 5), bool(options.get("uneven", False))
    start = float(options.get("start", 0.0))
    times = grid(count, rate, start)
    if uneven:
        times = np.sort(times + 0.2 / rate * rng.uniform(-1.0, 1.0, count))
    file = pyuff.UFF(str(path))
    for number in range(int(options.get("signals", 2))):
        name = f"Response {number}"
        values = signal(rng, count)
        complex_part: Any = values + 1j * values if data_type >= 5 else values
        said = pyuff.prepare_58(
            binary=1 if is_binary else 0,
            id1=name,
            func_type=1,
            ver_num=1,
            load_case_id=0,
            rsp_ent_name="NONE",
            rsp_node=number + 1,
            rsp_dir=3,
            ref_ent_name="NONE",
            ref_node=0,
            ref_dir=0,
            ord_data_type=data_type,
            num_pts=count,
            abscissa_spacing=0 if uneven else 1,
            abscissa_min=start,
            abscissa_inc=1.0 / rate,
            z_axis_value=0.0,
            abscissa_spec_data_type=17,
            abscissa_axis_units_lab="s",
            ordinate_spec_data_type=9,
            ordinate_axis_units_lab="Nm",
            orddenom_spec_data_type=0,
            z_axis_spec_data_type=0,
            data=complex_part,
            x=times,
        )
        if is_single:
            # the writer puts doubles under a head of singles, where it is given doubles
            single = np.complex64 if data_type == 5 else np.float32
            said["data"], said["x"] = complex_part.astype(single), times.astype(np.float32)
        # "overwrite" leaves no set of its own in a binary file
        file.write_sets(said, "add", force_double=not is_single)
        # text has six or twelve digits, single precision seven
        rounding = 6e-7 * 100.0 if is_single else 6e-12 * 100.0
        if is_binary:
            rounding = 1e-5 if is_single else 0.0
        channels[name] = TrueChannel(
            times_s=times,
            values=values,
            unit="N m",
            rounding=rounding,
            time_rounding_s=6e-6 * count / rate + (1e-4 / rate if uneven else 0),
        )
    return Truth(channels=channels)


def drawn(rng: np.random.Generator) -> Options:
    """Draw the options of one file."""
    return {
        "type": pick(rng, 2, 4),
        "binary": pick(rng, False, True),
        "uneven": pick(rng, False, False, True),
        "rate": pick(rng, 10.0, 100.0, 200.0),
        "signals": int(rng.integers(1, 5)),
        "start": pick(rng, 0.0, 1.5),
        "count": int(rng.integers(101, 500)),
    }


EXTREMES: tuple[Options, ...] = (
    *(
        {"type": kind, "binary": binary, "uneven": uneven}
        for kind in (2, 4, 5, 6)
        for binary in (False, True)
        for uneven in (False, True)
    ),
    {"rate": 51200.0},
    {"rate": 1024.0, "binary": True, "count": 5},
    {"start": 100.0},
)
FAMILY = Family(
    name="UFF 58",
    writer="pyuff",
    suffix=".uff",
    write=write,
    extremes=EXTREMES,
    drawn=drawn,
    files=30,
    damaged=250,
    protects="number of values in the head",
)
