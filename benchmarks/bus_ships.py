"""Ships of any size of which a card is known, tested for 12 minutes over a bus: whether the intervals hold.

Power, speeds, gear, propeller and lever are drawn; truth, governor and delays are drawn about what the card lets guess.
The shipped test is made for the lever of each by ``shaftprint new campaign``, sailed with torque, speed and set point
in messages, and identified. Run ``python benchmarks/bus_ships.py --seeds 20 --outcomes FOLDER``; outcomes that the
folder holds are not made again. With ``--write`` the sentence goes into docs/can-log.md. A ship takes about 25 s of a
processor.
"""

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service_ships import drawn
from shaftprint.cli import shaftprint
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.forecast._shipped_test import shipped_test
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.survey import run
from shaftprint.tug import sail
from shaftprint.tug._in_messages import in_messages
from shaftprint.tug._like_stan_tug import with_lever_of
from shaftprint.vessel import load_vessel
from shaftprint.vessel._vessel import Vessel

DOCUMENT = ROOT / "docs" / "can-log.md"
BEGIN, END = (
    "<!-- sentence of benchmarks/bus_ships.py: begin -->",
    "<!-- sentence of benchmarks/bus_ships.py: end -->",
)
RATES_HZ = {"torque": 100.0, "speed": 50.0, "set-point": 50.0}
_ROUNDS = 4
# Share of a leg with the engine at a limit by which a refusal is right.
_AT_LIMITS = 0.005
_PERCENT = 100.0


def ship(rng: np.random.Generator, place: Path) -> Vessel:
    """Return a ship by its card, whose propeller takes 0.8 to 1.05 of the rated power in bollard pull."""
    rated_rpm = float(rng.choice([750, 1000, 1500, 1800, 2100]))
    power_kw = float(np.exp(rng.uniform(np.log(200.0), np.log(4000.0))))
    propeller_rpm = float(np.clip(rated_rpm / rng.uniform(2.0, 6.0), 120.0, 900.0))
    asked_kw = power_kw * float(rng.uniform(0.8, 1.05))
    words = [
        *("--power-kw", f"{power_kw:.0f}", "--rated-rpm", f"{rated_rpm:g}"),
        *("--cylinders", str(int(rng.choice([6, 8, 12]))), "--ratio", f"{rated_rpm / propeller_rpm:.3f}"),
        *("--blades", str(int(rng.choice([4, 5]))), "--pitch-ratio", f"{rng.uniform(0.75, 1.1):.2f}"),
        *("--set-point", "demand", "--lever-unit", "%", "--engine-speed", "n_eng", "--torque", "T_shaft"),
        *("--lever", f"0={0.33 * rated_rpm:.0f}", "--lever", f"100={rated_rpm:.0f}"),
    ]
    diameter_m = 1.0
    for _ in range(_ROUNDS):
        file = place / "ship.toml"
        file.unlink(missing_ok=True)
        made = CliRunner().invoke(
            shaftprint,
            ["new", "vessel", str(file), *words, "--diameter-m", f"{diameter_m:.3f}"],
            catch_exceptions=False,
        )
        if made.exit_code:
            raise RuntimeError(made.output)
        vessel = load_vessel(file)
        point = vessel.working_point
        turns_s = point.engine_speed_rpm / vessel.gearbox.ratio / 60.0
        taken_kw = 2.0 * np.pi * turns_s * point.driving_torque_nm / 1e3 * (rated_rpm / point.engine_speed_rpm) ** 3
        diameter_m *= float((asked_kw / taken_kw) ** 0.2)
    return vessel


def outcome(seed: int) -> dict[str, Any]:
    """Return what a test of one ship tells, beside its truth."""
    rng = np.random.default_rng((seed, 77))
    with tempfile.TemporaryDirectory() as folder:
        place = Path(folder)
        vessel = ship(rng, place)
        said: dict[str, Any] = {"seed": seed, "power_kw": vessel.engine.rated_power_kw if vessel.engine else 0.0}
        try:
            campaign, smaller = shipped_test("12min", vessel, title="12 minutes")
            said["smaller"] = smaller
            tug = in_messages(with_lever_of(drawn(vessel, rng), vessel, campaign), vessel, rates_hz=RATES_HZ)
            truth = sail(vessel, campaign, place / "bus.nc", tug=tug, seed=seed)
            survey = run(place / "bus.nc", vessel, campaign, rng=np.random.default_rng(seed), judge=False)
        except ShaftprintError as error:
            return said | {"refused": str(error).replace(folder, "")}
    verdict, found = survey.fingerprint.verdict, survey.fingerprint
    true = fingerprint_truth(truth, survey.identification.structure, survey.signals)
    numbers = {one.name: one for one in (*found.parameters, *found.combinations, *found.physical)}
    return said | {
        "limited": truth.limited,
        "refused": "" if verdict.trustworthy else verdict.reason,
        "part": [reason.sentence for reason in verdict.reasons],
        "z": {
            name: (one.value - true[name]) / one.std
            for name, one in numbers.items()
            if name in verdict.trusted and name in true and one.std > 0.0
        },
    }


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return what was found of all ships, in sentences."""
    fitted = [one for one in outcomes if not one["refused"]]
    z = np.array([value for one in fitted for value in one["z"].values()])
    held = np.abs(z) < NORMAL_95
    refused = [one for one in outcomes if one["refused"]]
    text = (
        f"{len(outcomes)} ships of 200 to 4000 kW, of which only a card is known, twelve minutes each over a bus: "
        f"{len(fitted)} may be used, and {_PERCENT * held.mean():.0f} % of {held.size} trusted intervals hold (rms z "
        f"{np.sqrt(np.mean(z**2)):.2f}, largest {np.abs(z).max():.1f})."
    )
    longest = {one["seed"]: max(one["limited"].values(), default=0.0) for one in refused if "limited" in one}
    shares = [share for share in longest.values() if share > _AT_LIMITS]
    if shares:
        text += (
            f" {len(shares)} are refused: their governor, which no card tells, took the engine to a limit for "
            f"{_PERCENT * min(shares):.0f} to {_PERCENT * max(shares):.0f} % of a leg."
        )
    others = [one["refused"] for one in refused if longest.get(one["seed"], 0.0) <= _AT_LIMITS]
    return text + "".join(f" Refused: {one}" for one in others)


def main() -> None:
    """Make what is missing, and print the sentence."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--outcomes", type=Path, required=True)
    parser.add_argument("--write", action="store_true", help="write the sentence into docs/can-log.md")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    outcomes = []
    for seed in range(options.first, options.first + options.seeds):
        outcomes.append(kept(options.outcomes / f"{seed}.json", lambda seed=seed: outcome(seed)))
        one = outcomes[-1]
        large = {name: round(z, 1) for name, z in one.get("z", {}).items() if abs(z) > NORMAL_95}
        print(seed, round(one["power_kw"]), one["smaller"][:40], one["refused"] or large, flush=True)
    text = report(outcomes)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
