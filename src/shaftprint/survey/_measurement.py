"""From a raw recording to the responses that structures are fitted to."""

from collections.abc import Mapping, Sequence
from contextlib import nullcontext
from dataclasses import dataclass, field, replace
from datetime import datetime
from pathlib import Path
from types import MappingProxyType
from typing import Any

from shaftprint.catalogue._roles import ShipRole
from shaftprint.clocks._logger_clock import logger_clocks
from shaftprint.errors import StructureError
from shaftprint.fingerprint._clock_influence import clock_findings, clock_influences
from shaftprint.identify.fit._measured_inputs import has_measured_inputs
from shaftprint.memory import give_back_memory
from shaftprint.models._structure import Structure
from shaftprint.notebook._shown import Shown
from shaftprint.reasons import Note
from shaftprint.recording._level_watch import watch_levels
from shaftprint.recording._levels import Levels
from shaftprint.recording._read import read_recording
from shaftprint.recording._recording import Recording
from shaftprint.signals._clock import Mode
from shaftprint.signals._prepare import prepare_signals
from shaftprint.signals._signals import Signals
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.spectra._closed_loop import plant_from_closed_loop
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._open_loop import governor_and_engine, open_loop
from shaftprint.spectra._spectra import Spectra, estimate_spectra
from shaftprint.spectra._speed_ratios import SpeedRatio
from shaftprint.spectra.lines._bin_selection import ExactBin
from shaftprint.spectra.lines._signal_to_noise import SignalToNoise
from shaftprint.spectra.lines._sine_fit import WholePeriodSine
from shaftprint.survey._legs import LegMeasurement, legs_of, rack_of, structure_at
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.survey._ripple import torque_ripple
from shaftprint.survey._trial import Trial

SINES = "sines"
"""What the working point of sines is called beside those of legs."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Measurement(Shown):
    """What a recording gives before any model is fitted."""

    signals: Signals
    """The prepared recording, with the findings on the clocks of loggers that were merged."""
    spectra: Spectra
    """Responses and signal-to-noise ratios."""
    responses: tuple[FrequencyResponse, ...]
    """What structures are fitted to: the measured response, what follows from it, and that to further excitations."""
    legs: tuple[LegMeasurement, ...] = ()
    """Every leg of the campaign, that of the working point of the signals first."""
    further: Mapping[str, Spectra] = field(default_factory=dict)
    """Spectra of what was moved beside the set point of the speed, by its symbol."""
    levels: Mapping[str, Levels] = field(default_factory=dict)
    """What every raw channel of the recording reaches, by its name."""
    began: datetime | None = None
    """When the recording began, where its file or its user says so."""
    torque_ripple: float | None = None
    """What orders of the shaft line and the noise of the gauge put on top of the shaft torque, over the load: one raw
    sample in a hundred passes it; None where it was not seen."""

    @property
    def working_points(self) -> dict[str, WorkingPoint]:
        """Where the line was tested, by the name of the leg or ``sines``, that of the signals first."""
        main = self.signals.working_point
        of_legs = {leg.name: leg.working_point for leg in self.legs}
        return of_legs if main in of_legs.values() else {SINES: main} | of_legs

    @property
    def signal_to_noise(self) -> SignalToNoise:
        """Signal-to-noise ratios of the lines of sines and of every leg, by name; overall those of the first."""
        return self.spectra.signal_to_noise.with_lines_of([leg.signal_to_noise for leg in self._further_legs])

    @property
    def speed_ratios(self) -> tuple[SpeedRatio, ...]:
        """What the other speed sensors show over the first, of sines and of every leg."""
        return tuple(ratio for one in (self.spectra, *self._further_legs) for ratio in one.speed_ratios)

    @property
    def _further_legs(self) -> list[Spectra]:
        return [leg.spectra for leg in self.legs if leg.spectra is not self.spectra]


def measure(
    recording: str | Path | Recording,
    trial: Trial,
    *,
    mode: Mode = "shaftprint",
    hints: Mapping[str, Any] = MappingProxyType({}),
    progress: Progress = SILENT,
) -> Measurement:
    """Return signals and responses of a recording: of a file, or of one that is open, which stays open.

    Of a file ``hints`` say what it does not, as for ``read_recording``.

    Raises
    ------
    ShaftprintError
        If the recording cannot be read or does not give usable signals and responses.
    """
    progress.begin(f"Reading the recording ({mode} mode)", total=1.0)
    with nullcontext(recording) if isinstance(recording, Recording) else read_recording(recording, **hints) as opened:
        clocks, began, remarks = logger_clocks(opened), opened.began, opened.remarks
        watch = watch_levels(opened)
        signals = prepare_signals(watch.recording, trial.vessel, trial.campaign, mode=mode, progress=progress.reach)
        levels = watch.levels()
        ripple = torque_ripple(opened, signals, trial)
    progress.begin("Measuring the test lines")
    method = ExactBin() if mode == "thesis" else WholePeriodSine()
    legs = legs_of(signals, trial.campaign)
    if legs and not trial.campaign.sines and "X" in signals.channels:
        # one mean of the rack for the leg and for what is told of it
        signals = signals.with_channel("X", reference=legs[0].rack or signals.channels["X"].reference)
    # without sines the leg of the working point is what everything is told of
    spectra = estimate_spectra(signals, trial.campaign, method=method) if trial.campaign.sines else legs[0].spectra
    influences = clock_influences(clocks, spectra=spectra, signals=signals)
    signals = replace(signals, findings=(*signals.findings, *clock_findings(influences), *map(Note, remarks)))
    latency = trial.vessel.sensors.set_point.latency_s or 0.0
    further = {
        name: estimate_spectra(signals, trial.campaign, method=method, excitation=name)
        for name, moved in signals.excitations.items()
        if name != spectra.response.inputs[0] and trial.campaign.of_input(moved.input).sines
    }
    further = {**(legs[0].further if legs else {}), **further}
    responses = responses_of(spectra.response, set_point_latency_s=latency)
    give_back_memory()
    return Measurement(
        signals=signals,
        spectra=spectra,
        responses=(*responses, *(one.response for one in further.values())),
        legs=legs,
        further=further,
        levels=levels,
        began=began,
        torque_ripple=ripple,
    )


def responses_of(response: FrequencyResponse, *, set_point_latency_s: float = 0.0) -> tuple[FrequencyResponse, ...]:
    """Return a measured response and its open-loop forms: with a logged fuel rack also those to and from the rack.

    ``response``: response from ``n_set``. ``set_point_latency_s``: time after which the governor has the set point, as
    far as it is known [s]. The error of the governor alone is formed with it; that of ``M_s / e`` is the measured one,
    since GAUGE-OPEN has the latency as a parameter.
    """
    responses = (response, *open_loop(response))
    if "X" not in response.outputs:
        return responses
    governor, _ = governor_and_engine(response, set_point_latency_s=set_point_latency_s)
    return (*responses, governor, plant_from_closed_loop(response, input="X", output=("n", "M_s")))


def of_legs(measurement: Measurement, names: Sequence[str]) -> Measurement:
    """Return a measurement with some of its legs alone; the first of them is the working point then.

    ``measurement``: of a campaign with legs. ``names``: which to keep; all when none is given. Raises StructureError if
    the recording holds no leg of a name.
    """
    if not names:
        return measurement
    there = {leg.name: leg for leg in measurement.legs}
    unknown = [name for name in names if name not in there]
    if unknown:
        raise StructureError(
            f"leg {', '.join(unknown)}: expected one of {', '.join(there) or 'none'}, found no such leg in the "
            "recording."
        )
    kept = tuple(leg for leg in measurement.legs if leg.name in names)
    first = kept[0]
    return replace(
        measurement,
        signals=measurement.signals.about(first.name),
        spectra=first.spectra,
        legs=kept,
        responses=(
            *responses_of(first.spectra.response),
            *(one.response for one in first.further.values()),
        ),
        further=first.further,
    )


def pairs_of(structure: Structure, measurement: Measurement) -> tuple[tuple[Structure, FrequencyResponse], ...]:
    """Return what is fitted to what: a structure and its response, or for each excited input its part and response.

    An input that can be moved and stood still in this test has no response; the structure keeps its parameters. Legs at
    other working points follow, each with the structure at its own.

    Raises StructureError if the recording does not give the response that a structure describes.
    """
    responses = measurement.responses
    _expect_share_of_one_point(structure, measurement)
    moved = {response.inputs[0] for response in responses}
    rests = {*structure.inputs} - moved
    if rests and structure.inputs[0] in moved and rests <= {*measurement.signals.excitations}:
        structure = structure.of_input(structure.inputs[0])
    main, rack = measurement.signals.working_point, rack_of(measurement.signals)
    further = tuple(leg for leg in measurement.legs if leg.working_point != main)
    parts = _by_input(structure, responses)
    if len(structure.inputs) > 1 and parts:
        of_legs = (
            (structure_at(part, leg.working_point, main=main), response)
            for leg in further
            for part, response in _by_input(structure, leg.responses)
        )
        return (*parts, *of_legs)
    knows_rack = "X" in (*structure.outputs, *structure.inputs)
    return (
        (structure, response_of(structure, responses)),
        *(
            (
                structure_at(
                    structure,
                    leg.working_point,
                    main=main,
                    rack_share=leg.rack / rack if knows_rack and leg.rack and rack else None,
                ),
                response_of(structure, responses_of(leg.spectra.response)),
            )
            for leg in further
        ),
    )


def _expect_share_of_one_point(structure: Structure, measurement: Measurement) -> None:
    if any(p.role == ShipRole.MACHINE_SHARE for p in structure.parameters) and len(measurement.working_points) > 1:
        raise StructureError(
            f"structure {structure.name}: expected one working point, as the share of the electric machine is that of "
            f"one, found {len(measurement.working_points)}; choose one of {', '.join(measurement.working_points)} with "
            "--leg."
        )


def _by_input(
    structure: Structure, responses: Sequence[FrequencyResponse]
) -> tuple[tuple[Structure, FrequencyResponse], ...]:
    """Return the part of a structure behind each of its inputs with its response; nothing where one was not moved."""
    parts = [structure.of_input(name) for name in structure.inputs]
    found = [
        next((one for one in responses if part.inputs == one.inputs and {*part.outputs} <= {*one.outputs}), None)
        for part in parts
    ]
    every = tuple((part, one) for part, one in zip(parts, found, strict=True) if one is not None)
    return every if len(every) == len(parts) else ()


def response_of(structure: Structure, responses: Sequence[FrequencyResponse]) -> FrequencyResponse:
    """Return the response that a structure describes, by the names of its inputs and outputs.

    Further inputs of a structure may have been measured as outputs of the response, such as the speed of GOVERNOR.

    Raises StructureError if there is none.
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
