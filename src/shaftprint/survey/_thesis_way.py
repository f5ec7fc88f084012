"""One recording fitted both ways: weighted on shaftprint's signals, and step by step as in the thesis."""

from dataclasses import replace

import numpy as np

from shaftprint.catalogue._thesis import structure
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.likelihood._weighting import Unweighted
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import Uniform
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._spectra import estimate_response
from shaftprint.spectra.lines._bin_selection import ExactBin, HighestPeak
from shaftprint.survey._fits import fit, priors_of
from shaftprint.survey._measurement import Measurement, responses_of
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._thesis_mode import SET_POINT_OFF, ThesisMode
from shaftprint.survey._trial import Trial

GAUGE = "GAUGE-CLOSED"
"""Structure of a governed line at the quay, beside those of the thesis."""
OF_THE_THESIS = ("OL1", "OL2", "OL3", "OL4", "OL5", "BENCHMARK", "CL1", "CL3", "CL4")
GOVERNORS = ("OL2", "OL3", "OL4", "OL5")
WITH_PICK_UP = "GAUGE-CORE"


def weighted_fits(
    measurement: Measurement, trial: Trial, *, rng: np.random.Generator, progress: Progress = SILENT
) -> tuple[Identification, ...]:
    """Return the gauge-aware structure and those of the thesis, weighted by the measured covariance."""
    structures = [structure(name) for name in (GAUGE, *OF_THE_THESIS)]
    settings = {
        chosen.name: Settings(priors=priors_of(chosen, trial.vessel, measurement.signals)) for chosen in structures
    }
    return fit(structures, measurement, settings=settings, rng=rng, progress=progress)


def thesis_way(
    measurement: Measurement, trial: Trial, *, rng: np.random.Generator, progress: Progress = SILENT
) -> ThesisMode:
    """Return a recording treated step by step as in the thesis, and besides its pick-up taken into the model.

    ``measurement``: of the recording, by ``measure`` in the mode of the thesis. ``trial``: what was tested. ``rng``:
    for the starts of the searches. ``progress``: is told of each step.
    """
    latency = trial.vessel.sensors.shaft_torque.latency_s
    structures = [*(structure(name) for name in OF_THE_THESIS), structure(WITH_PICK_UP).held_at(t_gauge=latency)]
    unweighted = Settings(weighting=Unweighted(), draw=Uniform())
    settings = dict.fromkeys((item.name for item in structures), unweighted)
    fits = fit(structures, measurement, settings=settings, rng=rng, progress=progress)
    off = set_point_scaled(measurement.spectra.response, 1.0 + SET_POINT_OFF)
    measurement_off = replace(measurement, responses=responses_of(off))
    governors = [structure(name) for name in GOVERNORS]
    fits_off = fit(governors, measurement_off, settings=settings, rng=rng, progress=progress)
    return ThesisMode(
        signals=measurement.signals,
        spectra=measurement.spectra,
        identifications={result.structure.name: result for result in fits},
        set_point_off={result.structure.name: result for result in fits_off},
    )


def line_selections(measurement: Measurement, trial: Trial) -> dict[str, FrequencyResponse]:
    """Return the response as other ways to measure a sine would have it; nothing where there are no sines."""
    if not trial.campaign.sines:
        return {}
    others = {"bin of the line": ExactBin(), "highest peak": HighestPeak()}
    return {"whole periods": measurement.spectra.response} | {
        name: estimate_response(measurement.signals, trial.campaign, method=method) for name, method in others.items()
    }


def set_point_scaled(response: FrequencyResponse, factor: float) -> FrequencyResponse:
    """Return what a response from the set point would be, had that been recorded so many times as large."""
    return replace(response, response=response.response / factor, covariance=response.covariance / factor**2)
