"""What a test would find, as tables and sentences on the terminal."""

import math
from collections.abc import Mapping

from shaftprint.campaign import Campaign
from shaftprint.cli._fingerprint_tables import print_findings
from shaftprint.cli._numbers import plain, with_uncertainty
from shaftprint.cli._tables import print_table
from shaftprint.cli._terminal import echo
from shaftprint.identify.fit import Estimate
from shaftprint.identify.prediction import Accuracy, Identifiability
from shaftprint.identify.uncertainty import Interval
from shaftprint.spectra import FrequencyResponse


def print_prediction(
    campaign: Campaign,
    response: FrequencyResponse,
    noise: str,
    possible: Identifiability,
    accuracy: Accuracy,
    intervals: Mapping[str, Interval],
) -> None:
    """Print what a test would find.

    Parameters
    ----------
    campaign, response, noise
        The test, its lines, and where its noise comes from.
    possible
        What the equations allow.
    accuracy, intervals
        What the lines would tell.
    """
    structure = possible.structure
    echo(f"{campaign.name}; {structure.name}: {structure.title}")
    _print_conditions(response, noise, accuracy)
    print_findings("What these outputs can tell at all", possible.sentences)
    columns = ("quantity", "unit", "value +/- 1 std", "std [%]", "95 % interval", "meaning")
    meanings = {p.name: p.meaning for p in accuracy.objective.parameters}
    meanings |= {c.name: c.meaning for c in (*possible.combinations, *accuracy.objective.combinations)}
    rows = [
        (
            estimate.name,
            estimate.unit,
            with_uncertainty(estimate.value, estimate.std),
            _percent(estimate),
            _interval(intervals.get(estimate.name)),
            meanings[estimate.name],
        )
        for estimate in (*accuracy.parameters, *accuracy.combinations)
    ]
    print_table("What these lines would tell", columns, rows, numbers=(2, 3, 4), spare=True)
    print_findings("In words", accuracy.sentences)


def _print_conditions(response: FrequencyResponse, noise: str, accuracy: Accuracy) -> None:
    used = [name for name, is_used in zip(response.lines, response.used, strict=True) if is_used]
    echo(f"  {noise}")
    echo(f"  lines used: {', '.join(used)}")
    for name, remark in response.remarks.items():
        echo(f"  {name} not used: {remark}")
    known = [f"{name} = {plain(prior.mean)} +/- {plain(prior.std)}" for name, prior in accuracy.priors.items()]
    held = [f"{p.name} = {plain(p.value)}" for p in accuracy.objective.parameters if p.held]
    echo(f"  known beforehand: {', '.join(known) or 'nothing'}; held: {', '.join(held) or 'nothing'}\n")


def _percent(estimate: Estimate) -> str:
    if not math.isfinite(estimate.std) or estimate.value == 0.0:
        return ""
    percent = 100.0 * estimate.std / abs(estimate.value)
    return f"{percent:.0f}" if percent >= 100.0 else f"{percent:.2g}"


def _interval(interval: Interval | None) -> str:
    """Return a profile interval; an end that only a bound of the search sets is marked."""
    if interval is None:
        return ""
    ends = ((interval.lower, interval.lower_open), (interval.upper, interval.upper_open))
    return " to ".join(f"{'bound ' if is_open else ''}{end:.4g}" for end, is_open in ends)
