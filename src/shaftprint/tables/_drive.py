"""Tables of a drive that is no ship's: records, what was known or held, differences, validation, structures."""

import math
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import p_value_text, rounded, stated, unit_text, with_deviation
from shaftprint.plain_table import MEANING, Symbol, Table, numbers, texts
from shaftprint.units import PERCENT

if TYPE_CHECKING:
    from shaftprint.bench._structures import TimeComparison
    from shaftprint.bench._validate import ValidatedRecord
    from shaftprint.drive._signals import Signal
    from shaftprint.fingerprint._drive_fingerprint import DriveFingerprint
    from shaftprint.models._parameter import Parameter


NOTE = (
    "FitPercent is 100 % where nothing is left; its ceiling is what a perfect model would have beside this noise. The "
    "offset is what the model needs beside the sensor on average."
)


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
            with_deviation(record.offset[output], record.offset_std[output]) if output in record.offset else "-",
            unit_text(fingerprint.outputs[output]),
        )
        for record in fingerprint.records
        for output, percent in record.fit_percent.items()
    ]
    columns = (
        *texts("record", "output"),
        *numbers("length [s]", "rate [Hz]", "FitPercent", "ceiling", "noise", "offset ± std"),
        *texts("unit"),
    )
    return Table(title=_together("Records", fingerprint), columns=columns, rows=tuple(rows), note=_note(fingerprint))


def drive_response_table(fingerprint: "DriveFingerprint") -> Table:
    """Return how well each frequency response is explained."""
    rows = [
        (
            one.name,
            Symbol(output),
            str(one.lines),
            f"{one.lowest_hz:.4g} to {one.highest_hz:.4g}",
            f"{percent:.2f}",
            f"{one.fit_ceiling[output]:.2f}",
        )
        for one in fingerprint.responses
        for output, percent in one.fit_percent.items()
    ]
    columns = (*texts("response", "output"), *numbers("lines", "band [Hz]", "FitPercent", "ceiling"))
    title = _together("Frequency responses", fingerprint)
    return Table(title=title, columns=columns, rows=tuple(rows), note=_note(fingerprint))


def _together(what: str, fingerprint: "DriveFingerprint") -> str:
    p_value = "-" if fingerprint.p_value is None else p_value_text(fingerprint.p_value)
    return f"{what}; together p = {p_value}"


def _note(fingerprint: "DriveFingerprint") -> str:
    return f"{NOTE} {fingerprint.starts_at_optimum} of {fingerprint.starts} starts of the search ended at this result."


def drive_assumed_table(fingerprint: "DriveFingerprint") -> Table:
    """Return what was known of parameters before the test, and what was held."""
    units = {quantity.name: quantity.unit for quantity in fingerprint.parameters}
    rows = [
        (Symbol(name), "known before", stated(prior.mean, prior.std, units.get(name, "-")))
        for name, prior in fingerprint.priors.items()
    ]
    rows += [(Symbol(name), "held", f"{value:g}") for name, value in fingerprint.held.items()]
    return Table(title="What was taken as known", columns=texts("parameter", "how", "value"), rows=tuple(rows))


def validated_drive_table(records: "Sequence[ValidatedRecord]") -> Table:
    """Return how well a drive's model explains records that it was not identified from."""
    rows = [
        (
            record.fit.record.name,
            Symbol(name),
            f"{record.fit.fit_percent[name]:.2f}",
            f"{record.fit.fit_ceiling[name]:.2f}",
            f"{PERCENT * missed:.2f}",
            record.outcome,
        )
        for record in records
        for name, missed in record.missed.items()
    ]
    columns = (*texts("record", "output"), *numbers("FitPercent", "ceiling", "missed [%]"), *texts("outcome"))
    note = (
        "Missed is what other values or a more flexible model would explain, unless by chance, over the motion, root "
        "mean square; up to 5 % passes."
    )
    return Table(title="Records beside the model", columns=columns, rows=tuple(rows), note=note)


def drive_prediction_table(
    free: "Sequence[Parameter]", values: Mapping[str, float], deviations: Mapping[str, float]
) -> Table:
    """Return the standard deviation that planned records would give of each free parameter."""
    rows = []
    for parameter in free:
        value, std = values[parameter.name], deviations[parameter.name]
        share = f"{PERCENT * std / abs(value):.2g}" if value != 0.0 and math.isfinite(std) else "-"
        rows.append(
            (Symbol(parameter.name), with_deviation(value, std), share, unit_text(parameter.unit), parameter.meaning)
        )
    columns = (*texts("parameter"), *numbers("value ± std", "std [%]"), *texts("unit"), MEANING)
    return Table(title="What the records would tell", columns=columns, rows=tuple(rows))


def planned_signal_table(signals: "Sequence[Signal]", reached: Mapping[str, tuple[float, float]]) -> Table:
    """Return what planned inputs and the outputs that they lead to reach, beside their limits."""
    rows = []
    for signal in signals:
        limits = ("-" if limit is None else rounded(limit) for limit in (signal.lowest, signal.highest))
        rows.append((Symbol(signal.name), *map(rounded, reached[signal.name]), *limits, unit_text(signal.unit)))
    columns = (*texts("signal"), *numbers("lowest", "highest", "lowest limit", "highest limit"), *texts("unit"))
    return Table(title="What the record reaches", columns=columns, rows=tuple(rows))


def time_comparison_table(comparison: "TimeComparison") -> Table:
    """Return the structures that were fitted to records, the best first."""
    best = comparison.candidates[0].bic
    rows = [
        (
            one.name,
            str(len(one.fit.parameters)),
            f"{2.0 * one.fit.cost:.1f}",
            f"{one.bic - best:.1f}",
            "-" if one.own.p_value is None else p_value_text(one.own.p_value),
        )
        for one in comparison.candidates
    ]
    columns = (*texts("structure"), *numbers("parameters", "deviance", "BIC above the best", "p of its own fit"))
    return Table(title="Structures on the noise of the best", columns=columns, rows=tuple(rows))
