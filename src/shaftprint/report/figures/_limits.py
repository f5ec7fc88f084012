"""The limits of a line: torque of the engine over speed, and the hardest seconds of the test in time."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.catalogue._limited_governor import AHEAD_S, GovernorSymbol
from shaftprint.distributions import NORMAL_95
from shaftprint.report.charts._chart import Chart, Panel, Scale
from shaftprint.report.charts._marks import Band, Line, Mark, Points

if TYPE_CHECKING:
    from shaftprint.limits._limit_fit import LimitFit

SHOWN_S = 12.0
LEVEL = GovernorSymbol.TORQUE_LIMIT
# A cloud of so many points shows all that one of all samples would.
CLOUD = 1500


def limit_chart(limits: "LimitFit") -> Chart:
    """Return measured and predicted torque of the engine: over speed with its limit, and where it moves most.

    Parameters
    ----------
    limits
        What ``identify_limits`` returns.
    """
    return Chart(
        panels=(
            Panel(
                title="Torque of the engine over speed",
                marks=_over_speed(limits),
                x=Scale(title="engine speed over that of the working point [-]"),
                y=Scale(title="torque over that of the working point [-]"),
            ),
            Panel(
                title="The same over the load, where it moves most",
                marks=_over_time(limits),
                x=Scale(title="time [s]"),
                y=Scale(title="torque over load, deviation [-]"),
            ),
        ),
        heights_px=(320, 260),
        linked="none",
    )


def _over_speed(limits: "LimitFit") -> list[Mark]:
    part = limits.predicted
    time, used = part.record.time_s, part.record.used
    # speed and full-load curve are given early
    speed, curve = (np.interp(time - AHEAD_S, time, part.record.inputs[name]) for name in ("n", "c"))
    few = slice(None, None, max(1, int(used.sum()) // CLOUD))
    at = 1.0 + speed[used]
    marks: list[Mark] = []
    for values, name, shade in ((part.record.outputs["y"], "measured", "reference"), (part.predicted, "predicted", 0)):
        torque = (1.0 + values[used]) * at**2
        marks.append(Points(x=at[few], y=torque[few], name=name, shade=shade, size=2.5))  # type: ignore[arg-type]
    level = next((number for number in limits.numbers if number.name == LEVEL), None)
    if level is not None:
        order = np.argsort(at)[few]
        shown, shape = at[order], 1.0 + curve[used][order]
        lower, upper = level.interval_95 or level.limits_95
        if np.isfinite([lower, upper]).all():
            marks.append(Band(x=shown, lower=lower * shape, upper=upper * shape, shade=1))
        marks.append(Line(x=shown, y=level.value * shape, name="torque limit, 95 %", shade=1, dash="solid"))
    return marks


def _over_time(limits: "LimitFit") -> list[Mark]:
    part = limits.predicted
    time, used, measured = part.record.time_s, part.record.used, part.record.outputs["y"]
    begin = _hardest(part.predicted, used, round(SHOWN_S * part.record.rate_hz))
    shown = slice(begin, begin + round(SHOWN_S * part.record.rate_hz))
    std = NORMAL_95 * float(np.std((measured - part.predicted)[used]))
    predicted = part.predicted[shown]
    return [
        Line(x=time[shown], y=measured[shown], name="measured", shade="data", width=1.4),
        Band(x=time[shown], lower=predicted - std, upper=predicted + std),
        Line(x=time[shown], y=predicted, name="predicted, 95 % of the noise"),
    ]


def _hardest(predicted: FloatArray, used: BoolArray, count: int) -> int:
    """Return where the stretch of so many samples begins in which the prediction changes most."""
    change = np.append(np.abs(np.diff(predicted)), 0.0) * used
    sums = np.concatenate([[0.0], np.cumsum(change)])
    return int(np.argmax(sums[count:] - sums[:-count])) if predicted.size > count else 0
