"""The verdict: which numbers of a fit may be used, and why the others may not.

``assess`` is the whole rule. Every doubt is a ``Reason``: what the signals and responses bring with them, what the fit
contradicts of the vessel file, and what it asks of the fit itself, where the first no decides:

1. Are there enough good lines, and is there no gap where the loop decides on its stability?
2. Does the structure explain the data within their noise, does no record contradict itself or the others, and are the
   usable lines that were left out predicted?
3. Is no unstable model better, and is the optimum the only one?
4. Is the identified loop stable?

A number is trusted where it depends on none of the reasons and is itself known well enough. What is yes but close is a
caution, such as a small margin.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

from shaftprint.arguments import refusing_none
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._affected_numbers import OF_WORKING_POINT, basis_of, by_weight, clause_of
from shaftprint.identify.judgement._cautions import cautions_of, small_margins
from shaftprint.identify.judgement._clock_drift import drift_reasons
from shaftprint.identify.judgement._data_contradictions import contradicting_data
from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._fit_reasons import (
    better_when_unstable,
    gap_where_it_matters,
    late_channels,
    not_explained,
    not_unique,
    too_few_good_data,
    unstable,
)
from shaftprint.identify.judgement._hold_out_lines import not_predicted
from shaftprint.identify.judgement._input_jump import jump_reasons
from shaftprint.identify.judgement._main_numbers import groups_lost, main_in_words
from shaftprint.identify.judgement._number_precision import ADDS_NOTHING, KNOWN_POORLY, doubts_of, share_of
from shaftprint.identify.judgement._phrases import probability
from shaftprint.identify.judgement._prior_contradictions import beyond_priors, contradicted_priors
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.judgement._suspects import NOT_LINEAR, Suspect, is_gross, suspects_of
from shaftprint.identify.uncertainty._profile import Profile
from shaftprint.identify.uncertainty._profile import profile as find_profile
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.reasons import Reason, ReasonKind
from shaftprint.spelling import listed

if TYPE_CHECKING:
    from shaftprint.spectra.lines._signal_to_noise import SignalToNoise

# What is asked of a fit, in this order; what comes after the first no would only follow from it.
QUESTIONS: tuple[tuple[ReasonKind, Callable[[Evidence], str]], ...] = (
    ("too few data", too_few_good_data),
    ("gap", gap_where_it_matters),
    ("misfit", not_explained),
    ("contradicting data", contradicting_data),
    ("lines left out", not_predicted),
    ("unstable", better_when_unstable),
    ("not unique", not_unique),
    ("unstable", unstable),
)

# Found in samples, lines and working points: beside these a drift of a clock is no cause of its own. They make channels
# late at some lines, or pull at what is known of the line, which a drift between two legs seems to mend.
BEFORE_DRIFT: frozenset[ReasonKind] = frozenset(
    (
        "recording clock",
        "channel clock",
        "held samples",
        "set-point band",
        "late set point",
        "late pitch feedback",
        "gauge latency",
        "speed scale",
        "gauge scale",
        "gauge zero",
        "gauge line",
    )
)


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Verdict(Shown):
    """Which numbers of a fit may be used, and why the others may not."""

    trustworthy: bool
    """Whether the trusted numbers may be used; one of them at least is of the line, not of its speed or set point."""
    reason: str
    """Why or why not, in one sentence."""
    sentences: tuple[str, ...]
    """The whole verdict in words, the reason first."""
    trusted: tuple[str, ...]
    """Names of the numbers that may be used."""
    not_trusted: Mapping[str, str]
    """Why the others may not, by name."""
    loop: Literal["ample", "small", "unstable"] | None
    """Stability margins of the identified loop; None for a structure without feedback."""
    suspects: tuple[Suspect, ...] = ()
    """What a structure that does not explain the data may be missing."""
    cautions: tuple[str, ...] = field(default=())
    """What is no reason against the numbers, but close to one."""
    reasons: tuple[Reason, ...] = ()
    """What speaks against numbers, the most important first; empty where nothing but their own deviation does."""
    assumptions: tuple[str, ...] = ()
    """What the numbers rest on and no recording can show, in sentences."""

    @property
    def words(self) -> str:
        """How far the numbers can be trusted, in a few words; in part where something speaks against some of them."""
        if not self.trustworthy:
            return "not trustworthy"
        if not self.reasons:
            lost = groups_lost(self.trusted, self.not_trusted)
            return f"trustworthy, but not {listed(lost)}" if lost else "trustworthy"
        return f"trustworthy in part, {len(self.trusted)} of {len(self.trusted) + len(self.not_trusted)} numbers"

    def summary(self) -> Summary:
        """Return the reason, and which numbers may be used."""
        title = "the trusted numbers may be used" if self.trustworthy else "no number may be used"
        facts = {
            "reason": self.reason,
            "trusted": shortened(self.trusted),
            "not trusted": shortened(self.not_trusted),
            "cautions": str(len(self.cautions)),
        }
        return Summary(title=f"Verdict: {title}", facts=facts)


@refusing_none(IdentificationError)
def assess(
    identification: Identification,
    *,
    profile: Profile | None = None,
    signal_to_noise: "SignalToNoise | None" = None,
    requirements: Requirements | None = None,
    reasons: Sequence[Reason] = (),
    further: Sequence[Estimate] = (),
    assumptions: Sequence[str] = (),
    cautions: Sequence[str] = (),
    explained_share: float = 0.0,
) -> Verdict:
    """Return which numbers of a fit may be used, and why the others may not.

    Parameters
    ----------
    identification
        The fit.
    profile
        Its profile likelihood, whose intervals are asked; made here where it is not given and the fit is a likelihood.
    signal_to_noise
        Signal-to-noise ratios of the recording; without them a line is judged by its covariance alone.
    requirements
        What a fit must satisfy.
    reasons
        What else speaks against its numbers, such as a contradiction with the vessel file; what speaks against the
        signals and responses comes with the responses.
    further
        Numbers that were made of the parameters, such as physical values, to be judged with them.
    assumptions
        What the numbers rest on and no recording can show.
    cautions
        What else is no reason against its numbers, but close to one.
    explained_share
        Share of the misfit beyond the noise that another structure, which a reason names, takes away; of what may be
        missing only what would take away more is named then.
    """
    evidence = Evidence.of(identification, profile, signal_to_noise, requirements or Requirements())
    of_fit = _of_fit(evidence)
    if not of_fit and profile is None and identification.is_likelihood:
        evidence = replace(evidence, profile=find_profile(identification))
    rejected = any(reason.kind == "misfit" for reason in of_fit)
    suspects = suspects_of(identification, rejected=evidence.requirements.lowest_p_value) if rejected else ()
    suspects = tuple(suspect for suspect in suspects if suspect.share > explained_share)
    hints = tuple(Reason(kind="suspect", sentence=suspect.sentence) for suspect in suspects)
    of_data = tuple(reason for part in identification.experiments for reason in part.response.reasons)
    late = late_channels(evidence)
    is_explained = any(reason.kind in BEFORE_DRIFT for reason in (*of_data, *reasons, *late))
    drifts = () if is_explained else jump_reasons(identification) or drift_reasons(identification)
    pulled = contradicted_priors(identification)
    every = by_weight((*of_data, *reasons, *late, *drifts, *pulled, *of_fit, *hints))
    if rejected and identification.is_likelihood and beyond_priors(identification):
        every = _with_misfit_before(pulled, every)
        if not (of_data or reasons or drifts or hints or explained_share) and is_gross(identification):
            every = (*every, Reason(kind="suspect", sentence=NOT_LINEAR))
    numbers = (*identification.parameters, *identification.combinations, *further)
    imprecise = doubts_of(identification, numbers, evidence.profile, evidence.requirements)
    doubts = {number.name: clause_of(number, every) or imprecise.get(number.name, "") for number in numbers}
    trusted = tuple(name for name, doubt in doubts.items() if not doubt)
    not_trusted = {name: doubt for name, doubt in doubts.items() if doubt}
    # a speed that may be used says nothing of governor, inertia or load
    usable = not of_fit and any(not doubts[one.name] and basis_of(one) - OF_WORKING_POINT for one in numbers)
    of_numbers = cautions_of(evidence, {one.name: one for one in numbers}, not_trusted) if usable else ()
    every_caution = (*cautions, *of_numbers)
    headline = _headline(evidence, every, trusted=trusted, not_trusted=not_trusted, usable=usable)
    sentences = (
        headline,
        *([told] if usable and (told := main_in_words(trusted, not_trusted)) else []),
        # the headline has said the first
        *(reason.sentence for reason in every if reason.sentence not in headline),
        *(() if of_fit else trusted_in_words(trusted, not_trusted)),
        *every_caution,
        *(f"Assumed: {assumption}" for assumption in assumptions),
    )
    return Verdict(
        trustworthy=usable,
        reason=headline,
        sentences=tuple(dict.fromkeys(sentences)),
        trusted=trusted,
        not_trusted=not_trusted,
        loop=evidence.loop,
        suspects=suspects,
        cautions=every_caution,
        reasons=every,
        assumptions=tuple(assumptions),
    )


def _with_misfit_before(pulled: Sequence[Reason], every: Sequence[Reason]) -> tuple[Reason, ...]:
    """Return reasons with the misfit before the priors that it pulls."""
    misfit = next(reason for reason in every if reason.kind == "misfit")
    others = [reason for reason in every if reason is not misfit]
    place = next((i for i, reason in enumerate(others) if reason in pulled), every.index(misfit))
    return (*others[:place], misfit, *others[place:])


def _of_fit(evidence: Evidence) -> tuple[Reason, ...]:
    """Return the first thing that speaks against a fit as a whole."""
    for kind, question in QUESTIONS:
        if sentence := question(evidence):
            return (Reason(kind=kind, sentence=sentence),)
    return ()


def _headline(
    evidence: Evidence,
    reasons: tuple[Reason, ...],
    *,
    trusted: tuple[str, ...],
    not_trusted: Mapping[str, str],
    usable: bool,
) -> str:
    """Return whether the numbers may be used, and why or why not."""
    if reasons and not usable:
        return reasons[0].sentence
    if not usable:
        return f"No number is known well enough: {_worded(not_trusted)}."
    if reasons:
        return f"Part of the numbers can be trusted. {reasons[0].sentence}"
    return _why_trusted(evidence, not_trusted)


def _why_trusted(evidence: Evidence, not_trusted: Mapping[str, str]) -> str:
    fit = evidence.identification
    p_value = fit.p_value
    explains = "within what the noise allows" if p_value is None else f"within their noise ({probability(p_value)})"
    # of one start nobody knows whether it is
    clauses = ["the optimum is the only one"] if evidence.search.agreeing > 1 else []
    # margins that are not to be used are no finding
    known = evidence.loop != "small" or any(name not in not_trusted for name in small_margins(evidence))
    size = f" with {evidence.loop} margins" if known else ""
    clauses += [] if evidence.loop is None else [f"the loop is stable{size}"]
    ending = "".join(f", {clause}" for clause in clauses[:-1]) + (", and" if len(clauses) > 1 else " and")
    uniqueness = f"{ending} {clauses[-1]}" if clauses else ""
    return f"The fit can be trusted: {fit.objective.name} explains {_data_words(evidence)} {explains}{uniqueness}."


def _data_words(evidence: Evidence) -> str:
    """Return what was fitted: good lines, and records with their length and how well they are met."""
    records = [part for part in evidence.identification.parts if part.seconds > 0.0]
    percents = [percent for part in records for percent in part.fit_percent.values()]
    words = []
    if evidence.good_lines or not records:
        fitted = sum(experiment.s.size for experiment in evidence.identification.objective.experiments)
        of_fitted = f" of {fitted}" if fitted > evidence.good_lines else ""
        words.append(f"{evidence.good_lines} good spectral lines{of_fitted}")
    if records:
        count = "1 record" if len(records) == 1 else f"{len(records)} records"
        low, high = min(percents), max(percents)
        percent = f"{low:.1f}" if low == high else f"{low:.1f} to {high:.1f}"
        words.append(f"{count} of {sum(part.seconds for part in records):.3g} s (FitPercent {percent} %)")
    return listed(words)


def trusted_in_words(trusted: tuple[str, ...], not_trusted: Mapping[str, str]) -> list[str]:
    """Return which numbers are trusted and which are not, in sentences; nothing where none is."""
    if not trusted:
        return []
    return [f"Trusted: {listed(trusted)}.", *([f"Not trusted: {_worded(not_trusted)}."] if not_trusted else [])]


def _worded(doubts: Mapping[str, str]) -> str:
    """Return the names that share a doubt together, each doubt once; of several known to a share, each with its own."""
    shares = {name: share for name, doubt in doubts.items() if (share := share_of(doubt))}
    has_several = len(set(shares.values())) > 1
    names: dict[str, list[str]] = {}
    for name, doubt in doubts.items():
        if has_several and name in shares:
            names.setdefault(KNOWN_POORLY, []).append(f"{name} ({shares[name]})")
        else:
            # by how little is told where the number itself is
            names.setdefault(ADDS_NOTHING if doubt.startswith(ADDS_NOTHING) else doubt, []).append(name)
    return "; ".join(f"{listed(group)}: {doubt}" for doubt, group in names.items())
