"""Planned tests on ships that are less kind than their plan: what is trusted, held against the truth.

Every test has a truth of its own, drawn as in ``monte_carlo_short.py``, and beside it what that leaves out: the line of
the lever bends by 0.3 % per volt (standard deviation), has play, and comes to the control unit in steps; the noise of
the ship is 0.5 to 3 times as dense as that of the tug for which the test was planned; and the ship surges in half of
the tests. Each recording goes through ``shaftprint identify`` with the vessel file as it is, and every number of the
fingerprint is held against the truth at the working point of its leg. Run ``python benchmarks/unkind_tests.py --case 12
--tests 200 --write``; a test takes about fifteen seconds of one core, and outcomes that are kept are not sailed again.
"""

import argparse
import subprocess
import sys
import tempfile
import time
from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks import leg_outcomes, monte_carlo_recordings, monte_carlo_short
from benchmarks.kept_outcomes import kept
from benchmarks.monte_carlo_short import Row, Ship, between, drawn_ship, summary
from benchmarks.planned_tests import VESSEL as TUG
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import Campaign, setpoint
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.models import margins
from shaftprint.signals import Signals
from shaftprint.survey import Trial, load_trial, run
from shaftprint.tug import Noise, Truth, sail

DOCUMENT = ROOT / "docs" / "planned-tests.md"
SEED = 133
# A telemetry whose range the noise of no ship passes: what is cut off is refused, which is looked at elsewhere.
_GAUGE = TUG.sensors.shaft_torque
VESSEL = TUG.model_copy(
    update={
        "sensors": TUG.sensors.model_copy(
            update={"shaft_torque": _GAUGE.model_copy(update={"full_scale_nm": 2.0 * _GAUGE.full_scale_nm})}
        )
    }
)
# Whole minutes of the plan, by what the case is called.
PLANS = ("12", "5")
# One standard deviation of the bend, as a vessel file assumes it where it states none.
BEND_STD_PER_V, MOST_PLAY_V = 0.003, 0.01
POINTS_A_PERIOD = 20_000
STEPS_RPM, STEPS_V = (None, 1.0, 4.8), (None, 0.0049)
DENSITY = (0.5, 3.0)
INFLOW_RMS, INFLOW_TIME_S, SURGE_HZ = (0.01, 0.03), (10.0, 100.0), (0.05, 0.2)


def unkind_ship(seed: int) -> Ship:
    """Return the ship of a seed: its line and gauge as in short tests, its lever and noise less kind."""
    rng, ship = np.random.default_rng([SEED, seed]), drawn_ship(seed, VESSEL)
    usual, factor = Noise(), float(np.sqrt(between(rng, *DENSITY)))
    noise = replace(
        usual.scaled(factor, but=("inflow_rms", "surge_rms")),
        inflow_rms=float(rng.uniform(*INFLOW_RMS)),
        inflow_corner_hz=1.0 / (2.0 * np.pi * between(rng, *INFLOW_TIME_S)),
        surge_rms=factor * usual.surge_rms if rng.random() < 0.5 else 0.0,
        surge_hz=between(rng, *SURGE_HZ),
    )
    tug = replace(
        ship.tug,
        noise=noise,
        set_point_bend_per_v=float(rng.normal(0.0, BEND_STD_PER_V)),
        set_point_hysteresis_v=float(rng.uniform(0.0, MOST_PLAY_V)),
        demand_resolution_rpm=STEPS_RPM[int(rng.integers(len(STEPS_RPM)))],
        generator_step_v=STEPS_V[int(rng.integers(len(STEPS_V)))],
    )
    return replace(ship, tug=tug)


def play_delay_s(play_v: float, campaign: Campaign) -> float:
    """Return by how much play makes the set point late, the mean over the legs [s].

    It is the delay that comes nearest to what play makes of the lines of a leg, each by how fast it moves the lever. A
    set point that moves like noise has the closed form ``sqrt(2 / pi) w / 2 / rms(dU/dt)``, which is twice too long
    here: small lines turn round within the play while a large one hardly moves.
    """
    return float(np.mean([_delay_of_leg_s(play_v, leg, campaign) for leg in campaign.legs]))


def _delay_of_leg_s(play_v: float, leg: Any, campaign: Campaign) -> float:
    time_s = leg.settled_s + np.arange(POINTS_A_PERIOD) * leg.length_of_period_s / POINTS_A_PERIOD
    asked = setpoint(campaign, time_s)
    followed, last = np.empty_like(asked), asked[0]
    # a period before, so that where the lever came from does not matter
    for _ in range(2):
        for place, voltage in enumerate(asked.tolist()):
            last = min(max(last, voltage - 0.5 * play_v), voltage + 0.5 * play_v)
            followed[place] = last
    lines = np.array(list(leg.lines))
    turn = 2j * np.pi * lines / leg.length_of_period_s
    # of a set point that is later by a second, and of the one behind the play: how much slower it moves
    per_second, slower = turn**2 * np.fft.rfft(asked)[lines], turn * np.fft.rfft(asked - followed)[lines]
    return float(np.vdot(per_second, slower).real / np.vdot(per_second, per_second).real)


def true_values(truth: Truth, ship: Ship, signals: Signals, campaign: Campaign) -> dict[str, float]:
    """Return the truth of the numbers of the line at the working point of the first leg, as its gauge shows it.

    What is divided by the torque is that of the ship at its mean load, as the fingerprint says: how far the load of the
    leg lay from it is counted in the deviations.
    """
    zero_nm = truth.physical["torque_zero_offset_nm"]
    of_gauge = monte_carlo_recordings.Ship(
        tug=ship.tug, vessel=ship.vessel, scale=ship.scale, zero_nm=zero_nm, late_s=ship.late_s
    )
    point, tug = signals.working_point, ship.tug
    speed_rpm = 60.0 * point.engine_speed_rev_s
    at_mean_load = truth.shaft_torque_nm * ship.scale * (speed_rpm / truth.engine_speed_rpm) ** 2
    usual = replace(point, shaft_torque_nm=at_mean_load + ship.scale * zero_nm * point.zero_share)
    of_load = leg_outcomes.true_values(truth, replace(signals, working_point=usual), of_gauge)
    # the exponent of the law is that of the torque that was shown
    known = of_load | {"k_q": leg_outcomes.true_values(truth, signals, of_gauge)["k_q"]}
    # slope over the speed of a line whose slope goes with the volts: s^2 = s_0^2 + 2 s_0 b (n - n_0)
    at_first, bend = tug.set_point_slope_rpm_per_v, tug.set_point_slope_rpm_per_v * tug.set_point_bend_per_v
    square = at_first**2 + 2.0 * bend * (speed_rpm - truth.engine_speed_rpm)
    known["c_set"] = -np.sqrt(square) / (60.0 * signals.calibration.slope_rev_s_per_v)
    known["b_set"] = bend * speed_rpm / square
    known["t_sp"] += play_delay_s(tug.set_point_hysteresis_v, campaign)
    known["t_d + t_sp"] = known["t_d"] + known["t_sp"]
    loop = margins(closed := structure("GAUGE-CLOSED"), closed.vector({p.name: known[p.name] for p in closed.free}))
    return (
        known
        | {
            "gain margin": loop.gain_margin,
            "phase margin": float(np.degrees(loop.phase_margin_rad)),
            "delay margin": loop.delay_margin_s,
        }
        | monte_carlo_short._true_physical(truth, ship.vessel)
    )


def tested(seed: int, trial: Trial) -> dict[str, Any]:
    """Sail, identify and judge the ship of a seed."""
    ship, began = unkind_ship(seed), time.process_time()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        truth = sail(ship.vessel, trial.campaign, path, seed=seed, tug=ship.tug)
        try:
            survey = run(path, trial.vessel, trial.campaign, judge=False)
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    found = survey.fingerprint
    rows = _rows(found, true_values(truth, ship, survey.signals, trial.campaign))
    return {
        "seed": seed,
        "trustworthy": found.verdict.trustworthy,
        "reasons": [one.sentence for one in found.verdict.reasons],
        "p": survey.identification.p_value,
        "bend": ship.tug.set_point_bend_per_v,
        "cpu_s": time.process_time() - began,
        "rows": {
            name: {field: getattr(row, field) for field in Row.__dataclass_fields__} for name, row in rows.items()
        },
    }


def _rows(found: Fingerprint, true: Mapping[str, float]) -> dict[str, Row]:
    """Return the numbers of the line beside their truth: what the bent line is as a whole, a truth cannot say."""
    numbers = (*found.parameters, *found.combinations, *found.physical, *found.margins)
    trusted = set(found.verdict.trusted)
    return {
        q.name: monte_carlo_short._row(q, true[q.name], trusted=q.name in trusted) for q in numbers if q.name in true
    }


def is_trustworthy(outcome: Mapping[str, Any]) -> bool:
    """Return whether a test was fitted and its trusted numbers may be used."""
    return bool(outcome.get("trustworthy"))


def keeps_what_is_right(outcome: Mapping[str, Any]) -> bool:
    """Return whether no check takes from a healthy test a number that is right.

    A reason takes numbers away that would be trusted without it; where there is none, only those are not trusted whose
    own intervals are too wide.
    """
    lost = any(Row(**row).inside and not row["trusted"] for row in outcome.get("rows", {}).values())
    return is_trustworthy(outcome) and not (outcome["reasons"] and lost)


def planned_from_card(minutes: int, folder: Path) -> Path:
    """Return the campaign that ``shaftprint plan`` makes for the ship, of whose governor and noise nothing is known."""
    if not folder.exists():
        words = [
            "plan", "--vessel", "stan-tug-1205", "--wish", "t_d=20%", "--wish", "K_p=6%", "--within", f"{minutes}min",
            "--limit", "set-point=1.0V", "--rpm-per-volt", "-251", "--offset", "-5", "-o", str(folder),
        ]  # fmt: skip
        subprocess.run([sys.executable, "-m", "shaftprint", *words], check=True, stdout=subprocess.DEVNULL)
    return folder / "campaign.toml"


def main() -> None:
    """Run the tests and print their table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--case", choices=PLANS, default="12", help="minutes of the plan")
    parser.add_argument("--tests", type=int, default=200, help="number of tests")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--outcomes", type=Path, default=ROOT / "build" / "unkind", help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    folder = options.outcomes / options.case
    folder.mkdir(parents=True, exist_ok=True)
    trial = load_trial(VESSEL, planned_from_card(int(options.case), folder / "plan"))
    outcomes = []
    for seed in range(options.first, options.first + options.tests):
        one = kept(folder / f"{seed:03d}.json", partial(tested, seed, trial))
        outcomes.append(one)
        wrong = [n for n, r in one.get("rows", {}).items() if r["trusted"] and not Row(**r).inside]
        print(seed, one.get("trustworthy"), one.get("p"), wrong, one.get("reasons", one.get("refused")), flush=True)
    tests = [{name: Row(**row) for name, row in one.get("rows", {}).items()} for one in outcomes]
    text = summary(tests, f"planned tests of {options.case} minutes")
    trusted, whole = (sum(map(of, outcomes)) for of in (is_trustworthy, keeps_what_is_right))
    text += f"\nTrustworthy {trusted} of {len(outcomes)}; {whole} keep all that is right.\n"
    print(text)
    if options.write:
        name = f"unkind tests of {options.case} minutes"
        write_between_marks(DOCUMENT, text, f"<!-- {name}: begin -->", f"<!-- {name}: end -->")


if __name__ == "__main__":
    main()
