"""Sines, steps and limits in one fit: does the truth lie in its intervals? 14 minutes, drawn ships.

``python -m benchmarks.one_fit --seeds 100 --outcomes build/one_fit --write`` sails what is not there yet, fits it, and
writes the table of ``docs/nonlinear.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import command
from benchmarks.limits import VESSEL, line_of
from shaftprint.arrays import FloatArray
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Estimate
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.survey._everything import with_everything
from shaftprint.tug import Truth, Tug, sail

CAMPAIGN = load_campaign("short")
SEED = 2026
SHARE, MOTORING_NM = (0.85, 1.0), (200.0, 350.0)
JUDGED = ("K_p", "K_i", "t_d", "t_sp", "omega_n", "zeta", "tau_dn", "k_q", "m_max", "m_min", "T_aw")
PAGE = Path(__file__).parents[1] / "docs" / "nonlinear.md"


def ship(seed: int) -> tuple[Tug, float]:
    """Return a line with torque limits, and its full-load torque over that of the vessel file."""
    rng = np.random.default_rng([SEED, seed])
    return replace(line_of(rng), motoring_torque_nm=float(rng.uniform(*MOTORING_NM))), float(rng.uniform(*SHARE))


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    tug, share = ship(seed)
    torques = tuple(share * torque for torque in VESSEL.engine.full_load_torque_nm)
    sailed = VESSEL.model_copy(update={"engine": VESSEL.engine.model_copy(update={"full_load_torque_nm": torques})})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(sailed, CAMPAIGN, path, tug=tug, seed=seed)
        survey = run(path, VESSEL, CAMPAIGN, judge=False, rng=np.random.default_rng(1))
        begin = time.process_time()
        try:
            survey = with_everything(survey, rng=np.random.default_rng(2))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    line = survey.fingerprint.with_limits
    if line is None:
        return {"seed": seed, "refused": "no limits"}
    true = _true(truth, tug, share, survey.signals)
    found = {quantity.name: quantity for quantity in line.parameters}
    sines = {quantity.name: quantity.std for quantity in survey.fingerprint.parameters}
    return {
        "seed": seed,
        "found_by": line.found_by,
        "cpu_s": time.process_time() - begin,
        "limits": list(line.limits),
        "z": {n: (found[n].value - true[n]) / found[n].std for n in JUDGED if n in found},
        "covered": {n: _covers(found[n], true[n]) for n in JUDGED if n in found},
        "std": {n: found[n].std / abs(true[n]) for n in JUDGED if n in found},
        "gain": {n: sines[n] / found[n].std for n in JUDGED if n in sines},
    }


def _covers(found: Estimate, true: float) -> bool:
    """Return whether the stated 95 % interval holds the truth."""
    # an open end is no number, and excludes nothing
    low, high = found.limits_95
    return not (true < low or true > high)


def _true(truth: Truth, tug: Tug, share: float, signals: Signals) -> Mapping[str, float]:
    """Return the truth, normalised at the measured working point."""
    point, gear = signals.working_point, VESSEL.gearbox
    brake_nm = point.shaft_torque_nm / (gear.ratio * gear.efficiency)
    speed_rpm = 60.0 * point.engine_speed_rev_s
    full_nm = share * np.interp(speed_rpm, VESSEL.engine.full_load_speed_rpm, VESSEL.engine.full_load_torque_nm)
    levels = {
        "m_max": float(full_nm) / brake_nm,
        "m_min": -tug.motoring_torque_nm / brake_nm,
        "T_aw": tug.anti_windup_s,
    }
    return fingerprint_truth(truth, structure("GAUGE-CLOSED"), signals) | levels


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, in Markdown: of all fingerprints, and of those that a joint fit gave alone."""
    stated = [one for one in outcomes if "refused" not in one]
    joint = [one for one in stated if one["found_by"] == "joint fit"]
    lines = [
        f"{len(outcomes)} recordings: {len(joint)} joint fits used, {len(stated) - len(joint)} contradicted by their "
        f"sines, which were kept, {len(outcomes) - len(stated)} refused; CPU time of limits and joint fit "
        f"{np.median([one['cpu_s'] for one in stated]):.0f} s.",
        "",
        "| number | joint fits | stated deviation | sines alone, times as much | rms z | mean z | covered "
        "| all fingerprints | covered |",
        "|---|---|---|---|---|---|---|---|---|",
    ]
    for name in JUDGED:
        z = _of(name, "z", joint)
        if z.size == 0:
            continue
        gain = _of(name, "gain", joint)
        times = f"{np.median(gain):.1f}" if gain.size else ""
        lines.append(
            f"| `{name}` | {z.size} | {100.0 * np.median(_of(name, 'std', joint)):.2g} % | {times} "
            f"| {np.sqrt(np.mean(z**2)):.2f} | {np.mean(z):.2f} | {_share(name, joint):.0f} % "
            f"| {_of(name, 'covered', stated).size} | {_share(name, stated):.0f} % |"
        )
    lines.append(f"| all | | | | | | {_share('', joint):.1f} % | | {_share('', stated):.1f} % |")
    return "\n".join(lines)


def _of(name: str, what: str, outcomes: Sequence[Mapping[str, Any]]) -> FloatArray:
    """Return one thing of one number, or of all numbers without a name, over outcomes; only what is finite."""
    found = [value for one in outcomes for number, value in one[what].items() if name in ("", number)]
    return np.array([value for value in found if np.isfinite(value)], dtype=float)


def _share(name: str, outcomes: Sequence[Mapping[str, Any]]) -> float:
    """Return in how many intervals of a number, or of all numbers without a name, the truth lies [%]."""
    return 100.0 * float(np.mean(_of(name, "covered", outcomes)))


if __name__ == "__main__":
    command(__doc__, "one_fit", outcome, table, page=PAGE, seeds=100)
