"""Half an hour of dither in service: to what the numbers of line and ship are known, in two sea states.

A simulated ship sails the shipped campaign ``dither``, 2 % of the speed about 1600 rpm, with the log in the recording:
the Stan Tug 1205 with its propellers in nozzles, or the PT May with open ones (``--vessel pt-may-underway``). Governor,
actuation, inertias, wake, thrust deduction, resistance, mass, pitch, scale, zero and latency of the torque gauge, scale
and latency of the log and all noise are drawn; the vessel file says what a yard would know. Waves swing the torque of
the propeller at the frequency at which they are met. Run ``python -m benchmarks.underway --seeds 50 --write``, about
ten seconds a test of one core; outcomes in a folder are not sailed again.
"""

import argparse
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.kept_outcomes import kept
from benchmarks.monte_carlo_short import drawn_noise
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import load_campaign
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.survey import run
from shaftprint.tug import Truth, Tug, like_stan_tug_1205, sail
from shaftprint.vessel import Vessel, load_vessel

PAGE = Path(__file__).parents[1] / "docs" / "free-sailing.md"
CAMPAIGN, SEED = load_campaign("dither"), 41
SHIP = ("w", "t", "R", "R exponent")
LINE = ("I_dn", "b", "(e - a) / tau_u", "b (2 - a) / tau_u", "(2 - a) / tau_u")
LOOP = ("K_i", "t_d", "omega_n", "zeta")


@dataclass(frozen=True, slots=True)
class Sea:
    """Waves that a ship meets, as its shafts and its log feel them."""

    name: str
    torque_rms: float
    """Swing of the propeller's torque over its mean."""
    met_hz: float
    """Frequency at which they are met [Hz]."""
    log_rms_m_s: float
    """Noise of a value of the log [m/s]."""


# Long-crested head seas at 9.2 and 9.7 knots: rms of the orbital speed at the propeller, 1.5 m deep, over that of the
# ship, times the slope of the torque coefficient, -0.46 in the nozzle and -1.63 without. Significant height 0.3 m at
# 4 s, 0.9 m at 5 s.
SEAS: Mapping[str, tuple[Sea, ...]] = {
    "stan-tug-1205-underway": (Sea("sea state 2", 0.008, 0.44, 0.03), Sea("sea state 3", 0.022, 0.32, 0.06)),
    "pt-may-underway": (
        Sea("open propellers in sea state 2", 0.027, 0.45, 0.03),
        Sea("open propellers in sea state 3", 0.074, 0.33, 0.06),
    ),
}


@dataclass(frozen=True, slots=True)
class Ship:
    """What sails: the vessel with its real gauge, propeller and log, and its truth."""

    known: Vessel
    """Vessel file without the errors of its gauge, propeller and log."""
    vessel: Vessel
    tug: Tug


def ship_of(known: Vessel, sea: Sea, seed: int) -> Ship:
    """Draw a ship about what the vessel file states, with the standard deviations that it states."""
    rng = np.random.default_rng([SEED, seed])
    content, gauge, log, hull = known.model_dump(), known.sensors.shaft_torque, known.sensors.ship_speed, known.hull
    usual = like_stan_tug_1205(known, offset_v=CAMPAIGN.offset_v)
    if log is None or hull is None or usual.sailing is None:
        raise SystemExit(f"{known.name}: expected a log and a hull.")
    scale = 1.0 + float(rng.normal(0.0, gauge.scale_std))
    content["sensors"]["shaft_torque"] |= {
        "scale_nm_per_unit": float(gauge.scale_nm_per_unit or 1.0) / scale,
        "latency_s": max(0.0, float(rng.normal(gauge.latency_s, gauge.latency_std))),
    }
    content["sensors"]["ship_speed"] |= {"latency_s": max(0.0, float(rng.normal(log.latency_s, log.latency_std)))}
    sailing = replace(
        usual.sailing,
        wake_fraction=usual.sailing.wake_fraction + float(rng.uniform(-0.08, 0.08)),
        thrust_deduction=usual.sailing.thrust_deduction + float(rng.uniform(-0.07, 0.07)),
        resistance_factor=float(np.exp(rng.normal(0.0, 0.05))),
        resistance_exponent=float(rng.uniform(2.5, 4.5)),
        surging_mass_kg=float(rng.normal(hull.surging_mass_kg, hull.surging_mass_std_kg)),
        log_rms_m_s=sea.log_rms_m_s,
        log_scale=1.0 + float(rng.normal(0.0, log.scale_std)),
    )
    tug = replace(
        usual,
        sailing=sailing,
        proportional_gain=usual.proportional_gain * float(rng.uniform(0.75, 1.1)),
        integral_gain_per_s=usual.integral_gain_per_s * float(rng.uniform(0.8, 1.2)),
        governor_delay_s=float(rng.uniform(0.05, 0.08)),
        natural_frequency_rad_s=float(rng.uniform(9.5, 12.5)),
        damping_ratio=float(rng.uniform(0.45, 0.65)),
        set_point_latency_s=float(rng.uniform(0.03, 0.08)),
        g=float(rng.normal(0.0, 0.1)),
        inertia_upstream_kg_m2=float(rng.normal(known.inertia_upstream_kg_m2, known.inertia_upstream_std_kg_m2)),
        inertia_downstream_kg_m2=float(rng.normal(known.inertia_downstream_kg_m2, known.inertia_downstream_std_kg_m2)),
        torque_zero_offset_nm=float(rng.normal(0.0, gauge.zero_std)),
        noise=replace(drawn_noise(rng), surge_rms=sea.torque_rms, surge_hz=sea.met_hz),
    )
    return Ship(known, Vessel.model_validate(content), tug)


def known_of(known: Vessel, seed: int) -> Vessel:
    """Return the vessel file, whose pitch is as far off that of the propeller as it is known."""
    rng = np.random.default_rng([SEED + 1, seed])
    pitch = known.propeller.pitch_ratio * (1.0 + float(rng.normal(0.0, known.propeller.pitch_std)))
    return known.model_copy(update={"propeller": known.propeller.model_copy(update={"pitch_ratio": pitch})})


def outcome(known: Vessel, sea: Sea, seed: int) -> dict[str, Any]:
    """Sail and identify one test; return the error of each number over its deviation, and the deviation."""
    ship = ship_of(known, sea, seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "underway.nc"
        truth = sail(ship.vessel, CAMPAIGN, path, tug=ship.tug, seed=seed)
        survey = run(
            path, known_of(known, seed), CAMPAIGN, structures=("FREE-LOG",), judge=False, rng=np.random.default_rng(1)
        )
    found, line = survey.fingerprint, {}
    true = _true(truth, ship, survey.signals.working_point.shaft_torque_nm)
    for quantity in (*found.parameters, *found.combinations, *found.physical):
        if quantity.name in true and np.isfinite(quantity.std):
            low, high = quantity.limits_95
            value = true[quantity.name]
            line[quantity.name] = {
                "z": (quantity.value - value) / quantity.std,
                "std": quantity.std / abs(value),
                # an end that is open is no number, and excludes nothing
                "held": not (value < low or value > high),
            }
    return {"seed": seed, "trustworthy": found.verdict.trustworthy, "p": _p(found), "numbers": line}


def _p(found: Fingerprint) -> float | None:
    p = found.quality.p_value
    return None if p is None else float(p)


def _true(truth: Truth, ship: Ship, shaft_torque_nm: float) -> Mapping[str, float]:
    """Return the truth by the names of a fingerprint; gains over the torque that the gauge shows."""
    named = dict(truth.normalised)
    a, b, e, tau_u = (named[name] for name in ("a", "b", "e", "tau_u"))
    scale = float(ship.known.sensors.shaft_torque.scale_nm_per_unit or 1.0) / float(
        ship.vessel.sensors.shaft_torque.scale_nm_per_unit or 1.0
    )
    moved = scale * truth.shaft_torque_nm / shaft_torque_nm
    return {
        **{name: named[name] for name in ("w", "t", "R", "b", "t_d", "omega_n", "zeta")},
        "K_i": moved * named["K_i"],
        "R exponent": e,
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "(e - a) / tau_u": (e - a) / tau_u,
        "b (2 - a) / tau_u": b * (2.0 - a) / tau_u,
        "(2 - a) / tau_u": (2.0 - a) / tau_u,
    }


def _outcome_or_refusal(known: Vessel, sea: Sea, seed: int) -> dict[str, Any]:
    try:
        return outcome(known, sea, seed)
    except ShaftprintError as error:
        return {"seed": seed, "refused": str(error)}


def outcomes_of(known: Vessel, sea: Sea, seeds: range, folder: Path) -> Iterator[dict[str, Any]]:
    """Give what each test gave, from the file where it stands there already."""
    for seed in seeds:
        path = folder / f"{sea.name.replace(' ', '_')}_{seed:03d}.json"
        yield kept(path, partial(_outcome_or_refusal, known, sea, seed))


def table(sea: Sea, outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return a row for each number, in Markdown."""
    fitted = [one for one in outcomes if "numbers" in one]
    trusted = sum(one["trustworthy"] for one in fitted)
    low = sum(one["p"] is not None and one["p"] < 0.05 for one in fitted)
    lines = [
        f"\n### {sea.name.capitalize()}\n",
        f"{len(fitted)} tests, {len(outcomes) - len(fitted)} refused, {trusted} trusted; p below 0.05 in {low}.\n",
        "| number | tests | stated deviation | rms z | mean z | 95 % interval holds the truth |",
        "|---|---|---|---|---|---|",
    ]
    held: list[bool] = []
    for name in (*LINE, *SHIP, *LOOP):
        rows = [one["numbers"][name] for one in fitted if name in one["numbers"]]
        if not rows:
            continue
        z = np.array([row["z"] for row in rows])
        inside = [row["held"] for row in rows]
        held += inside
        lines.append(
            f"| `{name}` | {len(rows)} | {100.0 * np.median([row['std'] for row in rows]):.2g} % | "
            f"{np.sqrt(np.mean(z**2)):.2f} | {np.mean(z):+.2f} | {100.0 * np.mean(inside):.0f} % |"
        )
    return "\n".join([*lines, f"| all | | | | | {100.0 * np.mean(held):.1f} % |"])


def main() -> None:
    """Sail and identify what is not there, and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--vessel", choices=SEAS, default="stan-tug-1205-underway", help="ship that sails")
    parser.add_argument("--seas", type=int, default=2, help="number of seas, the calmer first")
    parser.add_argument("--seeds", type=int, default=50, help="number of tests in each sea")
    parser.add_argument("--outcomes", type=Path, default=Path("build/underway"), help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {PAGE.name}")
    options = parser.parse_args()
    known, folder = load_vessel(options.vessel), options.outcomes / options.vessel
    folder.mkdir(parents=True, exist_ok=True)
    seas = SEAS[options.vessel][: options.seas]
    tables = [table(sea, list(outcomes_of(known, sea, range(options.seeds), folder))) for sea in seas]
    text = "\n".join(tables)
    print(text)
    if options.write:
        marks = (f"<!-- {options.vessel}: {end} -->\n" for end in ("begin", "end"))
        write_between_marks(PAGE, text, *marks)


if __name__ == "__main__":
    main()
