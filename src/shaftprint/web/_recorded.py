"""A recording as a drawing: signals as bands, windows of its tests and repairs as places along time, in per cent."""

from typing import Any, Final

from shaftprint.digits import rounded

HEIGHT_PX: Final = 96
_ABOVE, _BELOW = 6.0, 6.0
_TICKS: Final = 8
_STEPS: Final = (1.0, 2.0, 5.0, 10.0, 20.0, 30.0, 60.0, 120.0, 300.0, 600.0, 1200.0, 1800.0, 3600.0)


def drawn_recording(found: dict[str, Any]) -> dict[str, Any]:
    """Return what a page draws of a recording.

    ``found``: what a process beside the server said of it. Places along time are in per cent of its length, so that
    they fit any width; bands have a unit of width for each of their stretches.
    """
    begin_s: float = found["start_s"]
    length_s: float = max(found["stop_s"] - begin_s, 1e-9)

    def share(time_s: float) -> float:
        return 100.0 * (time_s - begin_s) / length_s

    def place(time_s: float) -> str:
        return f"{share(time_s):.4f}%"

    return {
        "height": HEIGHT_PX,
        "strips": [_band(one) for one in found["strips"]],
        "tests": [
            {
                "start": place(one["start_s"]),
                "length": f"{share(one['stop_s']) - share(one['start_s']):.4f}%",
                "from": place(one["settled_s"]),
                "to": place(one["stop_s"]),
                "window": f"{share(one['stop_s']) - share(one['settled_s']):.4f}%",
            }
            for one in found["tests"]
        ],
        "ticks": [{"x": place(one), "text": f"{one:g}"} for one in _ticks(begin_s, begin_s + length_s)],
        "repairs": [
            {"x": place(one["time_s"]), "words": f"{one['channel']}: {one['kind']} at {rounded(one['time_s'])} s"}
            for one in found["repairs"]
        ],
        "gaps": [
            {
                "x": place(one["start_s"]),
                # a gap of a few samples is seen too
                "width": f"{max(share(one['stop_s']) - share(one['start_s']), 0.05):.4f}%",
                "words": f"{one['channel']} {one['reason']}",
            }
            for one in found["gaps"]
        ],
    }


def _ticks(begin_s: float, end_s: float) -> list[float]:
    step = next((one for one in _STEPS if (end_s - begin_s) / one <= _TICKS), 7200.0)
    first = -(-begin_s // step) * step
    return [first + at * step for at in range(int((end_s - first) // step) + 1)]


def _band(one: dict[str, Any]) -> dict[str, Any]:
    low, high = min(one["low"], default=0.0), max(one["high"], default=1.0)
    span = (high - low) or 1.0

    def height(value: float) -> str:
        return f"{HEIGHT_PX - _BELOW - (value - low) / span * (HEIGHT_PX - _ABOVE - _BELOW):.1f}"

    upper = [f"{at + 0.5:g},{height(value)}" for at, value in enumerate(one["high"])]
    lower = [f"{at + 0.5:g},{height(value)}" for at, value in enumerate(one["low"])]
    return {
        "name": one["name"],
        "unit": one["unit"],
        "columns": len(one["low"]),
        "path": "M" + "L".join([*upper, *reversed(lower)]) + "Z" if upper else "",
        "low": rounded(low),
        "high": rounded(high),
    }
