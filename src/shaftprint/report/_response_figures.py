"""Measured responses: ways to pick the line, closed loop, open loop (thesis figures 3.5, 3.7, 3.8)."""

from collections.abc import Mapping
from typing import TYPE_CHECKING

from shaftprint.report._bode import Column, plot_bode, plot_columns
from shaftprint.report._symbols import response_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.spectra import FrequencyResponse


def plot_line_selection(
    responses: Mapping[str, "FrequencyResponse"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return the response by several ways to measure a sine: what figure 3.5 of the thesis shows.

    Points of one line stand side by side so that all of them are seen.

    Parameters
    ----------
    responses
        Responses from ``n_set`` by the name of the way, such as whole-period fit, DFT bin and highest peak.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    first = next(iter(responses.values()))
    columns = [
        Column(title=response_label(name, first.inputs[0]), output=name, data=responses) for name in first.outputs
    ]
    return plot_columns(columns, aliasing_limit_hz=aliasing_limit_hz)


def plot_closed_loop_response(response: "FrequencyResponse", *, aliasing_limit_hz: float | None = None) -> "Figure":
    """Return the measured closed-loop response of speed and torque: what figure 3.7 of the thesis shows."""
    return plot_bode(data=response, aliasing_limit_hz=aliasing_limit_hz)


def plot_open_loop_responses(
    governor: "FrequencyResponse", core: "FrequencyResponse", *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return the measured open-loop responses ``M_s / e`` and ``n / M_s``: what figure 3.8 of the thesis shows."""
    columns = [
        Column(title=f"{what}, {response_label(r.outputs[0], r.inputs[0])}", output=r.outputs[0], data={"data": r})
        for what, r in (("governor and engine", governor), ("core propulsion", core))
    ]
    return plot_columns(columns, aliasing_limit_hz=aliasing_limit_hz)
