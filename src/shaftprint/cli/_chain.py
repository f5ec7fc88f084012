"""The way from a raw recording to fitted structures, which ``identify`` and ``demo`` share."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from datetime import UTC, datetime
from pathlib import Path

import numpy as np

from shaftprint.cli._inputs import Trial
from shaftprint.cli._progress import Steps
from shaftprint.clocks import logger_clocks
from shaftprint.errors import StructureError
from shaftprint.fingerprint import Fingerprint, clock_findings, clock_influences, take_fingerprint
from shaftprint.identify import Identification, Prior, Settings, has_measured_inputs, identify, priors_from_vessel
from shaftprint.models import Structure
from shaftprint.recording import read_recording
from shaftprint.signals import Mode, Signals, prepare_signals
from shaftprint.spectra import (
    ExactBin,
    FrequencyResponse,
    Spectra,
    WholePeriodSine,
    estimate_spectra,
    governor_and_engine,
    open_loop,
    plant_from_closed_loop,
)
from shaftprint.vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Measurement:
    """What a recording tells before any model is fitted."""

    signals: Signals
    """The prepared recording."""
    spectra: Spectra
    """Responses and signal-to-noise ratios."""
    responses: tuple[FrequencyResponse, ...]
    """What structures are fitted to: the measured response, and what follows from it."""


def measure(recording: Path, trial: Trial, *, mode: Mode, steps: Steps) -> Measurement:
    """Return signals and responses of a recording.

    Raises
    ------
    ShaftprintError
        If the recording cannot be read or does not give usable signals and responses.
    """
    steps.begin(f"Reading the recording ({mode} mode)", total=1.0)
    with read_recording(recording) as opened:
        clocks = logger_clocks(opened)
        signals = prepare_signals(opened, trial.vessel, trial.campaign, mode=mode, progress=steps.reach)
    steps.begin("Measuring the test lines")
    method = ExactBin() if mode == "thesis" else WholePeriodSine()
    spectra = estimate_spectra(signals, trial.campaign, method=method)
    influences = clock_influences(clocks, spectra=spectra, signals=signals, vessel=trial.vessel)
    signals = replace(signals, findings=(*signals.findings, *clock_findings(influences)))
    latency = trial.vessel.sensors.set_point.latency_s or 0.0
    responses = responses_of(spectra.response, set_point_latency_s=latency)
    return Measurement(signals=signals, spectra=spectra, responses=responses)


def responses_of(response: FrequencyResponse, *, set_point_latency_s: float = 0.0) -> tuple[FrequencyResponse, ...]:
    """Return a measured response and its open-loop forms: with a logged fuel rack also those to and from the rack.

    Parameters
    ----------
    response
        Response from ``n_set``.
    set_point_latency_s
        Time after which the governor has the set point, as far as it is known [s]. The error of the governor alone is
        formed with it; that of ``M_s / e`` is the measured one, since GAUGE-OPEN has the latency as a parameter.
    """
    found = (response, *open_loop(response))
    if "X" not in response.outputs:
        return found
    governor, _ = governor_and_engine(response, set_point_latency_s=set_point_latency_s)
    return (*found, governor, plant_from_closed_loop(response, input="X", output=("n", "M_s")))


def response_of(structure: Structure, responses: Sequence[FrequencyResponse]) -> FrequencyResponse:
    """Return the response that a structure describes, by the names of its inputs and outputs.

    Further inputs of a structure may have been measured as outputs of the response, such as the speed of GOVERNOR.

    Raises
    ------
    StructureError
        If there is none.
    """
    for response in responses:
        alike = structure.inputs == response.inputs and set(structure.outputs) <= set(response.outputs)
        if alike or has_measured_inputs(structure, response):
            return response
    there = "; ".join(f"{', '.join(r.inputs)} to {', '.join(r.outputs)}" for r in responses)
    raise StructureError(
        f"structure {structure.name} goes from {', '.join(structure.inputs)} to {', '.join(structure.outputs)}, which "
        f"this recording does not give; it gives {there}."
    )


def known_beforehand(
    structure: Structure, vessel: Vessel, signals: Signals, given: Mapping[str, Prior]
) -> dict[str, Prior]:
    """Return the priors of a structure: what the vessel file knows, and what the user states instead or besides."""
    return priors_from_vessel(structure, vessel, signals.working_point, mode=signals.mode) | dict(given)


def fit(
    structures: Sequence[Structure],
    measurement: Measurement,
    *,
    settings: Mapping[str, Settings],
    seed: int,
    steps: Steps,
) -> tuple[Identification, ...]:
    """Fit every structure to the response that it describes.

    Parameters
    ----------
    structures
        What to fit.
    measurement
        What to fit it to.
    settings
        How to search, by name of the structure.
    seed
        Seed of the start values; each structure begins with it anew, so that its result does not depend on the others.
    steps
        Progress of the command.

    Raises
    ------
    StructureError
        If the recording does not give the response that a structure describes.
    IdentificationError
        If a structure cannot be fitted.
    """
    steps.begin("Fitting the structures", total=float(len(structures)))
    found = []
    for structure in structures:
        rng = np.random.default_rng(seed)
        response = response_of(structure, measurement.responses)
        found.append(identify(structure, response, rng=rng, settings=settings[structure.name]))
        steps.advance(1.0)
    return tuple(found)


def fingerprint_of(identification: Identification, measurement: Measurement, trial: Trial) -> Fingerprint:
    """Return the fingerprint of one fit, made now."""
    return take_fingerprint(
        identification,
        signals=measurement.signals,
        signal_to_noise=measurement.spectra.signal_to_noise,
        vessel=trial.vessel,
        campaign=trial.campaign,
        settings_files=trial.sources,
        now=datetime.now(UTC),
    )
