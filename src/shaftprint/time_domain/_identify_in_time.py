"""Fits in time: from a start through the colour of the noise to estimates with the right uncertainty.

The noise of a record is not known beforehand, and what a wrong model leaves is no noise. So the fit goes in rounds: the
residuals of the last one, without what the inputs still explain of them, give the noise model of the next. Estimates
and noise model are independent to first order (Ljung, System Identification: Theory for the User, second edition,
section 9.4), so that after two or three rounds nothing moves, and the covariance is that of a known noise.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from types import MappingProxyType
from typing import TypeAlias

import numpy as np

from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify_jointly, searched_optima
from shaftprint.identify.fit._sensor import with_sensor
from shaftprint.identify.likelihood._load_factors import with_load
from shaftprint.identify.likelihood._term import Term
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.time_domain._input_response import noise_of
from shaftprint.time_domain._noise_model import LONGEST_S, estimate_noise, white_noise
from shaftprint.time_domain._nuisance import usual_drift_degree
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._record_fit import RecordFit
from shaftprint.time_domain._simulator import ExactDelays, Simulator
from shaftprint.time_domain._whitening import Whitening

# Share of the cost that a round may leave undone: its optimum gives the noise of the next, and no digit rests on it.
OF_A_ROUND = 1e-8

Source: TypeAlias = tuple[Structure, Record | FrequencyResponse] | Term
Part: TypeAlias = tuple[Structure, FrequencyResponse] | Term


@dataclass(frozen=True, kw_only=True, slots=True)
class TimeSettings:
    """What is taken out of records beside the model, and how their noise is found."""

    drift_degree: int | None = None
    """Highest power of time in what is projected out of each output: 0 for offsets, 1 for drifts, -1 for nothing. If
    not given 0 for a record of steps, whose levels a drift would take, and 1 for others."""
    anew_after_s: float = 10.0
    """A gap longer than this [s] begins offset and drift anew."""
    initial_states: bool = False
    """Whether the states at the start of a record are estimated; else it begins in steady running, or its first seconds
    are not used."""
    rounds: int = 3
    """How many times the noise is estimated anew; 0 for white noise of each output."""
    longest_memory_s: float = LONGEST_S
    """Longest memory of the noise that is tried [s]."""
    simulator: Simulator = field(default_factory=ExactDelays)
    """How structures are simulated."""
    assumed: Mapping[str, float] = field(default_factory=dict)
    """Held parameters that are assumed and not known, with their standard deviations: what they change is no misfit,
    and what it looks like is known less."""

    def __post_init__(self) -> None:
        """Check the numbers.

        Raises IdentificationError if one is out of range.
        """
        degree = 0 if self.drift_degree is None else self.drift_degree
        if degree < -1 or self.rounds < 0 or not (self.longest_memory_s >= 0.0 and self.anew_after_s >= 0.0):
            raise IdentificationError(
                f"fit in time: expected a drift degree of at least -1 and no negative rounds or times, found {self}."
            )


def output_error(structure: Structure, record: Record, *, settings: TimeSettings | None = None) -> OutputError:
    """Return the likelihood of a record, its noise white and as strong as the outputs: ``with_noise`` gives another.

    Parameters
    ----------
    structure
        Structure with the record's inputs, and outputs that the record has. Held parameters of a speed sensor and the
        propeller load are the record's.
    settings
        What is taken out of it.

    Raises
    ------
    IdentificationError
        If structure and record do not fit together, or nothing is free.
    """
    chosen = settings or TimeSettings()
    missing = [name for name in structure.outputs if name not in record.outputs]
    if missing or set(structure.inputs) != set(record.inputs):
        raise IdentificationError(
            f"structure {structure.name} goes from {', '.join(structure.inputs)} to {', '.join(structure.outputs)}, "
            f"record {record.name} from {', '.join(record.inputs)} to {', '.join(record.outputs)}: choose a structure "
            "with these channels."
        )
    equipped = with_load(with_sensor(structure, record), record.load)
    outputs = np.stack([record.outputs[name] for name in equipped.outputs], axis=1)
    free = tuple(i for i, p in enumerate(equipped.parameters) if not p.held)
    return OutputError(
        structure=equipped,
        record=record,
        whitening=Whitening(noise=white_noise(outputs - outputs[record.used].mean(axis=0), record.stretches)),
        simulator=chosen.simulator,
        drift_degree=usual_drift_degree(record) if chosen.drift_degree is None else chosen.drift_degree,
        anew_after_s=chosen.anew_after_s,
        initial_states=chosen.initial_states,
        longest_memory_s=chosen.longest_memory_s,
        held=equipped.vector({}),
        free=free,
        places=free,
        columns=tuple(range(len(free))),
    )


def with_noise_at(
    term: OutputError,
    values: FloatArray,
    *,
    longest_memory_s: float = LONGEST_S,
    assumed: Mapping[str, float] = MappingProxyType({}),
) -> OutputError:
    """Return a term with the noise that is left at some parameters.

    ``values``: all parameters of the structure, shape (parameters,). ``longest_memory_s``: longest memory that is tried
    [s]. ``assumed``: held parameters that are assumed, with their standard deviations. Raises IdentificationError if
    the simulation runs away there, or nothing is left.
    """
    noise = noise_of(term.residuals(values), term.record)
    order = round(longest_memory_s * term.record.rate_hz)
    renewed = term.with_noise(Whitening(noise=estimate_noise(noise, term.record.stretches, max_order=order)))
    return renewed.with_assumed(assumed, values)


@refusing_none(IdentificationError)
def identify_in_time(
    pairs: Sequence[Source],
    *,
    rng: np.random.Generator,
    settings: Settings | None = None,
    time: TimeSettings | None = None,
    start: Mapping[str, float] | Identification | None = None,
) -> Identification:
    """Fit structures to records, and to frequency responses beside them, in one likelihood.

    The data are independent of each other, each record has its own noise, and parameters of one name are one parameter.

    Parameters
    ----------
    pairs
        Each structure with a record or a frequency response, or terms.
    rng
        Source of the start values.
    settings
        How to search; of its starts the first is the known one.
    time
        What is taken out of the records, and how their noise is found.
    start
        Values of free parameters by name, or a fit, to start from. When not given that is a fit to the frequency
        responses; where there are none, the best of all starts with white noise.

    Raises
    ------
    IdentificationError
        If a structure and its data do not fit together, there are too few data, the simulation of the start runs away,
        or no start reached stable models.
    """
    chosen, how = settings or Settings(), time or TimeSettings()
    parts = [_term(pair, how) for pair in pairs]
    if not any(isinstance(part, OutputError) for part in parts):
        raise IdentificationError("fit in time: expected at least one structure with a record, found none.")
    _expect_known_slope(parts)
    first = _start(parts, rng, chosen, start)
    for _ in range(how.rounds):
        parts = [_renewed(part, first, how) for part in parts]
        rough = replace(chosen, starts=1, leader_tolerance=max(chosen.leader_tolerance, OF_A_ROUND))
        first = _searched(parts, rng, _from(parts, first, rough))
    return _with_states(identify_jointly(parts, rng=rng, settings=_from(parts, first, chosen)))


def _expect_known_slope(parts: Sequence[Part]) -> None:
    """Refuse records whose load may move where nothing else tells of the load's slope.

    Raises IdentificationError if it is free in such a record and in no other data.
    """
    slopes = [next((p.name for p in _structure(part).free if p.role == ShipRole.LOAD_SLOPE), "") for part in parts]
    with_slope = [part for part, slope in zip(parts, slopes, strict=True) if slope]
    moving = [part for part in with_slope if isinstance(part, OutputError) and part.moving_load]
    if moving and len(moving) == len(with_slope):
        slope = next(filter(None, slopes))
        raise IdentificationError(
            f"{moving[0].name}: a load that may move takes the torque that another {slope} would give, so that the "
            f"record cannot tell {slope}; hold it with structure.held_at({slope}=...), add a frequency response, or "
            "fit with moving_load=False."
        )


def _with_states(fit: Identification) -> Identification:
    """Return a fit whose initial states and offsets have deviations that hold those of the parameters too."""
    parts = []
    for term, part in zip(fit.objective.terms, fit.parts, strict=True):
        if isinstance(term, OutputError) and isinstance(part, RecordFit):
            covariance = fit.covariance[np.ix_(term.columns, term.columns)]
            values = term.structure_values(fit.values)
            stopped = np.array([fit.parameters[column].at_bound for column in term.columns])
            states, offsets = term.beside(values, covariance, stopped=stopped)
            part = replace(part, initial_states=states, offsets=offsets)
        parts.append(part)
    return replace(fit, parts=tuple(parts))


def _term(pair: Source, how: TimeSettings) -> Part:
    if isinstance(pair, tuple) and len(pair) == 2 and isinstance(pair[1], Record):
        return output_error(pair[0], pair[1], settings=how)
    return pair  # type: ignore[return-value]  # what is neither is refused by the fit


def _start(
    parts: Sequence[Part],
    rng: np.random.Generator,
    settings: Settings,
    start: Mapping[str, float] | Identification | None,
) -> dict[str, float]:
    if isinstance(start, Identification):
        return _values(start)
    if start is not None:
        return dict(start)
    responses = [part for part in parts if not isinstance(part, OutputError)]
    if not responses:
        return _searched(parts, rng, settings)
    names = {p.name for structure in map(_structure, responses) for p in structure.free}
    narrower = replace(
        settings,
        priors={name: prior for name, prior in settings.priors.items() if name in names},
        regularisation={name: prior for name, prior in settings.regularisation.items() if name in names},
    )
    return _searched(responses, rng, narrower)


def _searched(parts: Sequence[Part], rng: np.random.Generator, settings: Settings) -> dict[str, float]:
    """Return the best free parameters by name; nobody asks how good they are."""
    optima = searched_optima(parts, rng=rng, settings=settings)
    named = zip(optima.objective.names, optima.winner.values.tolist(), strict=True)
    free = {p.name for p in optima.objective.free_parameters}
    return {name: value for name, value in named if name in free}


def _values(fit: Identification) -> dict[str, float]:
    return {p.name: p.value for p in fit.parameters}


def _structure(part: Part) -> Structure:
    return part.structure if isinstance(part, Term) else part[0]


def _renewed(part: Part, first: Mapping[str, float], how: TimeSettings) -> Part:
    """Return a record's term with the noise at some values; what else there is stays as it is."""
    if not isinstance(part, OutputError):
        return part
    free = {p.name: first.get(p.name, p.value) for p in part.structure.free}
    values = part.structure.vector(free)
    return with_noise_at(part, values, longest_memory_s=how.longest_memory_s, assumed=how.assumed)


def _from(parts: Sequence[Part], first: Mapping[str, float], settings: Settings) -> Settings:
    """Return the settings with the known values as their first start."""
    free = {p.name: p.value for structure in map(_structure, parts) for p in structure.free}
    values = np.array([first.get(name, value) for name, value in free.items()])
    return replace(settings, draw=GivenStarts(values[None], settings.draw))
