"""Monte Carlo of limits: recordings of a quarter of an hour with one limit or none, named and measured by the program.

Every ship is drawn: governor, delays, actuation, and what a vessel file states with a standard deviation. It has one
limit, of a level at which the limit acts for at least two seconds of the test; all others are far away.

The ships of ``unkind`` are 100 with one limit, half of them a smoke limit with the lag of a boost and an engine that
the working point loads by up to 65 %, and 50 with none. Their line of the set point bends by up to 0.3 % per volt, and
the ship disturbs itself by 0.5 to 2 times as much.

``python -m benchmarks.limits --folder DIR`` sails them, finds the limits and prints the table, a CPU minute each; what
has an outcome in the folder is not sailed again. ``--first`` and ``--count`` choose ships.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from tests.tug.ideal_signals import simulate_signals

from benchmarks.kept_outcomes import kept
from benchmarks.nonlinear_fit import with_wide_gauge
from benchmarks.validation import MOTORING_NM, STRONGER
from shaftprint.campaign import Campaign, load_campaign, setpoint
from shaftprint.limits import Kind, identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import Noise, Truth, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

VESSEL = with_wide_gauge(load_vessel("stan-tug-1205"))
CAMPAIGN = load_campaign("short")
SEED = 37
LEAST_S = 2.0
"""A limit that is drawn acts for so long [s] in the test without noise, ..."""
MOST_S = 300.0
"""... and no longer than this [s]: a line that is always limited has no small signals."""
RPM_PER_S = tuple(np.geomspace(8.0, 1500.0, 64).tolist())


@dataclass(frozen=True, kw_only=True, slots=True)
class Drawn:
    """One ship with one limit."""

    kind: str
    """Name of the limit."""
    levels: dict[str, float]
    """True numbers of the limit, by the names under which the program gives them."""
    acts_s: float
    """Time for which it acts without noise [s]; infinite where it always does."""
    tug: Tug
    """The line."""
    vessel: Vessel
    """What sails."""
    file: Vessel = VESSEL
    """What the vessel file says of it."""


KINDS = ("torque", "smoke", "rate", "ramp", "deadband", "held")
NONE = "none"
OTHERS = tuple(kind for kind in KINDS if kind != "smoke")
BEND_PER_V = 0.003
"""The slope of the set point's line changes by up to this share per volt."""
NOISIER = 2.0
"""The ship disturbs itself by up to so many times as much, or as little."""


def drawn(seed: int) -> Drawn:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    kind = KINDS[seed % len(KINDS)]
    tug = line_of(rng)
    while True:
        one = _LIMITED[kind](rng, tug)
        if LEAST_S <= one.acts_s <= MOST_S or np.isinf(one.acts_s):
            return one


def unkind(seed: int) -> Drawn:
    """Return a ship of which two of three have one limit, with a set-point line that bends and noise of its own."""
    rng = np.random.default_rng([SEED, 98, seed])
    limited = 2 * (seed // 3) + seed % 3
    kind = NONE if seed % 3 == 2 else "smoke" if limited % 2 == 0 else OTHERS[limited // 2 % len(OTHERS)]
    factor = float(np.exp(rng.uniform(-np.log(NOISIER), np.log(NOISIER))))
    louder = {name: factor * getattr(Noise(), name) for name in PROCESS}
    bend = float(rng.uniform(-BEND_PER_V, BEND_PER_V))
    tug = replace(line_of(rng), set_point_bend_per_v=bend, noise=Noise(**louder))
    if kind == NONE:
        return Drawn(kind=NONE, levels={}, acts_s=0.0, tug=tug, vessel=_with_torque(STRONGER))
    while True:
        one = _boosted(rng, tug) if kind == "smoke" else _LIMITED[kind](rng, tug)
        if LEAST_S <= one.acts_s <= MOST_S or np.isinf(one.acts_s):
            return one


PROCESS = ("inflow_rms", "surge_rms", "combustion_rms", "hunting_rms", "demand_rms")
"""What disturbs the ship itself."""


def line_of(rng: np.random.Generator) -> Tug:
    """Return a line without limits."""
    return Tug(
        proportional_gain=float(rng.uniform(4.0, 7.0)),
        integral_gain_per_s=float(rng.uniform(3.0, 5.5)),
        governor_delay_s=float(rng.uniform(0.05, 0.085)),
        natural_frequency_rad_s=float(rng.uniform(9.0, 12.5)),
        damping_ratio=float(rng.uniform(0.42, 0.65)),
        set_point_latency_s=float(rng.uniform(0.03, 0.08)),
        anti_windup_s=float(rng.uniform(0.3, 1.0)),
        inertia_upstream_kg_m2=float(rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2)),
        motoring_torque_nm=MOTORING_NM,
    )


def _with_torque(share: float) -> Vessel:
    torques = tuple(share * torque for torque in VESSEL.engine.full_load_torque_nm)
    return VESSEL.model_copy(update={"engine": VESSEL.engine.model_copy(update={"full_load_torque_nm": torques})})


def _limited_s(tug: Tug, vessel: Vessel) -> float:
    """Return for how long a limit of torque or rack acts without noise [s]."""
    rate_hz = 50.0
    ideal = simulate_signals(vessel, CAMPAIGN, tug=tug, rate_hz=rate_hz, longest_step_s=2e-3)
    return float(np.count_nonzero(ideal.limited) / rate_hz)


def _torque(rng: np.random.Generator, tug: Tug) -> Drawn:
    share = float(rng.uniform(0.5, 1.0))
    vessel = _with_torque(share)
    return Drawn(kind="torque", levels={"share": share}, acts_s=_limited_s(tug, vessel), tug=tug, vessel=vessel)


def _smoke(rng: np.random.Generator, tug: Tug) -> Drawn:
    air, lag = float(rng.uniform(0.35, 0.65)), float(rng.uniform(0.5, 2.0))
    smoking, vessel = replace(tug, unboosted_torque_share=air, turbocharger_lag_s=lag), _with_torque(1.0)
    levels = {"a_0": air, "tau_tc": lag}
    return Drawn(kind="smoke", levels=levels, acts_s=_limited_s(smoking, vessel), tug=smoking, vessel=vessel)


def _boosted(rng: np.random.Generator, tug: Tug) -> Drawn:
    """Return a turbocharged engine that the vessel file knows, loaded by up to 65 % at the working point."""
    air, lag, vessel = float(rng.uniform(0.42, 0.6)), float(rng.uniform(0.5, 2.0)), _with_torque(rng.uniform(0.55, 1.0))
    smoking = replace(tug, unboosted_torque_share=air, turbocharger_lag_s=lag)
    acts_s = _limited_s(smoking, vessel)
    return Drawn(
        kind="smoke", levels={"a_0": air, "tau_tc": lag}, acts_s=acts_s, tug=smoking, vessel=vessel, file=vessel
    )


def _rate(rng: np.random.Generator, tug: Tug) -> Drawn:
    rate = float(np.exp(rng.uniform(np.log(0.3), np.log(4.0))))
    slow, vessel = replace(tug, rack_rate_limit_per_s=rate), _with_torque(STRONGER)
    return Drawn(kind="rate", levels={"rack": rate}, acts_s=_limited_s(slow, vessel), tug=slow, vessel=vessel)


def _ramp(rng: np.random.Generator, tug: Tug) -> Drawn:
    rate = float(np.exp(rng.uniform(np.log(RPM_PER_S[0]), np.log(RPM_PER_S[-1]))))
    slow = replace(tug, demand_rate_limit_rpm_per_s=rate)
    acts = _ramping_s(CAMPAIGN, abs(tug.set_point_slope_rpm_per_v), rate)
    return Drawn(kind="ramp", levels={"r_s_rpm": rate}, acts_s=acts, tug=slow, vessel=_with_torque(STRONGER))


def _ramping_s(campaign: Campaign, rpm_per_v: float, rate_rpm_per_s: float) -> float:
    """Return for how long a limited set point is not where it is asked to be [s]."""
    step_s = 0.005
    asked = rpm_per_v * setpoint(campaign, np.arange(0.0, campaign.duration_s, step_s))
    last, late = asked[0], 0
    for value in asked.tolist():
        last += min(max(value - last, -rate_rpm_per_s * step_s), rate_rpm_per_s * step_s)
        late += abs(value - last) > 1e-9
    return late * step_s


def _deadband(rng: np.random.Generator, tug: Tug) -> Drawn:
    rpm = float(rng.uniform(4.0, 12.0))
    wide = replace(tug, governor_deadband_rpm=rpm)
    return Drawn(kind="deadband", levels={"d_e_rpm": rpm}, acts_s=np.inf, tug=wide, vessel=_with_torque(STRONGER))


def _held(rng: np.random.Generator, tug: Tug) -> Drawn:
    cycle = float(rng.uniform(0.02, 0.1))
    held = replace(tug, demand_cycle_s=cycle)
    return Drawn(kind="held", levels={"T_set": cycle}, acts_s=np.inf, tug=held, vessel=_with_torque(STRONGER))


_LIMITED: dict[str, Callable[[np.random.Generator, Tug], Drawn]] = {
    "torque": _torque,
    "smoke": _smoke,
    "rate": _rate,
    "ramp": _ramp,
    "deadband": _deadband,
    "held": _held,
}


def true_levels(one: Drawn, truth: Truth) -> dict[str, float]:
    """Return the true numbers of the limit in the units of the program."""
    if one.kind == "rate":
        return {"r_x": one.levels["rack"] / truth.normalised["X_0"]}
    return one.levels


def outcome(seed: int) -> dict[str, Any]:
    """Sail one ship, find its limits, and hold them against the truth."""
    one = unkind(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "limits.nc"
        truth = sail(one.vessel, CAMPAIGN, path, tug=one.tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, one.file, CAMPAIGN)
    begin = time.process_time()
    found = identify_limits(signals, CAMPAIGN, one.file)
    seconds = time.process_time() - begin
    named, true = {kind.name.lower() for kind in found.kinds}, true_levels(one, truth)
    return {
        "seed": seed,
        "kind": one.kind,
        "acts_s": min(one.acts_s, CAMPAIGN.duration_s),
        "named": one.kind in named,
        "also": sorted(named - {one.kind}),
        "also_trusted": sorted({Kind(n.limit).name.lower() for n in found.numbers if n.trusted} - {one.kind}),
        "gains": {kind.name.lower(): gain for kind, gain in found.gains.items()},
        "at_bounds": [estimate.name for estimate in found.governor if estimate.at_bound],
        "numbers": {
            n.name: {
                "value": n.value, "std": n.std, "interval": n.interval_95,
                "true": true.get(n.name), "doubt": n.doubt,
            }
            for n in found.numbers
        },
        "cpu_s": seconds,
    }  # fmt: skip


def table(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return one row a kind, in Markdown."""
    lines = ["| limit | recordings | named | level inside | trusted, of it inside | interval / level | also | CPU s |"]
    lines.append("|---|---|---|---|---|---|---|---|")
    for kind in (*KINDS, NONE, "all"):
        own = [one for one in outcomes if kind in (one["kind"], "all")]
        levels = [one["numbers"][LEVEL[one["kind"]]] for one in own if one["named"]]
        inside = [one["interval"][0] <= one["true"] <= one["interval"][1] for one in levels]
        trusted = [held for held, one in zip(inside, levels, strict=True) if not one["doubt"]]
        width = [(one["interval"][1] - one["interval"][0]) / one["true"] for one in levels if not one["doubt"]]
        limited = sum(one["kind"] != NONE for one in own)
        lines.append(
            f"| {kind} | {len(own)} | {len(levels)} of {limited} | {sum(inside)} of {len(inside)} | "
            f"{len(trusted)}, {sum(trusted)} | {f'{100.0 * np.median(width):.1f} %' if width else ''} | "
            f"{sum(bool(one['also']) for one in own)}, trusted {sum(bool(one['also_trusted']) for one in own)} | "
            f"{np.median([one['cpu_s'] for one in own]) if own else np.nan:.0f} |"
        )
    return "\n".join(lines)


LEVEL = {"torque": "share", "smoke": "a_0", "rate": "r_x", "ramp": "r_s_rpm", "deadband": "d_e_rpm", "held": "T_set"}
"""The number by which each limit is judged."""


def main() -> None:
    """Sail, find and print."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--folder", type=Path, required=True, help="where the outcomes are")
    parser.add_argument("--first", type=int, default=0, help="number of the first ship")
    parser.add_argument("--count", type=int, default=150, help="number of ships")
    options = parser.parse_args()
    options.folder.mkdir(parents=True, exist_ok=True)
    for seed in range(options.first, options.first + options.count):
        one = kept(options.folder / f"{seed:03d}.json", partial(outcome, seed))
        print({name: one[name] for name in ("seed", "kind", "named", "also", "also_trusted", "at_bounds")}, flush=True)
    print(table([json.loads(path.read_text(encoding="utf-8")) for path in sorted(options.folder.glob("*.json"))]))


if __name__ == "__main__":
    main()
