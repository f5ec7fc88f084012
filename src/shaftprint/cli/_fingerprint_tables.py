"""A fingerprint on the terminal: verdict, conditions, tables, findings."""

from collections.abc import Mapping

from shaftprint.cli._terminal import echo, on_terminal, print_findings
from shaftprint.cli.output import print_tables
from shaftprint.fingerprint import Fingerprint
from shaftprint.tables import (
    NO_TRUTH,
    budget_table,
    combination_table,
    fit_table,
    margin_table,
    parameter_table,
    physical_table,
    quantity_table,
    with_deviation,
)


def print_fingerprint(fingerprint: Fingerprint, *, truth: Mapping[str, float] = NO_TRUTH) -> None:
    """Print verdict, conditions, parameters, physical values, margins, budget, quality and findings.

    Parameters
    ----------
    fingerprint
        What to print.
    truth
        True values by the names of parameters, combinations and physical values, where they are known.
    """
    verdict = fingerprint.verdict
    print_findings(f"Verdict: {'trustworthy' if verdict.trustworthy else 'not trustworthy'}", verdict.sentences)
    _print_conditions(fingerprint)
    print_tables(
        [
            parameter_table(fingerprint, truth),
            combination_table(fingerprint, truth),
            margin_table(fingerprint, truth),
            quantity_table("Values of the sensors, from the recording", fingerprint.calibration, truth),
            physical_table(fingerprint, truth),
            budget_table(fingerprint.budget),
            fit_table(fingerprint),
        ]
    )
    print_findings("Findings", (*fingerprint.findings, *fingerprint.quality.remarks))


def _print_conditions(fingerprint: Fingerprint) -> None:
    conditions = fingerprint.conditions
    echo(f"{conditions.vessel}; {conditions.campaign}; structure {fingerprint.structure}")
    for quantity in (conditions.engine_speed, conditions.shaft_torque):
        value = on_terminal(with_deviation(quantity.value, quantity.std))
        echo(f"  {quantity.meaning}: {quantity.name} = {value} {quantity.unit}")
    echo(f"  speed sensor {conditions.speed_channel}; signals prepared in {conditions.mode} mode")
    echo(f"  lines used: {', '.join(conditions.lines_used)}")
    if conditions.lines_left_out:
        echo(f"  lines left out: {', '.join(conditions.lines_left_out)}")
    for source in fingerprint.sources:
        echo(f"  {source.role} {source.name}: SHA-256 {source.sha256[:16]}...")
    echo(f"  made {fingerprint.created:%Y-%m-%d %H:%M %Z} with shaftprint {fingerprint.shaftprint_version}")
    priors = {name: (prior.mean, prior.std) for name, prior in fingerprint.priors.items()}
    print_assumed(priors, fingerprint.held)


def print_assumed(priors: Mapping[str, tuple[float, float]], held: Mapping[str, float]) -> None:
    """Print the priors, mean and standard deviation by parameter, and the parameters that are held."""
    assumed = [f"{name} = {on_terminal(with_deviation(mean, std))}" for name, (mean, std) in priors.items()]
    fixed = [f"{name} = {value:g}" for name, value in held.items()]
    echo(f"  priors: {', '.join(assumed) or 'none'}; held: {', '.join(fixed) or 'none'}\n")
