"""Strip charts as drawings of the page itself: places along time in per cent, heights in pixels, no script.

A policy that forbids attributes of style leaves places to attributes of the drawing; in per cent they fit any width.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, Final

from shaftprint.digits import rounded

HEIGHT_PX: Final = 110
_ABOVE_PX, _BELOW_PX = 8.0, 20.0
_MARGIN: Final = 2.5
_MOST_TICKS: Final = 6
# Share of the axis at its ends within which words would be cut on a phone.
_NEAR_END: Final = 0.1
_STEPS: Final = (1.0, 2.0, 2.5, 5.0, 10.0)
_WANTED_TICKS: Final = 3


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeAxis:
    """Time along all strips of a page."""

    begin: datetime
    """Where it begins."""
    end: datetime
    """Where it ends."""

    @classmethod
    def over(cls, moments: Sequence[datetime]) -> "TimeAxis | None":
        """Return an axis that holds all of some moments; None where there is none."""
        return cls(begin=min(moments), end=max(moments)) if moments else None

    def place(self, moment: datetime) -> str:
        """Return where a moment stands, in per cent."""
        return f"{_MARGIN + (100.0 - 2.0 * _MARGIN) * self._share(moment):.2f}%"

    def _share(self, moment: datetime) -> float:
        span = (self.end - self.begin).total_seconds()
        return 0.5 if span <= 0.0 else (moment - self.begin).total_seconds() / span

    def _tick(self, moment: datetime, text: str) -> dict[str, str]:
        """Return a tick with its words inside of the drawing: those at its ends go inwards."""
        share = self._share(moment)
        anchor = "start" if share < _NEAR_END else "end" if share > 1.0 - _NEAR_END else "middle"
        return {"x": self.place(moment), "text": text, "anchor": anchor}

    @property
    def ticks(self) -> list[dict[str, str]]:
        """Beginnings of years; of a shorter span its ends."""
        years = range(self.begin.year + 1, self.end.year + 1)
        step = max(1, math.ceil(len(years) / _MOST_TICKS))
        found = [datetime(year, 1, 1, tzinfo=UTC) for year in years[::step]]
        if found:
            return [self._tick(one, str(one.year)) for one in found]
        ends = [self.begin] if self.begin == self.end else [self.begin, self.end]
        return [self._tick(one, f"{one:%Y-%m}") for one in ends]


def strip(
    points: Sequence[dict[str, Any]], axis: TimeAxis, events: Sequence[dict[str, Any]], *, zero: bool
) -> dict[str, Any]:
    """Return the places of a strip chart: points with intervals over time, upright lines where work was done.

    ``points``: ``at`` in ISO, ``value``, ``low``, ``high``, and whether it is ``trusted``. ``axis``: time. ``events``:
    ``at`` and ``number`` of each. ``zero``: whether zero is on the axis.
    """
    known = [one for one in points if _is_number(one["value"])]
    ends = [float(one[name]) for one in known for name in ("value", "low", "high") if _is_number(one[name])]
    low, high, step = _span([*ends, *([0.0] if zero else [])])
    ticks = [low + place * step for place in range(round((high - low) / step) + 1)]

    def height(value: float) -> str:
        share = (min(max(value, low), high) - low) / (high - low)
        return f"{HEIGHT_PX - _BELOW_PX - share * (HEIGHT_PX - _ABOVE_PX - _BELOW_PX):.1f}"

    return {
        "height": HEIGHT_PX,
        "base": f"{HEIGHT_PX - _BELOW_PX:.1f}",
        "above": f"{_ABOVE_PX:.1f}",
        "text": f"{HEIGHT_PX - 5}",
        "years": axis.ticks,
        "ticks": [
            {"y": height(one), "text": _tick(one, step), "zero": zero and abs(one) < 0.01 * step} for one in ticks
        ],
        "events": [{"x": axis.place(one["at"]), "text": str(one["number"])} for one in events],
        "points": [_point(one, axis, height) for one in known],
    }


def _point(one: dict[str, Any], axis: TimeAxis, height: Any) -> dict[str, Any]:
    value = float(one["value"])
    low, high = (float(one[name]) if _is_number(one[name]) else value for name in ("low", "high"))
    return {
        "x": axis.place(datetime.fromisoformat(one["at"])),
        "y": height(value),
        "low": height(low),
        "high": height(high),
        "trusted": one.get("trusted", True),
        "words": f"{one['at'][:10]}: {rounded(value)} ({rounded(low)} to {rounded(high)})",
    }


def _span(values: Sequence[float]) -> tuple[float, float, float]:
    """Return ends and step of an axis in round numbers."""
    low, high = (min(values), max(values)) if values else (0.0, 1.0)
    if high - low <= 1e-12 * max(abs(low), abs(high), 1e-300):
        wide = 0.05 * abs(high) or 1.0
        low, high = low - wide, high + wide
    raw = (high - low) / _WANTED_TICKS
    power = 10.0 ** math.floor(math.log10(raw))
    step = next(one * power for one in _STEPS if one * power >= raw * (1.0 - 1e-9))
    return math.floor(low / step + 1e-9) * step, math.ceil(high / step - 1e-9) * step, step


def _tick(value: float, step: float) -> str:
    decimals = max(0, -math.floor(math.log10(step) + 1e-9) + (1 if f"{step:.1e}".startswith("2.5") else 0))
    text = f"{value:.{decimals}f}".replace("-", "−")
    return text.removeprefix("−") if not text.strip("−0.") else text


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and math.isfinite(value)
