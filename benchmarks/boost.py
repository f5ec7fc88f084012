"""Monte Carlo of turbochargers: smoke limits of drawn boost and lag, found in a quarter of an hour.

The ships are those of ``benchmarks.limits`` that have a smoke limit: torque without boost 0.35 to 0.65 of the full-load
torque, lag 0.5 to 2 s, governor, delays, actuation and inertia drawn. Each is identified with the vessel file as it is.

``python -m benchmarks.boost --seeds 50 --write`` sails, finds and puts the table into docs/nonlinear.md.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command, rows_of, spent
from benchmarks.limits import CAMPAIGN, KINDS, VESSEL, drawn
from shaftprint.distributions import NORMAL_95
from shaftprint.limits import Kind, identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import sail

PAGE = Path(__file__).parents[1] / "docs" / "nonlinear.md"


def outcome(seed: int) -> dict[str, Any]:
    """Sail one ship with a smoke limit, and hold what is found of it against the truth."""
    number = len(KINDS) * seed + KINDS.index("smoke")
    ship = drawn(number)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "boost.nc"
        truth = sail(ship.vessel, CAMPAIGN, path, tug=ship.tug, seed=number)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, VESSEL, CAMPAIGN)
    begin = time.process_time()
    found = identify_limits(signals, CAMPAIGN, VESSEL)
    true: dict[str, Any] = {**truth.normalised, **ship.levels, "share": 1.0, "T_aw": ship.tug.anti_windup_s}
    numbers = {one.name: {"value": one.value, "std": one.std, "interval": one.interval_95} for one in found.numbers}
    for one in found.governor:
        if not np.isfinite(one.std):
            continue
        half = NORMAL_95 * one.std
        numbers[one.name] = {"value": one.value, "std": one.std, "interval": (one.value - half, one.value + half)}
    return {
        "seed": seed,
        "acts_s": ship.acts_s,
        "kinds": [kind.name.lower() for kind in found.kinds],
        "gain": float(found.gains.get(Kind.SMOKE, np.nan)),
        "untrusted": [one.name for one in found.numbers if not one.trusted],
        "numbers": {name: {"true": true[name], **number} for name, number in numbers.items() if name in true},
        "governor": all(np.isfinite(one.std) for one in found.governor),
        "cpu_s": time.process_time() - begin,
    }


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return what was named, and a row for each number, in Markdown."""
    named = [one for one in outcomes if "smoke" in one["kinds"]]
    others = sum(bool(set(one["kinds"]) - {"smoke"}) for one in outcomes)
    least = min(one["gain"] for one in named)
    lag = sum("tau_tc" not in one["untrusted"] for one in named)
    refused = sum(not one["governor"] for one in outcomes)
    return "\n".join(
        [
            "",
            f"{len(outcomes)} recordings of a quarter of an hour, {spent(outcomes)}; the smoke limit was named in "
            f"{len(named)}, another one beside or in place of it in {others}. Without it twice the log-likelihood is "
            f"at least {least:.0f} lower. The lag of the boost was known well enough to be trusted in {lag}; in "
            f"{refused} no number was, for the speed had left the line of the set point. Of what is trusted:",
            "",
            *rows_of([_trusted(one) for one in outcomes]),
        ]
    )


def _trusted(one: Mapping[str, Any]) -> dict[str, Any]:
    kept = {name: number for name, number in one["numbers"].items() if name not in one["untrusted"]}
    return {**one, "numbers": kept}


if __name__ == "__main__":
    command(__doc__, "boost", outcome, table, page=PAGE)
