"""The predicted accuracy of a test on the terminal."""

import math
from collections.abc import Mapping

from shaftprint.campaign import Campaign
from shaftprint.cli._fingerprint_tables import print_assumed
from shaftprint.cli._terminal import echo, print_findings
from shaftprint.cli.output import print_table
from shaftprint.identify.fit import Estimate
from shaftprint.identify.prediction import Accuracy, Identifiability
from shaftprint.identify.uncertainty import Interval
from shaftprint.spectra import FrequencyResponse
from shaftprint.tables import MEANING, Symbol, Table, interval, numbers, texts, unit_text, with_deviation


def print_prediction(
    campaign: Campaign,
    response: FrequencyResponse,
    noise: str,
    possible: Identifiability,
    accuracy: Accuracy,
    intervals: Mapping[str, Interval],
) -> None:
    """Print how accurate a planned test would be.

    Parameters
    ----------
    campaign, response, noise
        The test, its lines, and where its noise comes from.
    possible
        What the equations allow.
    accuracy, intervals
        The predicted accuracy with the lines.
    """
    structure = possible.structure
    echo(f"{campaign.name}; {structure.name}: {structure.title}")
    _print_conditions(response, noise, accuracy)
    print_findings("What these outputs can tell at all", possible.sentences)
    print_table(_accuracy_table(possible, accuracy, intervals))
    print_findings("In words", accuracy.sentences)


def _print_conditions(response: FrequencyResponse, noise: str, accuracy: Accuracy) -> None:
    used = [name for name, is_used in zip(response.lines, response.used, strict=True) if is_used]
    echo(f"  {noise}")
    echo(f"  lines used: {', '.join(used)}")
    for name, remark in response.remarks.items():
        echo(f"  {name} not used: {remark}")
    priors = {name: (prior.mean, prior.std) for name, prior in accuracy.priors.items()}
    print_assumed(priors, {p.name: p.value for p in accuracy.objective.parameters if p.held})


def _accuracy_table(possible: Identifiability, accuracy: Accuracy, intervals: Mapping[str, Interval]) -> Table:
    meanings = {p.name: p.meaning for p in accuracy.objective.parameters}
    meanings |= {c.name: c.meaning for c in (*possible.combinations, *accuracy.objective.combinations)}
    rows = tuple(
        (
            Symbol(estimate.name),
            with_deviation(estimate.value, estimate.std),
            _percent(estimate),
            _interval_text(intervals.get(estimate.name), estimate.std),
            unit_text(estimate.unit),
            meanings[estimate.name],
        )
        for estimate in (*accuracy.parameters, *accuracy.combinations)
    )
    return Table(
        title="Predicted accuracy with these lines",
        columns=(
            *texts("quantity"),
            *numbers("value ± std", "std [%]", "95 % interval"),
            *texts("unit"),
            MEANING,
        ),
        rows=rows,
        note="An end of an interval with an asterisk is a bound of the search and not a result.",
    )


def _percent(estimate: Estimate) -> str:
    if not math.isfinite(estimate.std) or estimate.value == 0.0:
        return ""
    percent = 100.0 * estimate.std / abs(estimate.value)
    return f"{percent:.0f}" if percent >= 100.0 else f"{percent:.2g}"


def _interval_text(ends: Interval | None, std: float) -> str:
    """Return a profile interval; an end that only a bound of the search sets is marked."""
    if ends is None:
        return ""
    lower, _, upper = interval(ends.lower, ends.upper, std).partition(" to ")
    return f"{lower}{'*' * ends.lower_open} to {upper}{'*' * ends.upper_open}"
