"""Fitted structures side by side, as a table on the terminal."""

from collections.abc import Sequence

from shaftprint.cli._numbers import with_uncertainty
from shaftprint.cli._tables import print_table
from shaftprint.identify import Identification


def print_fits(title: str, identifications: Sequence[Identification]) -> None:
    """Print FitPercent, starts, stability and parameters of each fit."""
    rows = [_row(identification) for identification in identifications]
    columns = ("structure", "FitPercent", "perfect model", "starts", "gain margin", "parameters +/- 1 std")
    print_table(title, columns, rows, numbers=(3, 4))


def _row(found: Identification) -> tuple[str, ...]:
    percent = ", ".join(f"{output} {value:.1f}" for output, value in found.fit_percent.items())
    ceiling = ", ".join(f"{value:.1f}" for value in found.fit_ceiling.values())
    margin = "" if found.margins is None else f"{found.margins.gain_margin:.2f}"
    parameters = ", ".join(
        f"{estimate.name} {with_uncertainty(estimate.value, estimate.std)}" for estimate in found.parameters
    )
    return found.structure.name, percent, ceiling, f"{found.reached}/{found.settings.starts}", margin, parameters
