"""A fingerprint on the terminal: verdict, conditions, tables, findings."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping, Sequence

from shaftprint.cli._found import found_sentences
from shaftprint.cli._terminal import details, is_detailed, print_findings, say
from shaftprint.cli.output._json import give
from shaftprint.cli.output._tables import print_tables
from shaftprint.digits import stated
from shaftprint.late import late

with late():
    from shaftprint.tables._fingerprint import (
        budget_table,
        combination_table,
        fit_table,
        margin_table,
        parameter_table,
        physical_table,
        quantity_table,
    )


with late():
    from shaftprint.fingerprint._fingerprint import Fingerprint
    from shaftprint.tables._conditions import ship_text, tested_text, water_facts


ASSUMED = "Assumed:"
"""How the sentences of a verdict begin that say what it rests on."""
LISTS = ("Trusted:", "Not trusted:")
"""How those begin that name the numbers that may be used and the others."""


def print_fingerprint(fingerprint: Fingerprint) -> None:
    """Print verdict, conditions, parameters, physical values, margins, budget, quality and findings."""
    _print_verdict(fingerprint, fingerprint.verdict.sentences)
    _print_rest(fingerprint, {})


def print_found(
    fingerprint: Fingerprint,
    *,
    truth: Mapping[str, float] | None = None,
    line: str | None = None,
    further: Sequence[str] = (),
) -> None:
    """Print verdict and what was found; with ``--verbose`` all that ``print_fingerprint`` does.

    ``fingerprint``: what to print. ``truth``: true values by the names of parameters, combinations and physical values,
    where they are known. ``line``: which line of a ship it is of, where there are several. ``further``: what else was
    found, in sentences.
    """
    verdict, truth = fingerprint.verdict, truth or {}
    sentences = verdict.sentences
    if not is_detailed():
        # names say little to who does not know them yet
        sentences = tuple(one for one in sentences if not one.startswith((ASSUMED, *LISTS)))
        if verdict.assumptions:
            # their count, and where they are told: they are the longest part of a verdict that is fine
            where = "`shaftprint show` and the report have them"
            sentences += (f"{ASSUMED} {_points(len(verdict.assumptions))} that no recording can show; {where}.",)
        if verdict.trusted:
            count = len(verdict.trusted)
            sentences += (
                f"{count} of {count + len(verdict.not_trusted)} numbers can be used: `shaftprint show` has them by "
                "name, the others with the reason.",
            )
    _print_verdict(fingerprint, sentences, line)
    if verdict.trustworthy:
        usable, unusable = found_sentences(fingerprint, truth)
        print_findings("What was found", [*usable, *further], is_answer=True)
        if unusable:
            print_findings("Found too, but not to be used", unusable, is_answer=True)
    with details():
        _print_rest(fingerprint, truth)


def _points(count: int) -> str:
    return "one point" if count == 1 else f"{count} points"


def _print_verdict(fingerprint: Fingerprint, sentences: Sequence[str], line: str | None = None) -> None:
    title = f"Verdict: {fingerprint.verdict.words}"
    print_findings(title if line is None else f"{line}. {title}", sentences, is_answer=True)
    give("fingerprint" if line is None else f"fingerprint of {line}", fingerprint)


def _print_rest(fingerprint: Fingerprint, truth: Mapping[str, float]) -> None:
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
    say(f"{conditions.vessel}; {conditions.campaign}; structure {fingerprint.structure}")
    facts = {"ship": ship_text(conditions.ship), "tested": tested_text(conditions.tested_at)}
    facts |= {"at": conditions.place or ""} | {title.lower(): text for title, text in water_facts(conditions)}
    if any(facts.values()):
        say("; ".join(f"{title} {text}" for title, text in facts.items() if text), indent="  ")
    for quantity in (conditions.engine_speed, conditions.shaft_torque):
        value = stated(quantity.value, quantity.std, quantity.unit)
        say(f"{quantity.meaning}: {quantity.name} = {value}", indent="  ")
    say(f"speed sensor {conditions.speed_channel}; signals prepared in {conditions.mode} mode", indent="  ")
    if conditions.lines_used:
        say(f"lines used: {_lines_in_words(conditions.lines_used)}", indent="  ")
    if conditions.lines_left_out:
        say(f"lines left out: {', '.join(conditions.lines_left_out)}", indent="  ")
    for source in fingerprint.sources:
        say(f"{source.role} {source.name}: SHA-256 {source.sha256[:16]}...", indent="  ")
    say(f"made {fingerprint.created:%Y-%m-%d %H:%M %Z} with shaftprint {fingerprint.shaftprint_version}", indent="  ")
    priors = {name: (prior.mean, prior.std) for name, prior in fingerprint.priors.items()}
    print_assumed(priors, fingerprint.held, {quantity.name: quantity.unit for quantity in fingerprint.parameters})


def _lines_in_words(lines: Sequence[str]) -> str:
    """Return the names of lines; of legs, which have many, how many each has."""
    legs = Counter(line.split("/")[0] for line in lines if "/" in line)
    single = [line for line in lines if "/" not in line]
    return ", ".join([*single, *(f"{count} of {leg}" for leg, count in legs.items())])


def print_assumed(
    priors: Mapping[str, tuple[float, float]], held: Mapping[str, float], units: Mapping[str, str]
) -> None:
    """Print the priors, mean and standard deviation by parameter, and the parameters that are held."""
    assumed = [f"{name} = {stated(mean, std, units.get(name, '-'))}" for name, (mean, std) in priors.items()]
    fixed = [f"{name} = {value:g}" for name, value in held.items()]
    say(f"priors: {', '.join(assumed) or 'none'}; held: {', '.join(fixed) or 'none'}\n", indent="  ")
