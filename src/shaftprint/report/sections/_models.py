"""The sections of a report on models: structures of the thesis, thesis mode, sensitivity."""

from collections.abc import Mapping
from functools import partial
from typing import TYPE_CHECKING

from shaftprint.escape import plain_name
from shaftprint.report._curve import Curve, closed_loop_curve, open_loop_curve
from shaftprint.report.figures._bode import bode_chart
from shaftprint.report.figures._explanation import missing_damping_chart
from shaftprint.report.figures._responses import CRITICAL_SPAN_RAD_S
from shaftprint.report.figures._sensitivity import sensitivity_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.report.thesis._explanation import can_explain, explain_thesis
from shaftprint.report.thesis._thesis_mode import thesis_findings, thesis_fit_table
from shaftprint.report.thesis._words import (
    damping_table,
    explanation_sentences,
    gain_table,
    inertia_table,
    integral_table,
)
from shaftprint.spectra._open_loop import open_loop

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.spectra._frequency_response import FrequencyResponse

ROWS_A_FIGURE = 4
GOVERNOR = ("OL2", "OL3", "OL4", "OL5")
CLOSED = ("CL1", "CL3", "CL4", "BENCHMARK")
OF_THE_THESIS = ("OL1", *GOVERNOR, *CLOSED)
EXPLAINED = (inertia_table, damping_table, gain_table, integral_table)
BAND_NOTE = "Bands hold the noise only: of a structure that does not explain the data they are too narrow."


def thesis_section(inputs: Inputs) -> list[Section]:
    """Return what the thesis' way makes of the same recording; nothing where it was not tried."""
    thesis = inputs.thesis
    if thesis is None:
        return []
    limit = thesis.signals.engine_speed.nyquist_hz
    return [
        Section(
            key="thesis-mode",
            title="The thesis' way on the same recording",
            paragraphs=(
                "Signals, lines and fits of this section are done step by step as in the thesis: speeds held for one "
                "turn of the engine, no anti-alias filter, bins of the Fourier transform, fits without weights.",
            ),
            points=thesis_findings(thesis, inputs.vessel),
            tables=(thesis_fit_table(thesis),),
            pictures=fit_pictures(thesis.identifications, thesis.spectra.response, limit, prefix="thesis_mode"),
        )
    ]


def explanation_section(inputs: Inputs) -> list[Section]:
    """Return where the thesis' numbers come from; nothing where its way was not tried with all structures."""
    thesis = inputs.thesis
    fits = {**inputs.fits, inputs.identification.structure.name: inputs.identification}
    if thesis is None or not can_explain(thesis, fits):
        return []
    explanation = explain_thesis(thesis, fits, inputs.spectra.response, inputs.vessel)
    return [
        Section(
            key="explanation",
            title="Where the thesis' numbers come from",
            paragraphs=explanation_sentences(explanation),
            tables=tuple(make(explanation) for make in EXPLAINED),
            pictures=(
                Picture(
                    name="missing_damping",
                    caption="Governor and engine without and with the inertia upstream of the gauge; the closed loop.",
                    alt="Bode diagram of M_s / e from 0.5 to 12 rad/s with two models and the measured points.",
                    chart=partial(missing_damping_chart, explanation),
                ),
            ),
        )
    ]


def structure_section(inputs: Inputs) -> list[Section]:
    """Return the structures of the thesis and others on shaftprint's responses; nothing where there are none."""
    if not inputs.fits:
        return []
    pictures = fit_pictures(inputs.fits, inputs.spectra.response, inputs.aliasing_limit_hz, prefix="structures")
    others = [fit for name, fit in inputs.fits.items() if name not in OF_THE_THESIS]
    what = "Other" if others else "The thesis'"
    return [
        Section(
            key="structures",
            title=f"{what} structures on shaftprint's responses",
            pictures=[*pictures, *(_other_fit(fit, inputs.aliasing_limit_hz) for fit in others)],
        )
    ]


def _other_fit(fit: "Identification", limit_hz: float) -> Picture:
    """Return a structure that the thesis does not have beside the response that it was fitted to."""
    name = fit.structure.name
    return Picture(
        name=f"structures_{plain_name(name.lower())}",
        caption=f"{name}: {fit.structure.title}, with data. {BAND_NOTE}",
        alt=f"Bode diagram of the model {name} and the measured points.",
        chart=partial(bode_chart, [Curve.of(fit)], data=fit.response, aliasing_limit_hz=limit_hz),
    )


def fit_pictures(
    fits: Mapping[str, "Identification"], response: "FrequencyResponse", limit_hz: float, *, prefix: str
) -> list[Picture]:
    """Return figures 5.1 to 5.5 of the thesis as far as their fits are there."""
    governor, core = open_loop(response)
    curves = {name: Curve.of(fit) for name, fit in fits.items()}
    selected = _selected(curves)
    benchmark = [open_loop_curve(curves["BENCHMARK"])] if "BENCHMARK" in curves else []
    plans = (
        ("5.1", core, [curves["OL1"]] if "OL1" in curves else [], "core propulsion"),
        ("5.2", governor, [curves[n] for n in GOVERNOR if n in curves], "governor and engine"),
        ("5.3", response, [curves[n] for n in CLOSED if n in curves], "closed loop"),
        ("5.4", response, selected, "selected sets in closed loop"),
        ("5.5", governor, [open_loop_curve(c) for c in selected], "selected sets in open loop"),
    )
    pictures = []
    for number, data, chosen, what in plans:
        if not chosen:
            continue
        is_governor = number in ("5.2", "5.5")
        drawn = chosen + benchmark if is_governor else chosen
        names = ", ".join(curve.label for curve in drawn)
        pictures.append(
            Picture(
                name=f"{prefix}_{number.replace('.', '_')}",
                caption=f"{what.capitalize()}: {names} with data (thesis, figure {number}). {BAND_NOTE}",
                alt=f"Bode diagram of {what}: the models {names} and the measured points.",
                chart=partial(
                    bode_chart,
                    drawn,
                    data=data,
                    aliasing_limit_hz=limit_hz,
                    zoom_rad_s=CRITICAL_SPAN_RAD_S if is_governor else None,
                ),
            )
        )
    return pictures


def _selected(curves: Mapping[str, Curve]) -> list[Curve]:
    """Return the sets that the thesis compares: CL3, CL4, OL1+OL4, OL1+OL5."""
    selected = [curves[name] for name in ("CL3", "CL4") if name in curves]
    if "OL1" in curves:
        selected += [closed_loop_curve(curves["OL1"], curves[name]) for name in ("OL4", "OL5") if name in curves]
    return selected


def sensitivity_section(inputs: Inputs) -> list[Section]:
    """Return the Bode families of the wanted structures; nothing where none is wanted."""
    pictures = []
    for model in inputs.sensitivity:
        fit = inputs.identification
        same = model.names == fit.structure.names
        values = dict(zip(model.names, fit.values.tolist(), strict=True)) if same else {}
        free = [parameter.name for parameter in model.free]
        output, cause = model.channels[0]
        for first in range(0, len(free), ROWS_A_FIGURE):
            names = free[first : first + ROWS_A_FIGURE]
            pictures.append(
                Picture(
                    name=f"sensitivity_{plain_name(model.name.lower())}_{first // ROWS_A_FIGURE + 1}",
                    caption=(
                        f"{model.name}, {output} / {cause}: {', '.join(names)} varied one at a time between the "
                        f"bounds, the others at their {'identified' if same else 'default'} values."
                    ),
                    alt=f"Rows of Bode diagrams, one for each of {', '.join(names)}, with five lines each.",
                    chart=partial(sensitivity_chart, model, vary=names, values=values),
                )
            )
    return [Section(key="sensitivity", title="Sensitivity", pictures=pictures)] if pictures else []
