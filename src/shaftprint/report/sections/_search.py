"""The sections of a report on the search: its optima, and which structure the data want."""

from typing import TYPE_CHECKING

from markupsafe import Markup

from shaftprint.identify.fit import scan
from shaftprint.identify.judgement import report_search
from shaftprint.models import Delay
from shaftprint.report._numbers import plain, rounded
from shaftprint.report._symbols import unit_text
from shaftprint.report._table import Cell, Table, symbol_html
from shaftprint.report.figures import plot_scan
from shaftprint.report.sections._sections import Inputs, Picture, Section

if TYPE_CHECKING:
    from shaftprint.identify import Identification
    from shaftprint.identify.comparison import Candidate, LikelihoodRatio, StructureComparison
    from shaftprint.identify.fit import Optimum

MOST_OPTIMA = 8


def search_section(inputs: Inputs) -> Section:
    """Return the optima that the starts of the search reached, and the cost along the delay of the loop."""
    fit = inputs.identification
    found = report_search(fit)
    return Section(
        key="search",
        title="Search",
        points=found.sentences,
        tables=(_optima(fit, found.optima),),
        pictures=[
            Picture(
                name=f"scan_{name}",
                caption=(
                    f"Distance of the best fit at each value of {name} from the best of all: at each value all other "
                    "parameters are searched anew. Below the dotted line the data cannot tell a value from the best."
                ),
                alt=f"Curve of the distance over {name} with its optima marked.",
                draw=lambda name=name: plot_scan(scan(fit, name), fit),  # type: ignore[misc]
            )
            for name in _loop_delays(fit)
        ],
    )


def _loop_delays(fit: "Identification") -> list[str]:
    """Return the names of the free delays inside the loop, or of all where there is no loop: they have many optima."""
    structure = fit.structure
    nodes = structure.blocks if structure.loop is None else tuple(structure.loop.nodes())
    free = {parameter.name for parameter in structure.free}
    names = [node.time.name for node in nodes if isinstance(node, Delay) and node.time.name in free]
    return list(dict.fromkeys(names))


def _optima(fit: "Identification", optima: "tuple[Optimum, ...]") -> Table:
    parameters = fit.objective.free_parameters
    header: tuple[Cell, ...] = ("optimum", "starts", "cost", "deviance above the result", "stable")
    header += tuple(
        Markup("{} {}").format(symbol_html(p.name), Markup("[{}]").format(unit_text(p.unit) or "-")) for p in parameters
    )
    rows = tuple(
        (
            "the result" if number == 0 else str(number + 1),
            str(optimum.starts),
            rounded(optimum.cost),
            "–" if number == 0 else rounded(optimum.distance),
            "yes" if optimum.stable else "no",
            *(rounded(float(optimum.values[place])) for place in fit.objective.free),
        )
        for number, optimum in enumerate(optima[:MOST_OPTIMA])
    )
    left = len(optima) - len(rows)
    return Table(
        caption="Optima of the search",
        header=header,
        rows=rows,
        note=(
            "The deviance is twice the fall of the log-likelihood; an optimum less than 3.84 above the result fits as "
            f"well within the noise.{f' {left} more of higher cost are not shown.' if left else ''}"
        ),
    )


def comparison_section(inputs: Inputs) -> list[Section]:
    """Return which structure the data want; nothing where no two of the same channels were fitted."""
    if not inputs.comparisons:
        return []
    return [
        Section(
            key="which-structure",
            title="Which structure",
            points=[sentence for comparison in inputs.comparisons for sentence in comparison.sentences],
            tables=[table for comparison in inputs.comparisons for table in _comparison_tables(comparison)],
        )
    ]


def _comparison_tables(comparison: "StructureComparison") -> list[Table]:
    structure = comparison.best.identification.structure
    channels = f"{', '.join(structure.outputs)} from {', '.join(structure.inputs)}"
    tables = [
        Table(
            caption=f"Structures of {channels}, lowest BIC first",
            header=(
                *("structure", "parameters", "chi-square", "freedom", "p", "AIC", "AICc", "BIC", "belief", "FPE"),
                *("left-out lines", "expected"),
            ),
            rows=tuple(_row(candidate, comparison) for candidate in comparison.candidates),
            note=(
                f"Fitted to the same {comparison.best.criteria.data} data, two a complex value. The lower the criteria "
                "the better; the belief is the share that BIC gives a structure if one of them is right. The last two "
                "columns are the mean squared error of lines that were left out, in units of their noise variance."
            ),
        )
    ]
    if comparison.ratios:
        tables.append(
            Table(
                caption=f"Structures of {channels} within larger ones",
                header=("smaller", "larger", "parameters more", "deviance lower by", "p", "from"),
                rows=tuple(_ratio_row(ratio) for ratio in comparison.ratios),
                note="p is the probability of such a fall or a larger one if the smaller structure holds.",
            )
        )
    return tables


def _row(candidate: "Candidate", comparison: "StructureComparison") -> tuple[Cell, ...]:
    fit, criteria, told = candidate.identification, candidate.criteria, candidate.hold_out
    return (
        candidate.name,
        plain(criteria.parameters, 1),
        plain(fit.chi_square, 0) if fit.is_likelihood else "–",
        str(fit.degrees_of_freedom),
        "–" if fit.p_value is None else rounded(fit.p_value, 2),
        *(plain(value, 1) for value in (criteria.aic, criteria.aicc, criteria.bic)),
        f"{plain(100.0 * comparison.weights[candidate.name], 1)} %",
        rounded(criteria.fpe, 3),
        *(("–", "–") if told is None else (rounded(told.square, 3), rounded(told.expected, 3))),
    )


def _ratio_row(ratio: "LikelihoodRatio") -> tuple[Cell, ...]:
    source = f"{ratio.draws} drawn tests" if ratio.draws else "an upper bound" if ratio.reason else "chi-square"
    return (
        *(ratio.small, ratio.large, str(ratio.extra), plain(ratio.statistic, 1), rounded(ratio.p_value, 2)),
        source,
    )
