"""The verb: identify a line with its limits, from small signals and large in one likelihood.

Sines that no limit reaches are frequency responses, for which a limited structure is its linear one, exactly; steps,
chirps and the sines that a limit does reach are records.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._thesis import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify
from shaftprint.identify.likelihood._known import priors_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._spectra import estimate_response
from shaftprint.time_domain._identify_in_time import TimeSettings, output_error, with_noise_at
from shaftprint.time_domain._output_error import OutputError
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._signal_records import records_of
from shaftprint.time_domain._simulator import ExactDelays
from shaftprint.time_domain.nonlinear._covariance import with_scatter_of_blocks
from shaftprint.time_domain.nonlinear._drive import with_exact_jumps
from shaftprint.time_domain.nonlinear._jump_resonance import JumpStretch, jump_stretches, without_jumps
from shaftprint.time_domain.nonlinear._limited_sines import limited_sines
from shaftprint.time_domain.nonlinear._numbers import limit_numbers
from shaftprint.time_domain.nonlinear._orders import without_orders
from shaftprint.time_domain.nonlinear._search import Part, best_ends, first_pass, free_values, from_these
from shaftprint.time_domain.nonlinear._settings import NonlinearSettings
from shaftprint.time_domain.nonlinear._structure import LimitedModel
from shaftprint.vessel._vessel import Vessel

LINEAR = "GAUGE-CLOSED"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class NonlinearFit:
    """A line with its limits."""

    identification: Identification
    """The fit: parameters of line and limits with their covariance, and what it leaves; records first, sines last."""
    linear: Identification
    """The linear fit to the sines from which it started."""
    limits: tuple[Estimate, ...]
    """Levels, rates and widths in the units of the ship."""
    lines: tuple[str, ...]
    """Sines that were fitted as frequency responses."""
    records: tuple[str, ...]
    """Tests that were fitted in time."""
    starts: int
    """Number of starts."""
    reached: tuple[int, int]
    """How many of those that went on reached the optimum that led to the one that won, and how many went on."""
    jump_stretches: tuple[JumpStretch, ...] = ()
    """Stretches of records that were not fitted, because noise decides in them what the line does."""


def identify_nonlinear(
    signals: Signals,
    campaign: Campaign,
    vessel: Vessel,
    model: LimitedModel,
    *,
    rng: np.random.Generator,
    records: Sequence[str] | None = None,
    linear: Identification | None = None,
    priors: Mapping[str, Prior] | None = None,
    settings: NonlinearSettings | None = None,
) -> NonlinearFit:
    """Fit a line with its limits to sines, staircases and chirps in one likelihood.

    Parameters
    ----------
    signals, campaign, vessel
        The prepared recording, what was asked, and the installation.
    model
        The limited structure, from ``structure_for``; parameters that are held stay.
    rng
        Source of the starts.
    records
        Names of the staircases and chirps to fit; all by default. Leave some out to validate on them.
    linear
        Fit of GAUGE-CLOSED to the sines, to start from; made if not given.
    priors
        Priors; by default those of the vessel file.
    settings
        How to search.

    Raises
    ------
    SignalError
        If the recording does not hold a record.
    IdentificationError
        If there is no staircase or chirp, or no start reached stable models.
    """
    how = settings or NonlinearSettings()
    names = _large_tests(campaign) if records is None else list(records)
    if not names:
        raise IdentificationError(
            f"campaign {campaign.name}: expected a staircase or a chirp, which limits show in, found none."
        )
    all_priors = priors_from_vessel(model.structure, vessel, signals.working_point, mode=signals.mode)
    all_priors = {
        name: prior for name, prior in (all_priors if priors is None else priors).items() if _is_free(model, name)
    }
    response = estimate_response(signals, campaign)
    quiet = without_orders(signals, vessel)
    first = linear or _linear(_small(model.structure), response, all_priors, rng)
    start = {p.name: p.value for p in first.parameters} | dict(model.start)
    task = _Task(quiet, campaign, model.structure, response, all_priors, how, names, rng)
    sines = task.limited_sines(start)
    for _ in range(2):
        fit, reached = task.solved(start, sines, model.names)
        start = {p.name: p.value for p in fit.parameters}
        before, sines = sines, task.limited_sines(start)
        if set(sines) == set(before):
            break
    fit = with_scatter_of_blocks(fit)
    return NonlinearFit(
        identification=fit,
        linear=first,
        limits=limit_numbers(fit, signals.working_point, vessel),
        lines=tuple(line for line in _lines(response) if line not in before),
        records=(*before, *names),
        starts=how.starts,
        reached=reached,
        jump_stretches=task.jump_stretches(fit),
    )


@dataclass(frozen=True, slots=True, eq=False)
class _Task:
    """What stays the same while sines change sides."""

    signals: Signals
    campaign: Campaign
    structure: Structure
    response: FrequencyResponse
    priors: Mapping[str, Prior]
    how: NonlinearSettings
    names: Sequence[str]
    rng: np.random.Generator

    def limited_sines(self, values: Mapping[str, float]) -> tuple[str, ...]:
        """Return the names of the sines that limits reach at some values."""
        names = _lines(self.response)
        return limited_sines(self.structure, values, self._records(names, self.how.rate_hz, self.how.drive_hz))

    def solved(
        self, start: Mapping[str, float], sines: Sequence[str], drawn: Sequence[str]
    ) -> tuple[Identification, tuple[int, int]]:
        """Return the fit, and how many of the starts that went on reached what led to it, and how many these were."""
        how = self.how
        common = {"rng": self.rng, "settings": how, "priors": self.priors}
        coarse = self._renewed(self._parts(sines, how.coarse_rate_hz, how.coarse_drive_hz, how.coarse_step_s), start)
        first = first_pass(coarse, start, drawn, **common)  # type: ignore[arg-type]
        many = from_these(coarse, best_ends(first, how.better), **common)  # type: ignore[arg-type]
        ends = best_ends(many, how.kept)
        parts = self._parts(sines, how.rate_hz, how.drive_hz, how.step_s)
        best = {p.name: p.value for p in many.parameters}
        for number in range(how.rounds):
            parts = self._renewed(parts, best)
            starts = ends if number == how.rounds - 1 else np.array([list(free_values(parts, best).values())])
            few = from_these(parts, starts, **common)  # type: ignore[arg-type]
            best = {p.name: p.value for p in few.parameters}
            ends[0] = np.array(list(free_values(parts, best).values()))
        return few, (many.reached, many.settings.starts)

    def jump_stretches(self, fit: Identification) -> tuple[JumpStretch, ...]:
        """Return the stretches of staircases and chirps that a fit did not use though they were measured."""
        uncut = {record.name: record for record in self._records(self.names, self.how.rate_hz, self.how.drive_hz)}
        fitted = [term.record for term in fit.objective.terms if isinstance(term, OutputError)]
        return tuple(
            stretch
            for record in fitted
            if record.name in uncut
            for stretch in jump_stretches(record.name, record.time_s, uncut[record.name].used & ~record.used)
        )

    def _parts(self, sines: Sequence[str], rate_hz: float, drive_hz: float, step_s: float) -> list[Part]:
        untouched = np.array([line not in sines for line in self.response.lines])
        records = self._records([*sines, *self.names], rate_hz, drive_hz)
        settings = TimeSettings(simulator=ExactDelays(longest_step_s=step_s))
        terms = [output_error(self.structure, record, settings=settings) for record in records]
        parts: list[Part] = [replace(term, moving_load=True) for term in terms]
        if np.any(self.response.used & untouched):
            # small signals of the limited structure are those of the linear one, whose formulas are at hand
            parts.append((_small(self.structure), replace(self.response, used=self.response.used & untouched)))
        return parts

    def _records(self, names: Sequence[str], rate_hz: float, drive_hz: float) -> list[Record]:
        records = records_of(self.signals, self.campaign, names, rate_hz=rate_hz, settled=True) if names else ()
        return [with_exact_jumps(record, self.campaign, rate_hz=drive_hz) for record in records]

    def _renewed(self, parts: Sequence[Part], values: Mapping[str, float]) -> list[Part]:
        """Return the parts, records with the noise that is left at some values, and without what noise decides."""
        renewed: list[Part] = []
        for part in parts:
            if isinstance(part, OutputError):
                term_values = part.structure.vector({p.name: values.get(p.name, p.value) for p in part.structure.free})
                with_noise = with_noise_at(part, term_values)
                steady = without_jumps(with_noise, term_values, self.rng.spawn(1)[0])
                renewed.append(with_noise if steady is with_noise else with_noise_at(steady, term_values))
            else:
                renewed.append(part)
        return renewed


def _linear(
    gauge: Structure, response: FrequencyResponse, priors: Mapping[str, Prior], rng: np.random.Generator
) -> Identification:
    names = {p.name for p in gauge.free}
    free_priors = {name: prior for name, prior in priors.items() if name in names}
    return identify(gauge, response, rng=rng, settings=Settings(priors=free_priors))


def _small(limited: Structure) -> Structure:
    """Return the linear structure with the parameters held that are held in the limited one."""
    gauge = structure(LINEAR)
    return gauge.held_at(**{p.name: p.value for p in limited.parameters if p.held and p.name in gauge.names})


def _large_tests(campaign: Campaign) -> list[str]:
    return [stair.name for stair in campaign.staircases] + [chirp.name for chirp in campaign.chirps]


def _is_free(model: LimitedModel, name: str) -> bool:
    return name in {p.name for p in model.structure.free}


def _lines(response: FrequencyResponse) -> list[str]:
    """Return the names of the lines that are in use."""
    return [line for line, used in zip(response.lines, response.used, strict=True) if used]
