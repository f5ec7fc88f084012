"""Bode diagrams of measured responses and of fits that need more than one structure's own channels."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from shaftprint.report.charts._chart import Chart
from shaftprint.report.charts._text import joined, over
from shaftprint.report.figures._bode import Column, columns_chart

if TYPE_CHECKING:
    from shaftprint.spectra._frequency_response import FrequencyResponse

CRITICAL_SPAN_RAD_S = (1.0, 10.0)
"""Where the thesis' sets differ from each other and two lines only were measured."""


def open_loop_chart(
    governor: "FrequencyResponse", core: "FrequencyResponse", *, aliasing_limit_hz: float | None = None
) -> Chart:
    """Return the measured open-loop responses ``M_s / e`` and ``n / M_s``: what figure 3.8 of the thesis shows."""
    data: Mapping[str, FrequencyResponse] = {"governor and engine": governor, "core propulsion": core}
    columns = [
        Column(title=joined(f"{what}, ", over(r.outputs[0], r.inputs[0])), output=r.outputs[0], data={"data": r})
        for what, r in data.items()
    ]
    return columns_chart(columns, aliasing_limit_hz=aliasing_limit_hz)
