"""The verdict: may the numbers of a fit be used, and which of them.

``assess`` is the whole rule. It asks in turn, and the first no decides:

1. Are there enough good lines, and is there no gap where the loop decides on its stability?
2. Does the structure explain the data within their noise?
3. Is no unstable model better, and is the optimum the only one?
4. Is the identified loop stable?
5. Is any number known well enough to be used?

What is yes but close is a caution, such as a small margin.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Literal

from shaftprint.identify.fit import Identification
from shaftprint.identify.judgement._cautions import cautions_of
from shaftprint.identify.judgement._doubts import (
    better_when_unstable,
    gap_where_it_matters,
    not_explained,
    not_unique,
    too_few_good_data,
    unstable,
)
from shaftprint.identify.judgement._evidence import Evidence
from shaftprint.identify.judgement._phrases import listed, probability
from shaftprint.identify.judgement._requirements import Requirements
from shaftprint.identify.judgement._suspects import Suspect, suspects_of
from shaftprint.identify.judgement._trust import trusted_numbers
from shaftprint.identify.uncertainty import Profile

if TYPE_CHECKING:
    from shaftprint.spectra import SignalToNoise

NOT_BEFORE = "the fit as a whole is not trustworthy"


@dataclass(frozen=True, kw_only=True, slots=True)
class Verdict:
    """Whether the numbers of a fit may be used, and which."""

    trustworthy: bool
    """Whether the trusted numbers may be used."""
    reason: str
    """Why or why not, in one sentence."""
    sentences: tuple[str, ...]
    """The whole verdict in words, the reason first."""
    trusted: tuple[str, ...]
    """Names of the parameters and combinations that may be used."""
    not_trusted: Mapping[str, str]
    """Why the others may not, by name."""
    loop: Literal["ample", "small", "unstable"] | None
    """Stability margins of the identified loop; None for a structure without feedback."""
    suspects: tuple[Suspect, ...] = ()
    """What a structure that does not explain the data may be missing."""
    cautions: tuple[str, ...] = field(default=())
    """What is no reason against the numbers, but close to one."""


def assess(
    identification: Identification,
    *,
    profile: Profile | None = None,
    signal_to_noise: "SignalToNoise | None" = None,
    requirements: Requirements | None = None,
) -> Verdict:
    """Return whether the numbers of a fit may be used, which of them, and why.

    Parameters
    ----------
    identification
        The fit.
    profile
        Its profile likelihood: its intervals are then asked instead of standard deviations, and whether all parameter
        sets that the data allow are stable.
    signal_to_noise
        Signal-to-noise ratios of the recording; without them a line is judged by its covariance alone.
    requirements
        What a fit must satisfy.
    """
    evidence = Evidence.of(identification, profile, signal_to_noise, requirements or Requirements())
    if reason := too_few_good_data(evidence):
        return _refused(evidence, reason)
    if reason := gap_where_it_matters(evidence):
        return _refused(evidence, reason)
    if reason := not_explained(evidence):
        suspects = suspects_of(identification, rejected=evidence.requirements.lowest_p_value)
        return _refused(evidence, reason, suspects=suspects)
    if reason := better_when_unstable(evidence):
        return _refused(evidence, reason)
    if reason := not_unique(evidence):
        return _refused(evidence, reason)
    if reason := unstable(evidence):
        return _refused(evidence, reason)
    trusted, doubts = trusted_numbers(identification, profile, evidence.requirements)
    if not trusted:
        return _refused(evidence, f"No number is known well enough: {_worded(doubts)}.", doubts=doubts)
    return _accepted(evidence, trusted, doubts)


def _refused(
    evidence: Evidence,
    reason: str,
    *,
    suspects: tuple[Suspect, ...] = (),
    doubts: Mapping[str, str] | None = None,
) -> Verdict:
    fit = evidence.identification
    names = [estimate.name for estimate in (*fit.parameters, *fit.combinations)]
    return Verdict(
        trustworthy=False,
        reason=reason,
        sentences=(reason, *(suspect.sentence for suspect in suspects)),
        trusted=(),
        not_trusted=dict.fromkeys(names, NOT_BEFORE) if doubts is None else doubts,
        loop=evidence.loop,
        suspects=suspects,
    )


def _accepted(evidence: Evidence, trusted: tuple[str, ...], doubts: Mapping[str, str]) -> Verdict:
    cautions = cautions_of(evidence)
    reason = _why_trusted(evidence)
    return Verdict(
        trustworthy=True,
        reason=reason,
        sentences=(
            reason,
            f"Trusted: {listed(trusted)}.",
            *([f"Not trusted: {_worded(doubts)}."] if doubts else []),
            *cautions,
        ),
        trusted=trusted,
        not_trusted=doubts,
        loop=evidence.loop,
        cautions=cautions,
    )


def _why_trusted(evidence: Evidence) -> str:
    fit = evidence.identification
    p_value = fit.p_value
    explains = "within what the noise allows" if p_value is None else f"within their noise ({probability(p_value)})"
    rest = (
        " and the optimum is the only one"
        if evidence.loop is None
        else f", the optimum is the only one, and the loop is stable with {evidence.loop} margins"
    )
    return f"The fit can be trusted: {fit.objective.name} explains {evidence.good_lines} good lines {explains}{rest}."


def _worded(doubts: Mapping[str, str]) -> str:
    return "; ".join(f"{name}: {reason}" for name, reason in doubts.items())
