"""One recording fitted both ways: weighted on shaftprint's signals, and step by step as in the thesis."""

from dataclasses import replace
from pathlib import Path

from shaftprint.catalogue import structure
from shaftprint.cli._chain import Measurement, fit, known_beforehand, measure, responses_of
from shaftprint.cli._inputs import Trial
from shaftprint.cli._progress import Steps
from shaftprint.identify import Identification, Settings, Uniform, Unweighted
from shaftprint.report import SET_POINT_OFF, ThesisMode
from shaftprint.spectra import FrequencyResponse

GAUGE = "GAUGE-CLOSED"
OF_THE_THESIS = ("OL1", "OL2", "OL3", "OL4", "OL5", "BENCHMARK", "CL1", "CL3", "CL4")
GOVERNORS = ("OL2", "OL3", "OL4", "OL5")
WITH_PICK_UP = "GAUGE-CORE"


def weighted_fits(measurement: Measurement, trial: Trial, *, seed: int, steps: Steps) -> tuple[Identification, ...]:
    """Return the gauge-aware structure and those of the thesis, weighted by the measured covariance."""
    structures = [structure(name) for name in (GAUGE, *OF_THE_THESIS)]
    settings = {
        chosen.name: Settings(priors=known_beforehand(chosen, trial.vessel, measurement.signals, {}))
        for chosen in structures
    }
    return fit(structures, measurement, settings=settings, seed=seed, steps=steps)


def thesis_way(recording: Path, trial: Trial, *, seed: int, steps: Steps) -> ThesisMode:
    """Return the recording treated step by step as in the thesis, and besides its pick-up taken into the model."""
    measurement = measure(recording, trial, mode="thesis", steps=steps)
    latency = trial.vessel.sensors.shaft_torque.latency_s
    structures = [*(structure(name) for name in OF_THE_THESIS), structure(WITH_PICK_UP).held_at(t_gauge=latency)]
    unweighted = Settings(weighting=Unweighted(), draw=Uniform())
    settings = dict.fromkeys((found.name for found in structures), unweighted)
    fits = fit(structures, measurement, settings=settings, seed=seed, steps=steps)
    off = set_point_scaled(measurement.spectra.response, 1.0 + SET_POINT_OFF)
    measurement_off = replace(measurement, responses=responses_of(off))
    governors = [structure(name) for name in GOVERNORS]
    fits_off = fit(governors, measurement_off, settings=settings, seed=seed, steps=steps)
    return ThesisMode(
        signals=measurement.signals,
        spectra=measurement.spectra,
        identifications={found.structure.name: found for found in fits},
        set_point_off={found.structure.name: found for found in fits_off},
    )


def set_point_scaled(response: FrequencyResponse, factor: float) -> FrequencyResponse:
    """Return what a response from the set point would be, had that been recorded so many times as large."""
    return replace(response, response=response.response / factor, covariance=response.covariance / factor**2)
