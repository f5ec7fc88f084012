"""A comparison of structures on the terminal: why one wins, and the numbers behind it."""

from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.identify.comparison import Candidate, LikelihoodRatio, StructureComparison


def print_comparison(comparison: StructureComparison) -> None:
    """Print why a structure wins, and the criteria and tests of all."""
    echo(f"Which structure: {comparison.best.name}")
    for sentence in comparison.sentences:
        echo(f"  * {sentence}")
    echo()
    columns = ("structure", "parameters", "chi-square", "freedom", "p-value", "AIC", "AICc", "BIC", "belief", "FPE")
    told = any(candidate.hold_out is not None for candidate in comparison.candidates)
    rows = [_row(candidate, comparison.weights[candidate.name], told) for candidate in comparison.candidates]
    data = comparison.best.criteria.data
    print_table(
        f"Structures fitted to the same {data} data, two a complex value; the lower AIC, AICc, BIC and FPE the better",
        columns + ("left out", "expected") * told,
        rows,
        numbers=range(1, 12),
    )
    if comparison.ratios:
        print_table(
            "Structures within larger ones",
            ("smaller", "larger", "parameters more", "deviance lower by", "p-value", "from"),
            [_ratio_row(ratio) for ratio in comparison.ratios],
            numbers=(2, 3, 4),
        )


def _row(candidate: Candidate, weight: float, told: bool) -> tuple[str, ...]:
    fit, criteria = candidate.identification, candidate.criteria
    p_value = "" if fit.p_value is None else _probability(fit.p_value)
    cells = (
        candidate.name,
        f"{criteria.parameters:.1f}",
        f"{fit.chi_square:.1f}" if fit.is_likelihood else "",
        str(fit.degrees_of_freedom),
        p_value,
        *(f"{value:.1f}" for value in (criteria.aic, criteria.aicc, criteria.bic)),
        f"{100.0 * weight:.1f} %",
        f"{criteria.fpe:.3g}",
    )
    if not told:
        return cells
    if candidate.hold_out is None:
        return (*cells, "", "")
    return (*cells, f"{candidate.hold_out.square:.3g}", f"{candidate.hold_out.expected:.3g}")


def _ratio_row(ratio: LikelihoodRatio) -> tuple[str, ...]:
    source = f"{ratio.draws} draws" if ratio.draws else "an upper bound" if ratio.reason else "chi-square"
    return (
        ratio.small,
        ratio.large,
        str(ratio.extra),
        f"{ratio.statistic:.2f}",
        _probability(ratio.p_value),
        source,
    )


def _probability(p_value: float) -> str:
    return f"{p_value:.2g}"
