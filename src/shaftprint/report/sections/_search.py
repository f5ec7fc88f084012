"""The sections of a report on the search: its optima, and which structure the data want."""

from typing import TYPE_CHECKING

from shaftprint.identify.fit import scan
from shaftprint.identify.judgement import report_search
from shaftprint.models import Delay
from shaftprint.report.figures import plot_scan
from shaftprint.report.sections._sections import Inputs, Picture, Section
from shaftprint.tables import Column, Symbol, Table, numbers, rounded, structure_tables, texts, unit_text

if TYPE_CHECKING:
    from shaftprint.identify import Identification
    from shaftprint.identify.fit import Optimum

MOST_OPTIMA = 8


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
    columns = (*texts("optimum"), *numbers("starts", "cost", "deviance above the result"), *texts("stable"))
    columns += tuple(Column(Symbol(f"{p.name} [{unit_text(p.unit) or '-'}]"), number=True) for p in parameters)
    rows = tuple(
        (
            "the result" if number == 0 else str(number + 1),
            str(optimum.starts),
            rounded(optimum.cost),
            "–" if number == 0 else rounded(optimum.distance),
            "yes" if optimum.stable else "no",
            *(rounded(float(optimum.values[index])) for index in fit.objective.free),
        )
        for number, optimum in enumerate(optima[:MOST_OPTIMA])
    )
    not_shown = len(optima) - len(rows)
    return Table(
        title="Optima of the search",
        columns=columns,
        rows=rows,
        note=(
            "The deviance is twice the fall of the log-likelihood; an optimum less than 3.84 above the result fits as "
            f"well within the noise.{f' {not_shown} more of higher cost are not shown.' if not_shown else ''}"
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
            tables=[table for comparison in inputs.comparisons for table in structure_tables(comparison)],
        )
    ]
