"""The tables of the Monte Carlo test, in Markdown."""

from collections.abc import Callable, Sequence

from benchmarks.monte_carlo_outcome import Number, Result

BEGIN = "<!-- tables of benchmarks/monte_carlo.py: begin -->"
END = "<!-- tables of benchmarks/monte_carlo.py: end -->"


def summary(title: str, results: Sequence[Result], *, bound: bool) -> str:
    """Return one row a case: its worst number in each respect.

    Parameters
    ----------
    bound
        Whether variances are compared with the Cramer-Rao bound of a known covariance.
    """
    header = ["structure", "tests", "coverage", "farthest off"]
    header += ["variance / bound", "largest", "the same, steady"] if bound else ["error / stated"]
    rows = [_summary_row(result, bound=bound) for result in results]
    return table(title, [*header, "KS p", "p < 0.05"], rows)


def _summary_row(result: Result, *, bound: bool) -> list[str]:
    numbers = result.numbers
    farthest = max(numbers, key=lambda number: abs(number.coverage - 0.95))
    row = [result.name, f"{result.tests}", _range(numbers, lambda n: 100.0 * n.coverage, "{:.1f}"), farthest.name]
    if bound:
        largest = max(numbers, key=lambda number: number.variance_ratio)
        row += [_range(numbers, lambda n: n.variance_ratio, "{:.2f}"), largest.name]
        row.append(_range(numbers, lambda n: n.steady_ratio, "{:.2f}"))
    else:
        row.append(_range(numbers, lambda n: n.error_ratio, "{:.2f}"))
    return [*row, f"{result.uniform:.2g}", f"{100.0 * result.rejected:.1f} %"]


def every_number(title: str, results: Sequence[Result]) -> str:
    """Return one row a number of every case, against the Cramer-Rao bound."""
    rows = [
        [
            result.name if place == 0 else "",
            number.name,
            f"{number.bias:+.2f}",
            f"{number.variance_ratio:.2f}",
            f"{number.steady_ratio:.2f}",
            f"{100.0 * number.coverage:.1f} %",
            f"{100.0 * number.steady_coverage:.1f} %",
        ]
        for result in results
        for place, number in enumerate(result.numbers)
    ]
    header = ["structure", "number", "mean error / bound", "variance / bound", "steady", "coverage", "steady coverage"]
    return table(title, header, rows)


def of_recordings(title: str, result: Result) -> str:
    """Return one row a number of the tests through raw recordings."""
    spread = 100.0 * (0.95 * 0.05 / result.tests) ** 0.5
    rows = [
        [
            number.name,
            f"{100.0 * number.coverage:.1f} ± {spread:.1f} %",
            f"{number.error_ratio:.2f}",
            f"{number.bias:+.2f}",
            f"{100.0 * number.is_open:.0f} %",
        ]
        for number in result.numbers
    ]
    header = ["number", "coverage", "error / stated, rms", "mean error / rms", "open intervals"]
    note = f"p-values: KS test {result.uniform:.2g}, {100.0 * result.rejected:.1f} % below 0.05."
    return table(title, header, rows) + f"\n{note}\n"


def _range(numbers: Sequence[Number], of: Callable[[Number], float], pattern: str) -> str:
    values = sorted(of(number) for number in numbers)
    first, last = pattern.format(values[0]), pattern.format(values[-1])
    return first if first == last else f"{first} to {last}"


def table(title: str, header: Sequence[str], rows: Sequence[Sequence[str]]) -> str:
    """Return a table with its title."""
    lines = [f"\n### {title}\n", "| " + " | ".join(header) + " |", "|" + "---|" * len(header)]
    lines += ["| " + " | ".join(row) + " |" for row in rows]
    return "\n".join(lines) + "\n"
