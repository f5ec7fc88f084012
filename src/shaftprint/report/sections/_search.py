"""The sections of a report on the search: its optima, and which structure the data want."""

import math
from typing import TYPE_CHECKING

from shaftprint.digits import rounded, to_digit_of, unit_text
from shaftprint.identify.fit._scan import scan
from shaftprint.identify.judgement._search_report import report_search
from shaftprint.models._delays import Delay
from shaftprint.plain_table import Symbol, Table, numbers, texts
from shaftprint.report.figures._scan import scan_chart
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables._structures import structure_tables

if TYPE_CHECKING:
    from shaftprint.identify.fit._identification import Identification
    from shaftprint.identify.fit._optima import Optimum

MOST_OPTIMA = 6
# At each value beside the optima of the fit: with twice as many the curve takes half as long again, and is the same.
SCAN_STARTS = 4


def search_section(inputs: Inputs) -> Section:
    """Return the optima that the starts of the search reached, and the cost along the delay of the loop."""
    fit = inputs.identification
    search = report_search(fit)
    return Section(
        key="search",
        title="Search",
        points=search.sentences,
        tables=(_optima(fit, search.optima),),
        pictures=[
            Picture(
                name=f"scan_{name}",
                caption=(
                    f"Distance of the best fit at each value of {name} from the best of all: at each value all other "
                    "parameters are searched anew. Below the dotted line the data cannot tell a value from the best."
                ),
                alt=f"Curve of the distance over {name} with its optima marked.",
                chart=lambda name=name: scan_chart(scan(fit, name, starts=SCAN_STARTS), fit),  # type: ignore[misc]
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
    """Return the optima side by side, a column each: there are more parameters than optima."""
    shown, stds = optima[:MOST_OPTIMA], {estimate.name: estimate.std for estimate in fit.parameters}
    rows = [
        ("starts", *(str(optimum.starts) for optimum in shown)),
        ("cost", *(rounded(optimum.cost) for optimum in shown)),
        ("deviance above the result", "–", *(rounded(optimum.distance) for optimum in shown[1:])),
        ("stable", *("yes" if optimum.stable else "no" for optimum in shown)),
    ]
    for parameter, index in zip(fit.objective.free_parameters, fit.objective.free, strict=True):
        name = Symbol(f"{parameter.name} [{unit_text(parameter.unit) or '-'}]")
        std = stds.get(parameter.name, 0.0)
        rows.append((name, *(_of_optimum(float(optimum.values[index]), std) for optimum in shown)))
    not_shown = len(optima) - len(shown)
    return Table(
        title="Optima of the search",
        columns=(*texts("optimum"), *numbers("the result", *(str(number) for number in range(2, len(shown) + 1)))),
        rows=tuple(rows),
        note=(
            "The deviance is twice the fall of the log-likelihood; an optimum less than 3.84 above the result fits as "
            f"well within the noise.{f' {not_shown} more of higher cost are not shown.' if not_shown else ''}"
        ),
    )


def _of_optimum(value: float, std: float) -> str:
    """Return a value down to the digit that the result is known to, where its deviation says so."""
    return to_digit_of(value, std) if 0.0 < std < math.inf else rounded(value)


def comparison_section(inputs: Inputs) -> list[Section]:
    """Return which structure the data want; nothing where no two of the same channels were fitted."""
    if not inputs.comparisons:
        return []
    return [
        Section(
            key="which-structure",
            title="Which structure",
            points=[sentence for comparison in inputs.comparisons for sentence in comparison.sentences],
            tables=[table for comparison in inputs.comparisons for table in structure_tables(comparison)],
        )
    ]
