"""Monte Carlo of limits: recordings of a quarter of an hour with one limit each, named and measured by the program.

Every ship is drawn: governor, delays, actuation, and what a vessel file states with a standard deviation. It has one
limit, of a level at which the limit acts for at least two seconds of the test; all others are far away.

``python -m benchmarks.limits sail --folder DIR --count 100`` writes the recordings, 12 CPU seconds each;
``python -m benchmarks.limits run --folder DIR`` finds the limits of all that are there and prints the table.
"""

import argparse
import json
import time
from collections.abc import Callable, Sequence
from dataclasses import asdict, dataclass, replace
from pathlib import Path

import numpy as np

from benchmarks.nonlinear_fit import with_wide_gauge
from benchmarks.validation import MOTORING_NM, STRONGER
from shaftprint.campaign import Campaign, load_campaign, setpoint
from shaftprint.limits import identify_limits
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.tug import Truth, Tug, sail, simulate_signals
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
    """What sails: the vessel file is ``VESSEL``."""


KINDS = ("torque", "smoke", "rate", "ramp", "deadband", "held")


def drawn(seed: int) -> Drawn:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    kind = KINDS[seed % len(KINDS)]
    tug = line_of(rng)
    while True:
        one = _LIMITED[kind](rng, tug)
        if LEAST_S <= one.acts_s <= MOST_S or np.isinf(one.acts_s):
            return one


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


def write(folder: Path, seeds: Sequence[int]) -> None:
    """Sail the ships of some seeds that are not there yet."""
    folder.mkdir(parents=True, exist_ok=True)
    for seed in seeds:
        path = folder / f"{seed:03d}.nc"
        if path.exists():
            continue
        one = drawn(seed)
        truth = sail(one.vessel, CAMPAIGN, path, tug=one.tug, seed=seed)
        about = {"kind": one.kind, "levels": true_levels(one, truth), "acts_s": min(one.acts_s, CAMPAIGN.duration_s)}
        path.with_suffix(".limit.json").write_text(json.dumps(about), encoding="utf-8")
        print(seed, about, flush=True)


@dataclass(frozen=True, kw_only=True, slots=True)
class Result:
    """What the program says of one recording."""

    seed: int
    """Number of the recording."""
    kind: str
    """The limit that it has."""
    named: bool
    """Whether it is among those that were named."""
    also: tuple[str, ...]
    """What was named besides."""
    inside: dict[str, bool]
    """Whether each true number is in its interval."""
    error: dict[str, float]
    """Estimate less truth, in standard deviations."""
    width: dict[str, float]
    """Length of the interval over the truth."""
    seconds: float
    """CPU time of ``identify_limits``."""


def run(folder: Path, seed: int) -> Result:
    """Find the limits of one recording and hold them against the truth."""
    path = folder / f"{seed:03d}.nc"
    about = json.loads(path.with_suffix(".limit.json").read_text(encoding="utf-8"))
    with read_recording(path) as recording:
        signals = prepare_signals(recording, VESSEL, CAMPAIGN)
    begin = time.process_time()
    found = identify_limits(signals, CAMPAIGN, VESSEL)
    kinds = {kind.name.lower() for kind in found.kinds}
    numbers = {number.name: number for number in found.numbers}
    levels = {name: value for name, value in about["levels"].items() if name in numbers}
    return Result(
        seed=seed,
        kind=about["kind"],
        named=about["kind"] in kinds,
        also=tuple(sorted(kinds - {about["kind"]})),
        inside={name: numbers[name].lower <= value <= numbers[name].upper for name, value in levels.items()},
        error={name: (numbers[name].value - value) / numbers[name].std for name, value in levels.items()},
        width={name: (numbers[name].upper - numbers[name].lower) / value for name, value in levels.items()},
        seconds=time.process_time() - begin,
    )


def table(results: Sequence[Result]) -> str:
    """Return one row a kind, in Markdown."""
    lines = ["| limit | recordings | named | level inside | interval / level | also named | CPU s |"]
    lines.append("|---|---|---|---|---|---|---|")
    for kind in (*KINDS, "all"):
        own = [one for one in results if kind in (one.kind, "all")]
        named = [one for one in own if one.named]
        level = {LEVEL[one.kind] for one in own}
        inside = [one.inside[name] for one in named for name in level if name in one.inside]
        width = [one.width[name] for one in named for name in level if name in one.width]
        also = sum(bool(one.also) for one in own)
        seconds = np.median([one.seconds for one in own]) if own else np.nan
        lines.append(
            f"| {kind} | {len(own)} | {len(named)} | {sum(inside)} of {len(inside)} | "
            f"{100.0 * np.median(width) if width else np.nan:.1f} % | {also} | {seconds:.0f} |"
        )
    return "\n".join(lines)


LEVEL = {"torque": "share", "smoke": "a_0", "rate": "r_x", "ramp": "r_s_rpm", "deadband": "d_e_rpm", "held": "T_set"}
"""The number by which each limit is judged."""


def main() -> None:
    """Sail or run."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("what", choices=("sail", "run"))
    parser.add_argument("--folder", type=Path, required=True, help="where the recordings are")
    parser.add_argument("--count", type=int, default=100, help="number of recordings")
    parser.add_argument("--first", type=int, default=0, help="number of the first recording to run")
    options = parser.parse_args()
    if options.what == "sail":
        write(options.folder, range(options.count))
        return
    results = []
    for seed in range(options.first, options.count):
        if not (options.folder / f"{seed:03d}.limit.json").exists():
            continue
        results.append(run(options.folder, seed))
        print(json.dumps(asdict(results[-1])), flush=True)
    print(table(results))


if __name__ == "__main__":
    main()
