"""What the benchmarks of drawn lines share: truth as the test shows it, covered numbers as a table, the command."""

import argparse
import json
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.kept_outcomes import kept
from benchmarks.monte_carlo_recordings import Ship
from benchmarks.result_tables import write_between_marks
from shaftprint.distributions import NORMAL_95
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate
from shaftprint.models import Structure

REJECTED_P = 0.01
"""Chance below which the program calls a structure rejected."""
HEADER = (
    "| number | recordings | stated deviation | over the value | median error, deviations | covered |",
    "|---|---|---|---|---|---|",
)


def interval_of(one: Estimate) -> tuple[float, float]:
    """Return the interval that is printed for a number."""
    return one.interval_95 or (one.value - NORMAL_95 * one.std, one.value + NORMAL_95 * one.std)


def seen_by_gauge(
    named: Mapping[str, float],
    model: Structure,
    of: Ship,
    *,
    shown_nm: float,
    slopes: Sequence[str] = ("k_q",),
    **known: float,
) -> dict[str, float]:
    """Return the truth of a structure as the torque gauge of a ship shows it, with combinations and inertias.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.

    Parameters
    ----------
    named
        The truth by name, without errors of the gauge.
    shown_nm
        The shown mean in the direction in which the zero counts [N m].
    slopes
        Slopes of the load, which the zero changes.
    known
        Parameters that are known otherwise.
    """
    known = {"t_gauge": of.late_s, **known}
    seen = {p.name: known[p.name] if p.name in known else named[p.name] for p in model.parameters}
    for parameter in model.parameters:
        if parameter.role is not None and parameter.role.over_torque:
            seen[parameter.name] *= of.scale
    for slope in slopes:
        seen[slope] *= 1.0 - of.scale * of.zero_nm / shown_nm
    seen |= {one.name: float(one.of(seen)) for one in model.combinations}  # type: ignore[arg-type]
    return seen | {name: named[name] for name in ("I_dn", "I_up")}


def numbers_of(fingerprint: Fingerprint, true: Mapping[str, float]) -> dict[str, dict[str, Any]]:
    """Return truth, value, deviation and interval of each number whose truth is known."""
    numbers = [*fingerprint.parameters, *fingerprint.combinations, *fingerprint.physical]
    return {
        one.name: {"true": true[one.name], "value": one.value, "std": one.std, "interval": interval_of(one)}
        for one in numbers
        if one.name in true
    }


def covers(number: Mapping[str, Any]) -> bool:
    """Return whether the stated interval of a number holds the truth."""
    return bool(number["interval"][0] <= number["true"] <= number["interval"][1])


def names_in(fitted: Iterable[Mapping[str, Any]]) -> list[str]:
    """Return the names of all numbers, in the order in which they come."""
    return list(dict.fromkeys(name for one in fitted for name in one["numbers"]))


def rows_of(fitted: Sequence[Mapping[str, Any]], names: Iterable[str] | None = None) -> list[str]:
    """Return a table in Markdown: a row for each number, and one for all together."""
    rows, inside = [], []
    for name in names_in(fitted) if names is None else names:
        numbers = [one["numbers"][name] for one in fitted if name in one["numbers"]]
        covered = [covers(one) for one in numbers]
        inside += covered
        off = np.array([one["value"] - one["true"] for one in numbers])
        scale = np.array([abs(one["true"]) for one in numbers])
        stated = np.array([one["std"] for one in numbers], dtype=float)
        share = np.median(stated / scale) if scale.min() > 0.0 else np.inf
        # of a number about zero it says nothing
        per_cent = f"{100.0 * share:.2g} %" if share < 1.0 else ""
        rows.append(
            f"| `{name}` | {len(numbers)} | {np.nanmedian(stated):.2g} | {per_cent} | {np.median(off / stated):+.2f} | "
            f"{100.0 * np.mean(covered):.0f} % |"
        )
    return [*HEADER, *rows, f"| all | | | | | {100.0 * np.mean(inside):.1f} % |"]


def rejected_in(fitted: Sequence[Mapping[str, Any]], name: str) -> int:
    """Return in how many recordings a structure was rejected."""
    return sum(one["p"][name] < REJECTED_P for one in fitted)


def counted(outcomes: Sequence[Mapping[str, Any]], fitted: Sequence[Mapping[str, Any]], *, length: str) -> str:
    """Return how many recordings of a length were sailed, refused and trusted, in words."""
    trusted = sum(bool(one["trustworthy"]) for one in fitted)
    return f"{len(fitted)} recordings of {length}, {len(outcomes) - len(fitted)} refused, {trusted} trustworthy"


def spent(fitted: Sequence[Mapping[str, Any]]) -> str:
    """Return what a recording cost, in words."""
    return f"{np.median([one['cpu_s'] for one in fitted]):.1f} CPU s each"


def command(
    words: str | None,
    name: str,
    outcome: Callable[[int], Mapping[str, Any]],
    table: Callable[[Sequence[Mapping[str, Any]]], str],
    *,
    page: Path,
    seeds: int = 50,
) -> None:
    """Sail and fit what is not there, and print the table of what is.

    Parameters
    ----------
    words
        What the benchmark is.
    name
        Of the folder below ``build``, and between the marks of the page.
    outcome
        Sails and fits the ship of a seed.
    table
        Makes the table of all outcomes.
    page
        Where ``--write`` puts it.
    seeds
        Number of recordings where none is asked for.
    """
    parser = argparse.ArgumentParser(description=words)
    parser.add_argument("--seeds", type=int, default=seeds, help="number of recordings")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--outcomes", type=Path, default=Path("build", name), help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    found = []
    for seed in range(options.first, options.first + options.seeds):
        found.append(kept(options.outcomes / f"{seed:03d}.json", partial(outcome, seed)))
        print(json.dumps(found[-1]), flush=True)
    text = table(found)
    print(text)
    if options.write:
        mark = name.replace("_", " ")
        write_between_marks(page, text, f"<!-- {mark}: begin -->\n", f"<!-- {mark}: end -->\n")
