"""Why one structure wins over others, in sentences."""

from collections.abc import Mapping, Sequence

from shaftprint.identify.comparison._comparison import Candidate
from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio
from shaftprint.identify.judgement._misfit import explained, misfit_words
from shaftprint.identify.judgement._phrases import probability

# What a difference of BIC is worth (Kass and Raftery, Bayes factors, 1995, section 3.2).
WORTH = ((10.0, "very strong evidence"), (6.0, "strong evidence"), (2.0, "some evidence"))
# Parameters more are needed where a test rejects that they are nothing.
NEEDED = 0.05


def comparison_words(
    candidates: Sequence[Candidate], failed: Mapping[str, str], ratios: Sequence[LikelihoodRatio]
) -> tuple[str, ...]:
    """Return which structure wins and why, most important first."""
    best = candidates[0]
    return (
        _winner(candidates),
        *([] if any(explained(c.identification) for c in candidates) else [_none_explains(best)]),
        *(_explanation(candidate) for candidate in candidates),
        *(_ratio(ratio) for ratio in ratios if best.name in (ratio.small, ratio.large)),
        *_predicting(candidates),
        *(f"{name} could not be fitted: {reason}" for name, reason in failed.items()),
    )


def _winner(candidates: Sequence[Candidate]) -> str:
    best, *others = candidates
    if not others:
        return f"{best.name} is the only structure that could be fitted."
    second = others[0]
    gap = second.criteria.bic - best.criteria.bic
    worth = next((words for least, words in WORTH if gap >= least), "")
    if not worth:
        return (
            f"{best.name} and {second.name} cannot be told apart by these data: their BIC differ by {gap:.1f} only; "
            f"{best.name} is taken."
        )
    return f"{best.name} wins: its BIC is {gap:.1f} below that of {second.name}, the next ({worth})."


def _none_explains(best: Candidate) -> str:
    return f"None of the structures explains the data within their noise: {best.name} is only the least wrong."


def _explanation(candidate: Candidate) -> str:
    fit, name = candidate.identification, candidate.name
    if not fit.is_likelihood:
        percent = ", ".join(
            f"{output} {value:.1f} % (a perfect model {fit.fit_ceiling[output]:.1f} %)"
            for output, value in fit.fit_percent.items()
        )
        return f"{name} reaches a FitPercent of {percent}."
    p_value = fit.p_value
    if p_value is None:
        return f"{name} has as many parameters as there are data: whether it explains them cannot be tested."
    square = f"chi-square {fit.chi_square:.0f} for {fit.degrees_of_freedom} degrees of freedom"
    if explained(fit):
        return f"{name} explains the data ({square}, {probability(p_value)})."
    return f"{name} is rejected ({square}, {probability(p_value)}); {misfit_words(fit)}."


def _ratio(ratio: LikelihoodRatio) -> str:
    drawn = f" from {ratio.draws} drawn tests, since {ratio.reason}" if ratio.draws else ""
    needed = "needed" if ratio.p_value < NEEDED else "not needed"
    more = f"lower the deviance by {ratio.statistic:.1f} and are {needed}"
    if ratio.extra == 0:
        worth = "no parameter more that the data can find"
        worth += f"; its other bounds or priors {more}" if ratio.p_value < NEEDED else ""
    elif ratio.extra == 1:
        worth = f"one more parameter lowers the deviance by {ratio.statistic:.1f} and is {needed}"
    else:
        worth = f"{ratio.extra} more parameters {more}"
    return f"{ratio.large} holds {ratio.small} as a special case: {worth} ({probability(ratio.p_value)}{drawn})."


def _predicting(candidates: Sequence[Candidate]) -> list[str]:
    """Return who predicts left-out lines best, in units of the noise variance."""
    tested = [(c, c.hold_out) for c in candidates if c.hold_out is not None]
    if len(tested) < 2:
        return []
    ordered = sorted(tested, key=lambda pair: pair[1].square)
    words = ", ".join(f"{f.square:.3g} by {c.name} ({f.expected:.3g} expected)" for c, f in ordered)
    lines = [
        f"Lines left out of the fit are predicted with a mean squared error, over their noise variance, of {words}."
    ]
    if ordered[0][0] is not candidates[0]:
        lines.append(
            f"{ordered[0][0].name} predicts left-out lines better than {candidates[0].name}, which BIC prefers: "
            "the data do not decide between them."
        )
    return lines
