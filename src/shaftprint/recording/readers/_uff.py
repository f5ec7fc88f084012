"""Universal files (.uff, .unv) with time data in data sets 58 and 58b, as programs of modal analysis export them."""

import re
from collections import Counter
from collections.abc import Mapping
from datetime import datetime
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from shaftprint.errors import RecordingError
from shaftprint.recording._channel import Channel
from shaftprint.recording._recording import Recording
from shaftprint.recording.readers._clock import SampleClock, clock_of_times, on_clock
from shaftprint.recording.readers._damage import expect_no_blanks, told_as_damage
from shaftprint.recording.readers._extra import library
from shaftprint.recording.readers._gather import Gathered, unique_names
from shaftprint.recording.readers._hints import OF_HINT, expect_one_rate, rate_hint
from shaftprint.recording.readers._printed_rate import rate_of_step
from shaftprint.units import plain_unit

NAME = "universal file (UFF 58)"

_MARK = b"    -1"
# the head of binary data with kind, number and spacing of the samples, and what stands behind these
_BINARY_HEAD = re.compile(
    rb"^    58b[^\n]*\n(?:[^\n]*\n){6}[ ]*(\d+)[ ]+(\d+)[ ]+(\d+)[^\n]*\n(?:[^\n]*\n){4}", re.MULTILINE
)
_WIDTHS, _END = {2: 4, 4: 8, 5: 8, 6: 16}, re.compile(rb"\s*    -1")
_FUNCTION, _TIME_RESPONSE, _OF_TIME, _COMPLEX = 58, (0, 1), (0, 17), (5, 6)
_DIRECTIONS = {0: "", 1: "+X", 2: "+Y", 3: "+Z", 4: "+RX", 5: "+RY", 6: "+RZ"}
_DATES = ("%d-%b-%y %H:%M:%S", "%d-%b-%Y %H:%M:%S", "%Y-%m-%d %H:%M:%S", "%d.%m.%Y %H:%M:%S")
_FUNCTIONS = {
    2: "an auto spectrum",
    3: "a cross spectrum",
    4: "a frequency response",
    6: "a coherence",
    12: "a spectrum",
}


def is_mine(path: Path) -> bool:
    """Return whether the file begins with the mark of a data set and its number."""
    with path.open("rb") as file:
        lines = file.read(400).lstrip(b"\r\n").splitlines()
    if len(lines) < 2 or not lines[0].startswith(_MARK) or lines[0].strip() != b"-1":
        return False
    return lines[1][:6].strip().isdigit()


def read(path: Path, **hints: object) -> Recording:
    """Read the functions of time of a universal file.

    Hints: ``sample_rate_hz``, in place of that which follows from the printed step.

    Raises RecordingError if the file is damaged, or holds no functions of time.
    """
    rate_hz = rate_hint(path, hints)
    pyuff = library(path, "pyuff", "universal")
    is_cut = _is_cut(path)
    with told_as_damage(path, "universal"):
        read_sets = pyuff.UFF(str(path)).read_sets()
    sets = [one for one in (read_sets if isinstance(read_sets, list) else [read_sets]) if one]
    functions = [one for one in sets if one.get("type") == _FUNCTION]
    gathered = Gathered(path=path)
    if is_cut:
        gathered.remarks.append("The last data set has no end: the file is cut off, and what was in it is left out.")
    names = unique_names([("", _name(one, number)) for number, one in enumerate(functions, start=1)])
    for one, name in zip(functions, names, strict=True):
        gathered.add(name, partial(_channel, path, one, name, rate_hz, gathered.remarks))
    for kind, count in Counter(int(one.get("type", 0)) for one in sets if one not in functions).items():
        gathered.left_out[f"data sets {kind}"] = f"{count} of them, which hold no functions"
    began = next((date for one in functions if (date := _date(one)) is not None), None)
    return gathered.recording(NAME, lambda: None, began)


def _is_cut(path: Path) -> bool:
    """Return whether the last data set has no end, which the library passes over.

    Binary data sets of another size than their heads say are refused: their numbers would be read in the wrong width.

    Raises RecordingError if there is one.
    """
    content = path.read_bytes()
    is_cut = not content.rstrip().endswith(_MARK)
    for head in _BINARY_HEAD.finditer(content):
        kind, count, is_even = (int(head[place]) for place in (1, 2, 3))
        width = _WIDTHS.get(kind, _WIDTHS[4])
        # times beside the values in either width
        sizes = [count * width] if is_even else [count * (width + of_time) for of_time in (8, 4)]
        if is_cut and head.end() + min(sizes) > len(content):
            break
        if is_even:
            expect_no_blanks(path, content[head.end() : head.end() + sizes[0]], width)
        if not any(_END.match(content, head.end() + size) for size in sizes):
            raise RecordingError(
                f"{path}: expected {sizes[0]} bytes of samples, as the head of a data set 58b says, found others; the "
                "file is damaged, or its writer put numbers of another width into it: export it again as text (58)."
            )
    return is_cut


def _name(one: Mapping[str, Any], number: int) -> str:
    """Return the name of the point, or the title, with the direction where there is one."""
    name = next((text for key in ("rsp_ent_name", "id1", "ordinate_axis_lab") if (text := _text(one, key))), "")
    direction = int(one.get("rsp_dir", 0))
    sign = _DIRECTIONS.get(abs(direction), "").replace("+", "-" if direction < 0 else "+")
    node = int(one.get("rsp_node", 0))
    if _text(one, "rsp_ent_name") or not name:
        return ":".join(part for part in (name or "point", str(node) if node else "", sign) if part) if node else name
    return name or f"function {number}"


def _text(one: Mapping[str, Any], key: str) -> str:
    text = str(one.get(key, "")).strip()
    return "" if text.upper() in ("NONE", "") else text


def _channel(path: Path, one: Mapping[str, Any], name: str, hint_hz: float | None, remarks: list[str]) -> Channel:
    kind, of = int(one.get("func_type", 0)), int(one.get("abscissa_spec_data_type", 0))
    if kind not in _TIME_RESPONSE or of not in _OF_TIME:
        raise RecordingError(f"expected a function of time, found {_FUNCTIONS.get(kind, f'type {kind} over {of}')}")
    if int(one.get("ord_data_type", 4)) in _COMPLEX or np.iscomplexobj(one["data"]):
        raise RecordingError("expected real numbers, found complex ones; export the functions of time")
    # what is behind the last sample of binary data is the end of the line
    values = np.asarray(one["data"], dtype=np.float64)[: int(one.get("num_pts") or len(one["data"]))]
    if values.size < int(one.get("num_pts") or 0):
        raise RecordingError(f"expected {one['num_pts']} samples, found {values.size}; the file is cut off there")
    if int(one.get("abscissa_spacing", 1)) == 1:
        clock = _even_clock(path, one, name, hint_hz, remarks)
    else:
        times = np.asarray(one["x"], dtype=np.float64)
        clock = clock_of_times(path, f"the times of {name}", values.size, lambda start, stop: times[start:stop])
    channel = Channel(
        name=name,
        unit=plain_unit(_text(one, "ordinate_axis_units_lab")),
        rate_hz=clock.rate_hz,
        start_s=clock.start_s,
        count=values.size,
        source=lambda start, stop: values[start:stop],
        long_name=_text(one, "ordinate_axis_lab"),
    )
    return on_clock(channel, clock)


def _even_clock(
    path: Path, one: Mapping[str, Any], name: str, hint_hz: float | None, remarks: list[str]
) -> SampleClock:
    """Return the clock of a step that is printed with six digits: of all rates that it may stand for the roundest."""
    step = float(one["abscissa_inc"])
    printed = f"{step:.5e}"
    rate_hz = hint_hz or rate_of_step(printed)
    if rate_hz is None:
        raise RecordingError(
            f"expected a positive step of the times, found {step:g}; pass sample_rate_hz= (--sample-rate)"
        )
    if hint_hz is not None:
        expect_one_rate(path, {f"a step of {step:g} s": 1.0 / step, OF_HINT: hint_hz}, 1e-4)
    if hint_hz is None and abs(rate_hz * step - 1.0) > 1e-9:
        remarks.append(
            f"The rate of {rate_hz:.9g} Hz is the roundest one whose step is printed as {printed} s; pass another with "
            "sample_rate_hz= (--sample-rate)."
        )
    return SampleClock(rate_hz=rate_hz, start_s=float(one.get("abscissa_min", 0.0)))


def _date(one: Mapping[str, Any]) -> datetime | None:
    text = " ".join(_text(one, "id3").split())
    for form in _DATES:
        try:
            return datetime.strptime(text, form)  # noqa: DTZ007 - the file does not say the zone
        except ValueError:
            continue
    return None
