"""Tables of several structures on the same data: fits side by side, criteria, tests of one within another."""

from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, plain, rounded, with_deviation
from shaftprint.plain_table import Table, numbers, texts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.identify.comparison._comparison import Candidate, StructureComparison
    from shaftprint.identify.comparison._likelihood_ratio import LikelihoodRatio
    from shaftprint.identify.fit._estimate import Estimate
    from shaftprint.identify.fit._identification import Identification

HOLD_OUT_NOTE = (
    " The last two columns are the mean squared error of held-out lines, in units of their noise variance: found, and "
    "predicted for a right structure."
)


def structure_tables(comparison: "StructureComparison") -> list[Table]:
    """Return the criteria of all structures, and the tests of structures within larger ones."""
    structure = comparison.best.identification.structure
    channels = f"{', '.join(structure.outputs)} from {', '.join(structure.inputs)}"
    held_out = any(candidate.hold_out is not None for candidate in comparison.candidates)
    criteria = Table(
        title=f"Structures of {channels}, lowest BIC first",
        columns=(
            *texts("structure"),
            *numbers("parameters", "chi-square", "freedom", "p", "AIC", "AICc", "BIC", "BIC weight", "FPE"),
            *numbers("held-out lines", "predicted") * held_out,
        ),
        rows=tuple(
            (*_criteria_cells(candidate, comparison), *_hold_out_cells(candidate) * held_out)
            for candidate in comparison.candidates
        ),
        note=(
            f"Fitted to the same {comparison.best.criteria.data} data, two a complex value. The lower the criteria "
            "the better; the BIC weight is the share that BIC gives a structure if one of them is right."
            f"{HOLD_OUT_NOTE if held_out else ''}"
        ),
    )
    if not comparison.ratios:
        return [criteria]
    tests = Table(
        title=f"Structures of {channels} within larger ones",
        columns=(
            *texts("smaller", "larger"),
            *numbers("parameters more", "deviance lower by", "p"),
            *texts("from"),
        ),
        rows=tuple(_ratio_row(ratio) for ratio in comparison.ratios),
        note="p is the probability of such a fall or a larger one if the smaller structure holds.",
    )
    return [criteria, tests]


def _criteria_cells(candidate: "Candidate", comparison: "StructureComparison") -> tuple[str, ...]:
    fit, criteria = candidate.identification, candidate.criteria
    return (
        candidate.name,
        plain(criteria.parameters, 1),
        plain(fit.chi_square, 0) if fit.is_likelihood else "–",
        str(fit.degrees_of_freedom),
        p_value_text(fit.p_value),
        *(plain(value, 1) for value in (criteria.aic, criteria.aicc, criteria.bic)),
        f"{plain(PERCENT * comparison.weights[candidate.name], 1)} %",
        rounded(criteria.fpe, 3),
    )


def _hold_out_cells(candidate: "Candidate") -> tuple[str, str]:
    hold_out = candidate.hold_out
    return ("–", "–") if hold_out is None else (rounded(hold_out.square, 3), rounded(hold_out.expected, 3))


def _ratio_row(ratio: "LikelihoodRatio") -> tuple[str, ...]:
    source = f"{ratio.draws} drawn tests" if ratio.draws else "an upper bound" if ratio.reason else "chi-square"
    return (
        *(ratio.small, ratio.large, str(ratio.extra), plain(ratio.statistic, 1), p_value_text(ratio.p_value)),
        source,
    )


def fits_table(title: str, identifications: "Sequence[Identification]") -> Table:
    """Return FitPercent, starts, stability and parameters of each fit."""
    return Table(
        title=title,
        columns=(
            *texts("structure", "FitPercent", "perfect model"),
            *numbers("starts", "gain margin"),
            *texts("parameters ± std"),
        ),
        rows=tuple(_fit_row(identification) for identification in identifications),
    )


def _estimate_text(estimate: "Estimate") -> str:
    if estimate.at_bound:
        return f"{estimate.name} {rounded(estimate.value)} (at its bound)"
    return f"{estimate.name} {with_deviation(estimate.value, estimate.std)}"


def _fit_row(fit: "Identification") -> tuple[str, ...]:
    return (
        fit.structure.name,
        ", ".join(f"{output} {plain(value, 1)}" for output, value in fit.fit_percent.items()),
        ", ".join(plain(value, 1) for value in fit.fit_ceiling.values()),
        f"{fit.reached}/{fit.settings.starts}",
        "" if fit.margins is None else plain(fit.margins.gain_margin, 2),
        ", ".join(_estimate_text(estimate) for estimate in fit.parameters),
    )
