"""A controllable pitch through raw recordings: whether the truth is in its intervals, and what is rejected.

Every ship is drawn: governor, engine, inertias, what the vessel file of the research vessel states of its torque gauge
and of the feedback of its pitch with a standard deviation, and of the pitch lag, delay, highest rate, play, scale of
the set point and slope of the torque. Its recording of ten minutes is identified as a user would, with the vessel file
as it is. Beside it stands the same structure with a fixed pitch, whose torque does not answer the pitch: ``q = 0``.

``python -m benchmarks.pitch --seeds 50 --outcomes build/pitch --write`` sails what is not there yet, fits it, and
writes the table of ``docs/pitch.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np

from benchmarks.electric import interval_of
from benchmarks.kept_outcomes import kept
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from benchmarks.monte_carlo_tables import write_between_marks
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.cli._demo_truth import fingerprint_truth
from shaftprint.errors import ShaftprintError
from shaftprint.identify.likelihood import PRIOR_OF_G
from shaftprint.models import Structure
from shaftprint.signals import Signals
from shaftprint.survey import run
from shaftprint.tug import PitchActuation, Truth, Tug, like_stan_tug_1205, sail, steepened, torque_over_pitch
from shaftprint.tug.plant import PitchActuator
from shaftprint.vessel import load_vessel

VESSEL, CAMPAIGN = load_vessel("nifs-research-vessel"), load_campaign("pitch")
PITCH, FIXED = "GAUGE-PITCH", "FIXED-PITCH"
INPUT, STEP_S = "pitch_set_point", 0.002
SEED = 19
SLOPE_STD = 0.10
"""Relative standard deviation of the slope of the torque about that of the series."""
REJECTED_P = 0.01
"""Chance below which the program calls a structure rejected."""
PAGE = Path(__file__).parents[1] / "docs" / "pitch.md"
BEGIN, END = "<!-- pitch: begin -->\n", "<!-- pitch: end -->\n"


def fixed_pitch() -> Structure:
    """Return the structure of a line whose torque does not answer the pitch."""
    return replace(structure(PITCH).held_at(q=0.0), name=FIXED, title="the same with a fixed pitch")


def drawn_pitch(rng: np.random.Generator) -> PitchActuation:
    """Return a pitch as hydraulics of ships have it."""
    sensor = VESSEL.sensors.pitch
    powers = steepened(torque_over_pitch(VESSEL), VESSEL.propeller.pitch_ratio, float(rng.normal(1.0, SLOPE_STD)))
    return PitchActuation(
        lag_s=rng.uniform(0.4, 1.2),
        delay_s=rng.uniform(0.05, 0.4),
        rate_per_s=rng.uniform(0.09, 0.16),
        play=rng.uniform(0.0, 0.0003),
        set_point_scale=float(rng.normal(1.0, 0.03)),
        sensor_scale=float(rng.normal(1.0, 0.0 if sensor is None else sensor.scale_std)),
        torque_powers=powers,
    )


def ship(seed: int) -> Ship:
    """Return the ship of a seed."""
    rng = np.random.default_rng([SEED, seed])
    gauge = drawn_gauge(VESSEL, rng)
    proportional = rng.uniform(3.0, 6.0)
    tug = replace(
        like_stan_tug_1205(VESSEL),
        proportional_gain=proportional,
        integral_gain_per_s=proportional * rng.uniform(0.5, 0.9),
        governor_delay_s=rng.uniform(0.03, 0.1),
        natural_frequency_rad_s=rng.uniform(8.0, 14.0),
        damping_ratio=rng.uniform(0.45, 0.9),
        g=float(rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std)),
        set_point_latency_s=rng.uniform(0.03, 0.1),
        anti_windup_s=rng.uniform(0.3, 1.0),
        inertia_upstream_kg_m2=rng.normal(VESSEL.inertia_upstream_kg_m2, VESSEL.inertia_upstream_std_kg_m2),
        inertia_downstream_kg_m2=rng.normal(VESSEL.inertia_downstream_kg_m2, VESSEL.inertia_downstream_std_kg_m2),
        torque_zero_offset_nm=gauge.zero_nm,
        pitch=drawn_pitch(rng),
    )
    return replace(gauge, tug=tug)


def true_values(truth: Truth, signals: Signals, of: Ship) -> dict[str, float]:
    """Return the truth as the measured working point normalises it.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.
    """
    model, shown_nm = structure(PITCH), signals.working_point.shaft_torque_nm
    named = fingerprint_truth(truth, model, signals)
    seen = {p.name: named[p.name] for p in model.parameters}
    for parameter in model.parameters:
        if parameter.role is not None and parameter.role.over_torque:
            seen[parameter.name] *= of.scale
    for slope in ("k_q", "q"):
        seen[slope] *= 1.0 - of.scale * of.zero_nm / shown_nm
    seen["t_gauge"] = of.late_s
    seen["t_blade"] = blade_lateness_s(of.tug)
    seen |= {one.name: float(one.of(seen)) for one in model.combinations}  # type: ignore[arg-type]
    return seen | {"I_dn": named["I_dn"], "I_up": named["I_up"]}


def blade_lateness_s(tug: Tug) -> float:
    """Return the time by which the blades follow the piston at the lines of the test, by least squares of the phase."""
    leg = next(one for one in CAMPAIGN.multisines if one.input == INPUT)
    actuator = PitchActuator(tug, VESSEL, CAMPAIGN, start_s=0.0, step_s=STEP_S)
    motion = actuator.next(round(leg.stop_s / STEP_S))
    first, count = round(leg.settled_s / STEP_S), round(leg.length_of_period_s / STEP_S)
    piston, blades = (np.fft.rfft(one[::2][first : first + count]) for one in motion)
    lines = np.array(leg.harmonics)
    omega = 2.0 * np.pi * lines / leg.length_of_period_s
    weight = np.abs(piston[lines]) ** 2
    late = -np.angle(blades[lines] / piston[lines])
    return float((weight * omega) @ late / ((weight * omega) @ omega))


def outcome(seed: int) -> dict[str, object]:
    """Sail and fit the ship of a seed."""
    drawn = ship(seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(drawn.vessel, CAMPAIGN, path, tug=drawn.tug, seed=seed)
        begin = time.process_time()
        try:
            tested = (PITCH, fixed_pitch())
            survey = run(path, VESSEL, CAMPAIGN, structures=tested, judge=False, rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"seed": seed, "refused": str(error)}
    true, fingerprint = true_values(truth, survey.signals, drawn), survey.fingerprint
    numbers = [*fingerprint.parameters, *fingerprint.combinations, *fingerprint.physical]
    return {
        "seed": seed,
        "cpu_s": time.process_time() - begin,
        "trustworthy": fingerprint.verdict.trustworthy,
        "limited": max(truth.limited.values()),
        "numbers": {
            one.name: {"true": true[one.name], "value": one.value, "std": one.std, "interval": interval_of(one)}
            for one in numbers
            if one.name in true
        },
        "p": {fit.structure.name: fit.p_value for fit in survey.fits},
    }


def table(outcomes: Sequence[Mapping[str, object]]) -> str:
    """Return a row for each number, and how often each structure was rejected, in Markdown."""
    fitted = [one for one in outcomes if "refused" not in one]
    names = list(dict.fromkeys(name for one in fitted for name in one["numbers"]))  # type: ignore[attr-defined]
    rows, inside = [], []
    for name in names:
        numbers = [one["numbers"][name] for one in fitted if name in one["numbers"]]  # type: ignore[index,operator]
        covered = [one["interval"][0] <= one["true"] <= one["interval"][1] for one in numbers]
        inside += covered
        off = np.array([one["value"] - one["true"] for one in numbers])
        scale = np.array([abs(one["true"]) for one in numbers])
        stated = np.array([one["std"] for one in numbers], dtype=float)
        per_cent = f"{100.0 * np.median(stated / scale):.2g} %" if scale.min() > 0.0 else ""
        rows.append(
            f"| `{name}` | {len(numbers)} | {np.nanmedian(stated):.2g} | {per_cent} | {np.median(off / stated):+.2f} | "
            f"{100.0 * np.mean(covered):.0f} % |"
        )
    names_of = (PITCH, FIXED)
    rejected = {n: sum(one["p"][n] < REJECTED_P for one in fitted) for n in names_of}  # type: ignore[index]
    trusted = sum(bool(one["trustworthy"]) for one in fitted)
    return "\n".join(
        [
            f"{len(fitted)} recordings of ten minutes, {len(outcomes) - len(fitted)} refused, {trusted} trustworthy; "
            f"{np.median([one['cpu_s'] for one in fitted]):.1f} CPU s each. {PITCH} was rejected in {rejected[PITCH]}, "
            f"the same with a fixed pitch in {rejected[FIXED]} of them.",
            "",
            "| number | recordings | stated deviation | over the value | median error, deviations | covered |",
            "|---|---|---|---|---|---|",
            *rows,
            f"| all | | | | | {100.0 * np.mean(inside):.1f} % |",
        ]
    )


def main() -> None:
    """Sail and fit what is not there, and print the table of what is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50, help="number of recordings")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--outcomes", type=Path, default=Path("build/pitch"), help="folder of the outcomes")
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
        write_between_marks(PAGE, text, BEGIN, END)


if __name__ == "__main__":
    main()
