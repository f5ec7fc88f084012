"""Tables of a drive that is no ship's: records, and what was known or held."""

from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, rounded, stated, unit_text
from shaftprint.tables._table import Symbol, Table, numbers, texts

if TYPE_CHECKING:
    from shaftprint.fingerprint import DriveFingerprint

NOTE = "FitPercent is 100 % where nothing is left; its ceiling is what a perfect model would have beside this noise."


def drive_record_table(fingerprint: "DriveFingerprint") -> Table:
    """Return how well each output of each record is explained."""
    rows = [
        (
            record.name,
            Symbol(output),
            f"{record.seconds:.1f}",
            f"{record.rate_hz:g}",
            f"{percent:.2f}",
            f"{record.fit_ceiling[output]:.2f}",
            rounded(record.noise_std[output], 2),
            unit_text(fingerprint.outputs[output]),
        )
        for record in fingerprint.records
        for output, percent in record.fit_percent.items()
    ]
    columns = (
        *texts("record", "output"),
        *numbers("length [s]", "rate [Hz]", "FitPercent", "ceiling", "noise"),
        *texts("unit"),
    )
    title = f"Records; together p = {'-' if fingerprint.p_value is None else p_value_text(fingerprint.p_value)}"
    return Table(title=title, columns=columns, rows=tuple(rows), note=NOTE)


def drive_assumed_table(fingerprint: "DriveFingerprint") -> Table:
    """Return what was known of parameters before the test, and what was held."""
    units = {quantity.name: quantity.unit for quantity in fingerprint.parameters}
    rows = [
        (Symbol(name), "known before", stated(prior.mean, prior.std, units.get(name, "-")))
        for name, prior in fingerprint.priors.items()
    ]
    rows += [(Symbol(name), "held", f"{value:g}") for name, value in fingerprint.held.items()]
    return Table(title="What was taken as known", columns=texts("parameter", "how", "value"), rows=tuple(rows))
