"""Lines, bands, points and error bars of a Bode diagram."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from matplotlib.artist import Artist

from shaftprint.arrays import BoolArray, FloatArray
from shaftprint.identify.uncertainty import model_band
from shaftprint.report.figures._style import DATA, Handle, LineLook
from shaftprint.report.figures._uncertainty import measured_points
from shaftprint.report.notation import plain_label
from shaftprint.units import decibel

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from shaftprint.report._curve import Curve
    from shaftprint.spectra import FrequencyResponse

BAND_ALPHA = 0.28
# Bands are smoother than lines: every third point will do, and keeps the file small.
BAND_STEP = 3
# From one used line to the next a measured phase may lead by no more than this; the rest of the turn is lag.
LARGEST_LEAD_DEG = 90.0
# Stands for an error bar without end.
ENDLESS_DB = 500.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Trace:
    """A model's response on a grid of frequencies, phase unwrapped."""

    omega_rad_s: FloatArray
    """Frequencies [rad/s], shape (frequencies,)."""
    magnitude_db: FloatArray
    """Magnitude [dB], shape (frequencies,)."""
    phase_deg: FloatArray
    """Unwrapped phase [deg], shape (frequencies,)."""


def channel_of(outputs: Iterable[str], inputs: Sequence[str], output: str, cause: str | None = None) -> int:
    """Return the place of a response among all, outputs slowest; that to the first input where none is named."""
    return list(outputs).index(output) * len(inputs) + (0 if cause is None else inputs.index(cause))


def trace_of(curve: "Curve", output: str, omega_rad_s: FloatArray, cause: str | None = None) -> Trace:
    """Return magnitude and unwrapped phase of one output of a model, to the first input where none is named."""
    index = channel_of(curve.structure.outputs, curve.structure.inputs, output, cause)
    response = curve.structure.response(curve.values, 1j * omega_rad_s)[index]
    return Trace(
        omega_rad_s=omega_rad_s,
        magnitude_db=decibel(np.abs(response)),
        phase_deg=np.degrees(np.unwrap(np.angle(response))),
    )


def measured_phase_deg(data: "FrequencyResponse", channel: int, traces: Sequence[Trace] = ()) -> FloatArray:
    """Return the phase of a measured response [deg], whole turns chosen to agree with the closest model.

    A measured phase is known up to whole turns only. Without a model the used lines are followed from one to the next:
    a step between -270 and 90 degrees, since a propulsion line lags more and more; the others follow the nearest used
    line below.
    """
    phase = measured_points(data, channel).phase_deg
    if not traces:
        return _followed(phase, data.used)
    at = np.log(data.omega_rad_s)
    models = [np.interp(at, np.log(t.omega_rad_s), t.phase_deg) for t in traces]
    misfit = [np.sum(np.abs(np.angle(np.exp(1j * np.radians(phase - m))[data.used]))) for m in models]
    reference = models[int(np.argmin(misfit))]
    return np.asarray(phase + 360.0 * np.round((reference - phase) / 360.0))


def _followed(phase: FloatArray, used: BoolArray) -> FloatArray:
    """Return phases [deg] with whole turns that make each used line lag behind the one before."""
    followed = phase.copy()
    before = phase[used][0] if used.any() else phase[0]
    for index in range(phase.size):
        followed[index] = before + LARGEST_LEAD_DEG - np.mod(before + LARGEST_LEAD_DEG - phase[index], 360.0)
        before = followed[index] if used[index] else before
    return followed


def draw_trace(
    pair: "tuple[Axes, Axes]",
    curve: "Curve",
    trace: Trace,
    output: str,
    style: LineLook,
    *,
    cause: str | None = None,
) -> dict[str, Handle]:
    """Draw a model's line, and its band where it has a covariance; return what the legend must explain."""
    label = plain_label(curve.label)
    bands: list[Artist] = []
    if curve.covariance is not None:
        index = channel_of(curve.structure.outputs, curve.structure.inputs, output, cause)
        few = slice(None, None, BAND_STEP)
        frequency = trace.omega_rad_s[few] / (2.0 * np.pi)
        band = model_band(curve.structure, curve.values, curve.covariance, frequency)
        halves = (
            (band.magnitude_upper_db - band.magnitude_db)[index],
            (band.phase_upper_deg - band.phase_deg)[index],
        )
        finite = bool(np.isfinite(halves).all())
        label += f", {100.0 * band.coverage:g} % band" if finite else ", no band"
        if finite:
            bands = [
                axes.fill_between(
                    trace.omega_rad_s[few],
                    middle[few] - half,
                    middle[few] + half,
                    color=style.colour,
                    alpha=BAND_ALPHA,
                    linewidth=0.0,
                )
                for axes, middle, half in zip(pair, (trace.magnitude_db, trace.phase_deg), halves, strict=True)
            ]
    (line,) = pair[0].plot(
        trace.omega_rad_s, trace.magnitude_db, color=style.colour, linestyle=style.dashes, label=label
    )
    pair[1].plot(trace.omega_rad_s, trace.phase_deg, color=style.colour, linestyle=style.dashes, label=label)
    return {label: (bands[0], line) if bands else line}


def draw_data(
    pair: "tuple[Axes, Axes]",
    data: "FrequencyResponse",
    output: str,
    traces: Sequence[Trace],
    *,
    style: LineLook | None = None,
    label: str = "data",
    sideways: float = 1.0,
    cause: str | None = None,
) -> dict[str, Handle]:
    """Draw a measured output with 95 % intervals, used lines filled, the others hollow; return the legend's entries."""
    entries: dict[str, Handle] = {}
    index = channel_of(data.outputs, data.inputs, output, cause)
    points = measured_points(data, index)
    phase = measured_phase_deg(data, index, traces)
    below = np.minimum(points.below_db, ENDLESS_DB)
    colour = DATA if style is None else style.colour
    for chosen, filled, text in (
        (data.used, True, f"{label}, 95 % interval"),
        (~data.used, False, f"{label}, line not used"),
    ):
        if not chosen.any():
            continue
        for axes, middle, bars in (
            (pair[0], points.magnitude_db, np.stack([below, points.above_db])),
            (pair[1], phase, np.stack([points.phase_half_deg] * 2)),
        ):
            entries[text] = axes.errorbar(
                sideways * data.omega_rad_s[chosen],
                middle[chosen],
                yerr=bars[:, chosen],
                linestyle="none",
                marker="o" if style is None else style.marker,
                markersize=3.6,
                color=colour,
                markerfacecolor=colour if filled else "white",
                markeredgewidth=0.8,
                elinewidth=0.8,
                capsize=1.8,
                capthick=0.8,
                zorder=3.0,
                label=text,
            )
    return entries
