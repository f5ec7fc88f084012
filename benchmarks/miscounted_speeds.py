"""Miscounted speeds and torques of the wrong shaft, beside healthy ships of another day: what the verdict says first.

Every recording is one of the simulated Stan Tug, most of them of two speeds. Its vessel file is that of another day:
the working point carries another load and stands at another speed, as the lever was set. Run
``python benchmarks/miscounted_speeds.py --seeds 20 --outcomes build/miscounted``; a recording takes about ten seconds
of one core, and those that ``--outcomes`` holds are not made again.
"""

import argparse
import json
from collections.abc import Callable
from pathlib import Path

import numpy as np

from shaftprint.campaign import load_campaign
from shaftprint.errors import ShaftprintError
from shaftprint.survey import run
from shaftprint.tug import sail
from shaftprint.vessel import Vessel, load_vessel

TESTS = ("short", "5min", "12min")
# Standard deviations of the logarithms of load and speed, and the farthest that is drawn.
LOAD, SPEED, FARTHEST = 0.12, 0.05, 2.0


def with_speed(vessel: Vessel, place: int, **fields: object) -> Vessel:
    """Return the vessel with one pick-up alone, of which something else is said."""
    speed = vessel.sensors.speed[place].model_copy(update=fields)
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"speed": (speed,)})})


def with_gauge(vessel: Vessel, factor: float) -> Vessel:
    """Return the vessel with another scale of its gauge."""
    gauge = vessel.sensors.shaft_torque
    changed = gauge.model_copy(
        update={
            "scale_nm_per_unit": factor * gauge.scale_nm_per_unit,
            "full_scale_nm": max(factor, 1.0) * gauge.full_scale_nm,
        }
    )
    return vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"shaft_torque": changed})})


CASES: dict[str, tuple[str, Callable[[Vessel], Vessel]]] = {
    "healthy": ("", lambda vessel: vessel),
    "healthy, one pick-up": ("", lambda vessel: with_speed(vessel, 0)),
    "2 pulses for 1": ("speed scale", lambda vessel: with_speed(vessel, 0, pulses_per_revolution=2)),
    "3 pulses for 1": ("speed scale", lambda vessel: with_speed(vessel, 0, pulses_per_revolution=3)),
    "propeller's for engine's": ("speed scale", lambda vessel: with_speed(vessel, 1, shaft="engine")),
    "engine's for propeller's": ("speed scale", lambda vessel: with_speed(vessel, 0, shaft="propeller")),
    "gauge of the engine's shaft": ("gauge scale", lambda vessel: with_gauge(vessel, 1.0 / vessel.gearbox.ratio)),
    "gauge with the ratio twice": ("gauge scale", lambda vessel: with_gauge(vessel, vessel.gearbox.ratio)),
}
"""What is wrong, with the kind of reason that must be first."""


def of_another_day(vessel: Vessel, seed: int) -> Vessel:
    """Return the vessel with the working point of another load and lever, and the torque coefficient of that load."""
    drawn = np.clip(np.random.default_rng([seed, 97]).standard_normal(2), -FARTHEST, FARTHEST)
    load, speed = float(np.exp(LOAD * drawn[0])), float(np.exp(SPEED * drawn[1]))
    point = vessel.working_point.model_copy(
        update={
            "engine_speed_rpm": speed * vessel.working_point.engine_speed_rpm,
            "shaft_torque_nm": load * speed**2 * vessel.working_point.shaft_torque_nm,
        }
    )
    return vessel.model_copy(update={"working_point": point})


def outcome(case: str, test: str, seed: int, folder: Path) -> dict[str, object]:
    """Return what the verdict says of one recording."""
    vessel, campaign = load_vessel("stan-tug-1205"), load_campaign(test)
    recording = folder / f"{test}-{seed}.h5"
    if not recording.exists():
        sail(vessel, campaign, recording, seed=seed)
    _, change = CASES[case]
    try:
        survey = run(recording, change(of_another_day(vessel, seed)), campaign, judge=False)
    except ShaftprintError as error:
        return {"refused": str(error), "kinds": [], "trusted": 0}
    verdict = survey.fingerprint.verdict
    return {"kinds": [reason.kind for reason in verdict.reasons], "trusted": len(verdict.trusted)}


def main() -> None:
    """Print how many of each case were named first, and how many were trusted."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--outcomes", type=Path, default=Path("build/miscounted"))
    arguments = parser.parse_args()
    arguments.outcomes.mkdir(parents=True, exist_ok=True)
    for case, (kind, _) in CASES.items():
        found = []
        for test in TESTS:
            for seed in range(1, arguments.seeds + 1):
                path = arguments.outcomes / f"{case.replace(' ', '-')}-{test}-{seed}.json"
                if not path.exists():
                    path.write_text(json.dumps(outcome(case, test, seed, arguments.outcomes)), encoding="utf-8")
                found.append(json.loads(path.read_text(encoding="utf-8")))
        scales = [{"speed scale", "gauge scale"} & {*one["kinds"]} for one in found]
        named = sum(kind in one["kinds"][:3] for one in found)
        trusted = sum(one["trusted"] > 0 for one in found)
        told = f"named {named}" if kind else f"scale in doubt {sum(map(bool, scales))}"
        print(f"{case}: {len(found)} recordings, {told}, with trusted numbers {trusted}", flush=True)


if __name__ == "__main__":
    main()
