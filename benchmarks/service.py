"""What ordinary service tells of a simulated tug, and whether its intervals hold: the tables of docs/service.md.

Each seed is another ship, crew and weather: governor, delays, inertias, slope of the engine, strength and colour of the
disturbances, and habits at the lever are drawn. Its logs are written, read back, scanned and fitted as ``shaftprint
service`` does, the fit from numbers that are wrong by 3 %. Run ``python benchmarks/service.py --seeds 12 --hours 1
--outcomes FOLDER``; outcomes that the folder holds are not made again. With ``--write`` the table goes into the
document. An hour of service takes 7 s of a processor to sail and 3 s to scan and fit.
"""

import argparse
import json
import sys
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from shaftprint.arrays import FloatArray
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.service import ServiceDay, fit_service, scan
from shaftprint.service._fingerprint import STRUCTURE
from shaftprint.service._fit import fit_segments
from shaftprint.service._model import FREE, ServiceModel, service_model
from shaftprint.service._score import Score, noise_of, scores, simulated
from shaftprint.service._segment_file import read_segments
from shaftprint.service._ship_numbers import margin_numbers_of
from shaftprint.tug import Truth, Tug, sail_service
from shaftprint.tug.service._habits import Habits
from shaftprint.vessel import load_vessel
from shaftprint.vessel._vessel import Vessel

DOCUMENT = ROOT / "docs" / "service.md"
BEGIN, END = ("<!-- table of benchmarks/service.py: begin -->", "<!-- table of benchmarks/service.py: end -->")
VESSEL = "stan-tug-1205-service"
DIRECTIONS: Mapping[str, tuple[str, ...]] = {
    "a lower proportional gain": ("K_p",),
    "less torque for the same rack": ("K_p", "K_i"),
    "a longer delay": ("t_d",),
    "more inertia behind the gauge": ("tau_dn",),
}
"""Causes and the parameters that each moves, by the same share."""
# Numbers from which a fit begins are wrong by so much.
_OLD = 0.03
_PERCENT = 100.0


def drawn(seed: int, vessel: Vessel) -> Tug:
    """Return a tug in some weather."""
    rng = np.random.default_rng((seed, 5))

    def about(value: float, spread: float) -> float:
        return float(value * np.exp(spread * rng.standard_normal()))

    usual = Tug.stan_tug_1205()
    noise = usual.noise
    sizes = ("inflow_rms", "surge_rms", "combustion_rms", "hunting_rms", "demand_rms")
    noise = replace(noise, **{name: about(getattr(noise, name), 0.3) for name in sizes})
    return replace(
        usual,
        noise=replace(noise, hunting_hz=about(noise.hunting_hz, 0.1)),
        proportional_gain=about(usual.proportional_gain, 0.06),
        integral_gain_per_s=about(usual.integral_gain_per_s, 0.08),
        governor_delay_s=about(usual.governor_delay_s, 0.08),
        set_point_latency_s=about(usual.set_point_latency_s, 0.1),
        natural_frequency_rad_s=about(usual.natural_frequency_rad_s, 0.05),
        damping_ratio=about(usual.damping_ratio, 0.08),
        inertia_upstream_kg_m2=about(vessel.inertia_upstream_kg_m2, 0.02),
        inertia_downstream_kg_m2=about(vessel.inertia_downstream_kg_m2, 0.05),
        g=float(0.1 * rng.standard_normal()),
    )


def true_numbers(truth: Truth) -> dict[str, float]:
    """Return the true values of what service is asked for; set point and gauge are as the vessel file says."""
    return {name: truth.normalised.get(name, float(name == "c_set")) for name in FREE}


def sailed(seed: int, hours: float, folder: Path, habits: Habits | None = None) -> None:
    """Sail some hours of one ship, and keep in a folder what a scan of its logs finds, beside its truth.

    Of a run that was stopped, ships that are sailed are not sailed again.
    """
    if (folder / "truth.json").exists():
        return
    vessel = load_vessel(VESSEL)
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(dir=folder) as place:
        files, truth = sail_service(
            vessel, Path(place) / "logs", hours=hours, seed=seed, tug=drawn(seed, vessel), habits=habits
        )
        begin = time.process_time()
        found = scan(files, vessel)
        scanned_s = time.process_time() - begin
    if not found.refused:
        found.write(folder / "segments.csv")
    kept(
        folder / "truth.json",
        lambda: {
            **true_numbers(truth),
            "refused": found.refused,
            "scan_s": scanned_s,
        },
    )


def said_of(
    files: Sequence[Path], vessel: Vessel, place: Path, fingerprint: Fingerprint | None = None
) -> tuple[dict[str, Any], ServiceDay | None]:
    """Return what scan and fit say of logs, and their fit where it may be used; what lies between goes into a folder.

    Where it may not, ``refused`` says why.
    """
    said: dict[str, Any] = {}
    try:
        found = scan(files, vessel, fingerprint=fingerprint)
        said = {
            "found": {one.what: one.value for one in found.found},
            "used": len(found.used),
            "moves": len(found.segments),
        }
        if found.refused:
            return said | {"refused": found.refused}, None
        found.write(place / "segments.csv")
        day = fit_service(place / "segments.csv", vessel, fingerprint=fingerprint, now=datetime.now(UTC))
    except ShaftprintError as error:
        return said | {"refused": str(error).replace(str(place), "")}, None
    verdict = day.fingerprint.verdict
    return (said, day) if verdict.trustworthy else (said | {"refused": verdict.reason}, None)


def outcome(seed: int, hours: float, folder: Path, habits: Habits | None = None) -> dict[str, Any]:
    """Return what some hours of service of one ship tell, beside its truth; with a crew of its own, or one habits."""
    vessel = load_vessel(VESSEL)
    model = service_model(vessel)
    sailed(seed, hours, folder, habits)
    told = json.loads((folder / "truth.json").read_text(encoding="utf-8"))
    if told.get("refused"):
        return {"seed": seed, "hours": hours, "refused": told["refused"]}
    true = np.array([told[name] for name in FREE])
    segments, line, facts = read_segments(folder / "segments.csv")
    records = model.records([one for one in segments if not one.reason], line)
    rng = np.random.default_rng((seed, 6))
    begin = time.process_time()
    fit = fit_segments(records, model.at(true * np.exp(_OLD * rng.standard_normal(true.size) * _moved())))
    fitted_s = time.process_time() - begin
    begin = time.process_time()
    runs = [one for one in simulated(records, model, true) if not one.meets_limit]
    each = scores(runs, noise_of(runs))
    scored_s = time.process_time() - begin
    causes = {}
    for cause, names in DIRECTIONS.items():
        direction = np.array([value if name in names else 0.0 for name, value in zip(FREE, true, strict=True)])
        causes[cause] = along(each, direction)
    numbers = _numbers(fit.theta, model)
    return {
        "seed": seed,
        "hours": hours,
        "moves": len(segments),
        "used": int(fit.counts.sum()),
        "numbers": {
            **{
                name: (true_value, value, float(np.sqrt(slope @ fit.covariance @ slope)))
                for (name, (value, slope)), (true_value, _) in zip(
                    numbers.items(), _numbers(true, model).values(), strict=True
                )
            },
            # the propeller of the simulated ship takes what the vessel file says
            "K_Q": (1.0, float(str(facts["load"])), float(str(facts["load_std"]))),
        },
        "causes": causes,
        "cpu_s": {"scan": told.get("scan_s", np.nan), "fit": fitted_s, "score": scored_s},
    }


def along(each: Sequence[Score], direction: FloatArray) -> tuple[float, float]:
    """Return how far the likelihood goes along a direction in which all else is known, and its standard deviation.

    That is by the scatter of the segments alone.

    ``each``: what each segment tells, at an earlier fingerprint. ``direction``: change of the parameters for one unit
    of a cause, shape (free,).
    """
    slopes = np.array([direction @ one.slope for one in each])
    curvatures = np.array([direction @ one.information @ direction for one in each])
    size = float(slopes.sum() / curvatures.sum())
    left = slopes - size * curvatures
    return size, float(np.sqrt(np.sum(left**2)) / curvatures.sum())


def _numbers(theta: FloatArray, model: ServiceModel) -> dict[str, tuple[float, FloatArray]]:
    """Return numbers at parameters, and their slopes: the parameters, the sum of the delays and the gain margin."""
    structure = shipped_structure(STRUCTURE, set(FREE))
    held = {p.name: p.value for p in structure.parameters if p.name not in FREE} | {"k_q": 2.0}
    numbers = {name: (float(theta[k]), np.eye(len(FREE))[k]) for k, name in enumerate(FREE)}
    delays = np.array([float(name in ("t_d", "t_sp")) for name in FREE])
    numbers["t_d + t_sp"] = (float(delays @ theta), delays)
    margins = {one.name: (one.value, one.slope) for one in margin_numbers_of(structure, theta, held, FREE)}
    return numbers | {"gain margin": margins["gain margin"]}


def _moved() -> FloatArray:
    """Return which numbers an older fingerprint has wrong: not what the vessel file knows."""
    return np.array([float(name not in ("c_set", "t_gauge")) for name in FREE])


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return the table of all outcomes."""
    used = [one for one in outcomes if "refused" not in one]
    hours = {one["hours"] for one in used}
    text = [
        f"{len(used)} seeds of {' and '.join(f'{h:g}' for h in sorted(hours))} h, each another ship, crew and weather; "
        f"{len(outcomes) - len(used)} refused. {np.mean([one['used'] for one in used]):.0f} of "
        f"{np.mean([one['moves'] for one in used]):.0f} moves were used on average.",
        "",
        "| number | stated deviation, median | rms error | rms z | 95 % intervals that hold |",
        "|---|---|---|---|---|",
    ]
    every = []
    for name in used[0]["numbers"]:
        true, value, std = np.array([one["numbers"][name] for one in used]).T
        z = (value - true) / std
        if name in FREE:
            every.append(z)
        share = np.abs(true) if name not in ("g", "t_gauge") else np.ones(len(used))
        unit = " %" if name not in ("g", "t_gauge") else (" ms" if name == "t_gauge" else "")
        factor = {"g": 1.0, "t_gauge": 1e3}.get(name, _PERCENT)
        text.append(
            f"| {name if ' ' in name else f'`{name}`'} | {factor * np.median(std / share):.2g}{unit} | "
            f"{factor * np.sqrt(np.mean(((value - true) / share) ** 2)):.2g}{unit} | {np.sqrt(np.mean(z**2)):.2f} | "
            f"{np.count_nonzero(np.abs(z) < NORMAL_95)} of {z.size} |"
        )
    held = np.abs(np.array(every)) < NORMAL_95
    text.append(f"| all parameters | | | {np.sqrt(np.mean(np.square(every))):.2f} | {_PERCENT * held.mean():.1f} % |")
    text += ["", "| change, all else known | one standard deviation, median | rms z at no change |", "|---|---|---|"]
    for cause in DIRECTIONS:
        size, std = np.array([one["causes"][cause] for one in used]).T
        text.append(f"| {cause} | {_PERCENT * np.median(std):.2g} % | {np.sqrt(np.mean((size / std) ** 2)):.2f} |")
    cpu = {name: np.nanmedian([one["cpu_s"][name] / one["hours"] for one in used]) for name in ("scan", "fit", "score")}
    text += [
        "",
        f"CPU seconds an hour of service, median: scan {cpu['scan']:.1f}, fit from 3 % {cpu['fit']:.1f}, "
        f"score at known numbers {cpu['score']:.2f}.",
    ]
    return "\n".join(text)


def of_usual_crew(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return what a day tells where a third of the moves go anywhere, in a sentence."""
    used = [one for one in outcomes if "refused" not in one]
    z, known = [], []
    for name in ("K_p", "K_i", "t_d + t_sp", "tau_dn", "K_Q", "gain margin"):
        true, value, std = np.array([one["numbers"][name] for one in used]).T
        known.append(f"{name} {_PERCENT * np.median(std / np.abs(true)):.2g} %")
    for name in FREE:
        true, value, std = np.array([one["numbers"][name] for one in used]).T
        z.append((value - true) / std)
    held = np.mean(np.abs(z) < NORMAL_95)
    return (
        f"How much a day tells hangs on the crew. Of {len(used)} such days in which 30 % of the moves go anywhere "
        f"between 650 and 1650 rpm, the median knows {', '.join(known)}; {_PERCENT * held:.0f} % of the intervals hold."
    )


def add_options(parser: argparse.ArgumentParser, *, seeds: int) -> None:
    """Ask which ships are sailed for how long, where outcomes are kept, and whether the table is written."""
    parser.add_argument("--seeds", type=int, default=seeds, help="how many ships")
    parser.add_argument("--first", type=int, default=1, help="the first of them")
    parser.add_argument("--hours", type=float, default=1.0, help="hours of service of each")
    parser.add_argument("--outcomes", type=Path, required=True, help="folder in which outcomes are kept")
    parser.add_argument("--write", action="store_true", help="write the table into docs/service.md")


def main() -> None:
    """Make what is missing, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, seeds=12)
    parser.add_argument("--usual-crew", type=int, default=0, help="how many of the ships have a lively crew besides")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)

    def made(seed: int, habits: Habits | None) -> dict[str, Any]:
        folder = options.outcomes / (f"usual/{seed}-{options.hours:g}h" if habits else f"{seed}-{options.hours:g}h")
        folder.mkdir(parents=True, exist_ok=True)
        last = kept(folder / "outcome.json", lambda: outcome(seed, options.hours, folder, habits))
        print(json.dumps({name: last.get(name) for name in ("seed", "used", "refused", "cpu_s")}), flush=True)
        return last

    table = report([made(seed, None) for seed in range(options.first, options.first + options.seeds)])
    lively = [made(seed, Habits()) for seed in range(options.first, options.first + options.usual_crew)]
    if lively:
        table += f"\n\n{of_usual_crew(lively)}"
    print(table)
    if options.write:
        write_between_marks(DOCUMENT, table, BEGIN, END)


if __name__ == "__main__":
    main()
