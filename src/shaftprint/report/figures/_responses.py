"""Bode diagrams by the names of the thesis: measured responses, fits and comparisons."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.report.figures._bode import Column, plot_bode, plot_columns
from shaftprint.report.notation import response_label

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from shaftprint.report._curve import Curve
    from shaftprint.spectra import FrequencyResponse
# Where the thesis' sets differ from each other and two lines only were measured.
CRITICAL_SPAN_RAD_S = (1.0, 10.0)


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


def plot_core_fit(
    response: "FrequencyResponse", curves: Sequence["Curve"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return fits of the core propulsion ``n / M_s`` with data: what figure 5.1 of the thesis shows for OL1.

    Parameters
    ----------
    response
        Measured response from ``M_s`` to ``n``.
    curves
        Models from ``M_s`` to ``n``.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    return plot_bode(curves, data=response, aliasing_limit_hz=aliasing_limit_hz)


def plot_governor_fits(
    response: "FrequencyResponse", curves: Sequence["Curve"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return fits of governor and engine ``M_s / e``: what figures 5.2a and, from 1 to 10 rad/s, 5.2b show.

    Parameters
    ----------
    response
        Measured response from ``e`` to ``M_s``.
    curves
        Models from ``e`` to ``M_s``, such as OL2 to OL5.
    aliasing_limit_hz
        Half the pulse rate of the speed sensor [Hz].
    """
    return plot_bode(curves, data=response, aliasing_limit_hz=aliasing_limit_hz, zoom_rad_s=CRITICAL_SPAN_RAD_S)


def plot_closed_loop_fits(
    response: "FrequencyResponse", curves: Sequence["Curve"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return closed-loop fits of speed and torque with data: what figure 5.3 of the thesis shows for CL1 to CL4."""
    return plot_bode(curves, data=response, aliasing_limit_hz=aliasing_limit_hz)


def plot_closed_loop_comparison(
    response: "FrequencyResponse", curves: Sequence["Curve"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return selected parameter sets put into the closed loop: what figure 5.4 of the thesis shows.

    Sets of open-loop fits are made with ``closed_loop_curve``; parameters are those of the caller, nothing is fitted.
    """
    return plot_bode(curves, data=response, aliasing_limit_hz=aliasing_limit_hz)


def plot_open_loop_comparison(
    response: "FrequencyResponse", curves: Sequence["Curve"], *, aliasing_limit_hz: float | None = None
) -> "Figure":
    """Return selected parameter sets in open loop ``M_s / e``: what figures 5.5a and, enlarged, 5.5b show.

    Sets of closed-loop fits are made with ``open_loop_curve``.
    """
    return plot_bode(curves, data=response, aliasing_limit_hz=aliasing_limit_hz, zoom_rad_s=CRITICAL_SPAN_RAD_S)
