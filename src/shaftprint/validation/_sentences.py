"""The outcome of a validation in words."""

from collections.abc import Sequence

import numpy as np

from shaftprint.digits import after_number
from shaftprint.spelling import listed
from shaftprint.units import PERCENT
from shaftprint.validation._model import Model
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._step_comparison import StepNumber
from shaftprint.validation._validation import ExcerptComparison
from shaftprint.validation.measures._misfit import Misfit
from shaftprint.validation.measures._noise_pieces import QuietNoise

WORDS = {"n": "speed", "M_s": "torque"}
# So many excerpts are described, with so many numbers each; the table has them all.
_MOST = 3
# A limit shows in at least so many steps.
FEWEST_ALIKE = 2
_TOLD = ("overshoot", "rise time")


def outcome_sentences(
    model: Model, comparisons: Sequence[ExcerptComparison], settings: ValidationSettings, *, linear: bool
) -> tuple[str, ...]:
    """Return the verdict, the worst excerpts, and what the steps have in common."""
    out_of_sample = [c for c in comparisons if not c.excerpt.in_sample]
    if not out_of_sample:
        return (f"Nothing is proved: {model.name} was identified from every record that it was held against.",)
    what = "The linear validation" if linear else "The validation"
    failed = [c for c in out_of_sample if c.outcome == "fails"]
    limit = f"{PERCENT * settings.largest_error:.0f} % of the motion"
    if failed:
        worst = sorted(failed, key=lambda c: -max(m.error_interval[0] for m in c.misfits))
        records = _listed([c.excerpt.record for c in failed])
        return (
            f"{what} fails: {model.name} misses more than {limit} in {len(failed)} of {len(out_of_sample)} "
            f"excerpts, of {records}.",
            *(_described(c) for c in worst[:_MOST]),
            *(_common_to_steps(failed) if linear else ()),
            *_what_holds(out_of_sample),
        )
    undecided = [c for c in out_of_sample if c.outcome == "undecided"]
    if undecided:
        return (
            f"{what} does not fail, but noise hides whether it holds: {model.name} is within {limit} in "
            f"{len(out_of_sample) - len(undecided)} of {len(out_of_sample)} excerpts; of "
            f"{_listed([_place(c) for c in undecided[:_MOST]])}"
            f"{f' and {len(undecided) - _MOST} more' if len(undecided) > _MOST else ''} the data do not say.",
        )
    return (
        f"{what} passes: {model.name} misses at most {limit} beyond noise in all {len(out_of_sample)} "
        f"excerpts, the most {_worst_of_all(out_of_sample)}.",
    )


def _listed(names: Sequence[str]) -> str:
    return listed(list(dict.fromkeys(names)))


def _place(comparison: ExcerptComparison) -> str:
    return f"{comparison.excerpt.record} ({comparison.excerpt.title})"


def _error(misfit: Misfit) -> str:
    low, high = (PERCENT * end for end in misfit.error_interval)
    return f"{PERCENT * misfit.error:.0f} % ({low:.0f} to {high:.0f} %) of its {WORDS[misfit.output]}"


def _described(comparison: ExcerptComparison) -> str:
    """Return what fails in one excerpt, and the numbers of a step that disagree."""
    parts = _listed([_error(m) for m in comparison.misfits if m.outcome == "fails"])
    apart = [_apart(number) for number in comparison.step_numbers if number.agrees is False and number.name in _TOLD]
    more = f"; {', '.join(apart)}" if apart else ""
    return f"{_place(comparison)}: the model misses {parts}{more}."


def _apart(number: StepNumber) -> str:
    unit = after_number(number.unit)
    digits = 0 if number.unit == "%" else 2
    return (
        f"{number.name} of {WORDS[number.output]} {number.measured:.{digits}f} instead of "
        f"{number.expected:.{digits}f}{unit}"
    )


def _common_to_steps(failed: Sequence[ExcerptComparison]) -> list[str]:
    """Return what a limit does to steps, where the failed ones show it: slower and lower than the model."""
    if not rises_slower_and_lower(failed):
        return []
    steps, slower, lower = _slower_and_lower(failed)
    return [
        f"In {len(slower)} of {len(steps)} failed steps the speed rises more slowly than the model's, in {len(lower)} "
        "it overshoots less: what a limit of torque or of its rate does to a step, and no linear model can do."
    ]


def rises_slower_and_lower(failed: Sequence[ExcerptComparison]) -> bool:
    """Return whether failed steps are slower and overshoot less than the model's, at least two of them each."""
    _, slower, lower = _slower_and_lower(failed)
    return min(len(slower), len(lower)) >= FEWEST_ALIKE


def _slower_and_lower(
    failed: Sequence[ExcerptComparison],
) -> tuple[list[ExcerptComparison], list[ExcerptComparison], list[ExcerptComparison]]:
    steps = [c for c in failed if c.step_numbers]
    slower = [c for c in steps if _differs(c, "rise time") > 0.0]
    lower = [c for c in steps if _differs(c, "overshoot") < 0.0]
    return steps, slower, lower


def _differs(comparison: ExcerptComparison, name: str) -> float:
    """Return by how much a number of the speed differs from the model's; 0 where both agree."""
    for number in comparison.step_numbers:
        if number.output == "n" and number.name == name and number.agrees is False:
            return number.measured - number.expected
    return 0.0


def _what_holds(comparisons: Sequence[ExcerptComparison]) -> list[str]:
    held = [c for c in comparisons if c.outcome == "passes"]
    if not held:
        return []
    return [f"It holds in {len(held)} excerpts: {_listed([_place(c) for c in held])}."]


def _worst_of_all(comparisons: Sequence[ExcerptComparison]) -> str:
    worst = max(comparisons, key=lambda c: max(m.error for m in c.misfits))
    misfit = worst.misfits[int(np.argmax([m.error for m in worst.misfits]))]
    return f"{_error(misfit)} in {_place(worst)}"


def findings_of(
    model: Model,
    comparisons: Sequence[ExcerptComparison],
    noise: QuietNoise,
    *,
    quadratic_propeller: bool,
    linear: bool,
    line_of_stairs: bool,
) -> tuple[str, ...]:
    """Return what the reader should know of how a validation was made."""
    total = sum(stretch.shape[1] for stretch in noise.stretches) / noise.rate_hz
    longest = noise.longest_s
    findings = [
        f"noise is taken from {len(noise.stretches)} stretches in which the set point stands still or a leg repeats "
        f"itself, {total:.0f} s in all, for each excerpt from those of the nearest load"
    ]
    long = [_place(c) for c in comparisons if c.misfits[0].noise_pieces == 0]
    if long:
        findings.append(
            f"no quiet stretch is as long as {_listed(long)}: noise slower than {longest:.0f} s may pass for an error "
            "of the model there"
        )
    if quadratic_propeller:
        findings.append(
            "the torque of the model follows the square of its speed, as that of a propeller in bollard pull"
        )
    elif linear:
        findings.append(
            "the torque of the model is linear in its speed, while that of a propeller goes with the square: at steps "
            "of the set point that is the larger part of what it misses"
        )
    if line_of_stairs and any(c.excerpt.kind != "chirp band" for c in comparisons):
        findings.append(
            "the line from voltage to speed was drawn through the levels of the staircases: how a step is made is new "
            "to the model, where it ends is not"
        )
    if not model.has_uncertainty:
        findings.append(f"nothing is stated about how well the parameters of {model.name} are known: they have no band")
    if model.not_known:
        findings.append(f"the bands leave out {_listed(model.not_known)}, of which the data say nothing")
    seen = [c.excerpt.record for c in comparisons if c.excerpt.in_sample]
    if seen:
        findings.append(f"{model.name} was identified from {_listed(seen)}, which does not count")
    return tuple(findings)
