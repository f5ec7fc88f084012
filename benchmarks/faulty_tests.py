"""Faults of generator and governor: what the shipped test of twelve minutes makes of them. Raw recordings, Stan Tug.

A generator with a slow clock, a small amplitude and 12 bits must change nothing; a leg that is cut off must give a
result of its whole periods; a governor that is another at each speed must be refused, and the result of one speed
offered. Rows of the generator are identified with nothing known beforehand, those of the governor as ``shaftprint
identify`` does it, with what the vessel file knows. Run ``python benchmarks/faulty_tests.py --seeds 100 --outcomes
build/faulty --write``; a recording takes about six seconds of one core, and those that ``--outcomes`` holds are not
sailed again. ``--case`` runs one row alone.
"""

import argparse
import json
import math
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.faulty_tests_tables import Refusal, generator_table, governor_table
from benchmarks.leg_outcomes import NAME, Outcome, as_planned, outcome, true_values
from benchmarks.legs import put_out
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Requirements, Settings
from shaftprint.survey import Trial, fit, load_trial, priors_of, run
from shaftprint.survey._measurement import of_legs
from shaftprint.tug import Truth, Tug, sail

DOCUMENT = ROOT / "docs" / "planned-tests.md"
BEGIN, END = (
    "<!-- tables of benchmarks/faulty_tests.py: begin -->",
    "<!-- tables of benchmarks/faulty_tests.py: end -->",
)
# +/- 10 V in 12 bits, a hundred values a second.
TWELVE_BITS = {"generator_step_v": 20.0 / 2**12, "generator_cycle_s": 0.01}
PPM, AMPLITUDE = 50.0, 0.99
FEW = 20


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One fault."""

    name: str
    """What it is."""
    campaign: Callable[[Campaign], Campaign] = field(default=lambda campaign: campaign)
    """What the generator puts out and the recorder holds of what was asked."""
    tug: Tug = field(default_factory=Tug)
    """The ship."""
    most: int = 1000
    """Largest number of recordings."""


def leg_speeds(campaign: Campaign, tug: Tug) -> tuple[float, ...]:
    """Return the engine speeds of the legs over that of the working point, by the true line of the set point."""
    slope, intercept, offset = tug.set_point_slope_rpm_per_v, tug.set_point_intercept_rpm, tug.set_point_offset_v
    at_v = slope * (campaign.offset_v + offset) + intercept
    # the level of the upper leg is the offset of the shipped campaign
    working = campaign.offset_rpm or at_v
    shares = tuple((slope * (leg.level_v + offset) + intercept) / at_v for leg in campaign.multisines)
    return tuple(share * working / VESSEL_RPM for share in shares)


def exponent(difference: float, campaign: Campaign) -> float:
    """Return the power of the speed with which something differs so much between the two legs."""
    upper, lower = leg_speeds(campaign, Tug())
    return math.log1p(difference) / math.log(upper / lower)


def _cut_s(campaign: Campaign) -> float:
    """Return the middle of the whole periods of the second leg."""
    leg = campaign.multisines[1]
    return 0.5 * (leg.settled_s + leg.stop_s)


def recording_ends(campaign: Campaign) -> Campaign:
    """Return a campaign whose recording ends in the middle of the second leg."""
    return campaign.model_copy(update={"duration_s": _cut_s(campaign)})


def generator_stops(campaign: Campaign) -> Campaign:
    """Return what a generator puts out that stops in the middle of the second leg and goes back to the offset."""
    first, second = campaign.multisines
    stopped = second.model_copy(update={"stop_s": _cut_s(campaign)})
    return campaign.model_copy(update={"multisines": (first, stopped)})


def _off(campaign: Campaign) -> Campaign:
    return put_out(campaign, clock_ppm=PPM, amplitude=AMPLITUDE)


TRIAL = load_trial("stan-tug-1205", load_campaign("12min"))
VESSEL_RPM = TRIAL.vessel.working_point.engine_speed_rpm
GENERATOR: Mapping[str, Case] = {
    "ideal": Case(name="none"),
    "clock": Case(
        name="clock 50 ppm slow", campaign=lambda campaign: put_out(campaign, clock_ppm=PPM, amplitude=1.0)
    ),
    "amplitude": Case(
        name="amplitude 1 % small", campaign=lambda campaign: put_out(campaign, clock_ppm=0.0, amplitude=AMPLITUDE)
    ),
    "bits": Case(name="12 bits, 100 values a second", tug=Tug(**TWELVE_BITS)),
    "all": Case(name="all three", campaign=_off, tug=Tug(**TWELVE_BITS)),
    "ends": Case(name="recording ends in the middle of leg 2", campaign=recording_ends, most=FEW),
    "stops": Case(name="generator stops in the middle of leg 2", campaign=generator_stops, most=FEW),
}  # fmt: skip


def _gains(difference: float, most: int = 1000) -> Case:
    tug = Tug(governor_gain_exponent=exponent(difference, TRIAL.campaign))
    return Case(name=f"gains {100.0 * difference:.0f} % larger at the upper speed", tug=tug, most=most)


def _delay(difference: float, most: int = 1000) -> Case:
    tug = Tug(governor_delay_exponent=-exponent(difference, TRIAL.campaign))
    return Case(name=f"delay {100.0 * difference:.0f} % longer at the lower speed", tug=tug, most=most)


GOVERNOR: Mapping[str, Case] = {
    "same": Case(name="none"),
    "gains-20": _gains(0.2, FEW),
    "gains-10": _gains(0.1),
    "gains-5": _gains(0.05, FEW),
    "gains-2": _gains(0.02, FEW),
    "delay-20": _delay(0.2, FEW),
    "delay-10": _delay(0.1),
    "delay-5": _delay(0.05, FEW),
    "delay-2": _delay(0.02, FEW),
}


def refusal(case: Case, seed: int, folder: Path) -> Refusal:
    """Sail a test, identify it as the program does, and take the result of each speed that is offered."""
    path = folder / f"{seed}.nc"
    truth = sail(TRIAL.vessel, case.campaign(TRIAL.campaign), path, seed=seed, tug=case.tug)
    survey = run(path, TRIAL.vessel, TRIAL.campaign, judge=False)
    path.unlink()
    words = survey.fingerprint.verdict.reason
    offered = tuple(leg.name for leg in survey.measurement.legs if f"--leg {leg.name}" in words)
    (free,) = fit([structure(NAME)], survey.measurement, settings={NAME: Settings()}, rng=np.random.default_rng(1))
    return Refusal(
        seed=seed,
        p_value=survey.identification.p_value or 0.0,
        free_p_value=free.p_value or 0.0,
        trustworthy=survey.fingerprint.verdict.trustworthy,
        leg_p_values={one.name: one.fit.p_value or 0.0 for one in survey.legs_alone},
        offered=offered,
        errors={name: _of_one_speed(case.tug, truth, survey.measurement, name, TRIAL) for name in offered},
        words=words,
    )


def _of_one_speed(tug: Tug, truth: Truth, measurement: Any, name: str, trial: Trial) -> dict[str, float]:
    """Return errors over deviations of what ``identify --leg`` gives, against the governor at the mean speed."""
    alone = of_legs(measurement, [name])
    priors = priors_of(structure(NAME), trial.vessel, alone.signals)
    (found,) = fit([structure(NAME)], alone, settings={NAME: Settings(priors=priors)}, rng=np.random.default_rng(1))
    true = true_values(truth, alone.signals, as_planned(tug, trial.vessel))
    share = alone.signals.working_point.engine_speed_rev_s * 60.0 / truth.engine_speed_rpm
    gain, delay = share**tug.governor_gain_exponent, share**tug.governor_delay_exponent
    true |= {"K_p": gain * true["K_p"], "K_i": gain * true["K_i"], "t_d": delay * true["t_d"]}
    true |= {one.name: float(one.of(true)) for one in structure(NAME).combinations}
    return {one.name: (one.value - true[one.name]) / one.std for one in (*found.parameters, *found.combinations)}


def kept(
    case: Case, seeds: range, path: Path | None, make: Callable[[int, Path], Any], kind: type[Any]
) -> Iterator[Any]:
    """Give what each recording gave, from the file where it stands there already; without seeds all of the file."""
    lines = path.read_text(encoding="utf-8").splitlines() if path and path.exists() else []
    earlier = {one.seed: one for one in (kind(**json.loads(line)) for line in lines)}
    with tempfile.TemporaryDirectory() as folder:
        for seed in seeds[: case.most] or sorted(earlier):
            if seed not in earlier:
                earlier[seed] = make(seed, Path(folder))
                if path:
                    with path.open("a", encoding="utf-8") as file:
                        file.write(json.dumps(asdict(earlier[seed])) + "\n")
            yield earlier[seed]


def _outcome_of(case: Case) -> Callable[[int, Path], Outcome]:
    sailed, ship = case.campaign(TRIAL.campaign), as_planned(case.tug, TRIAL.vessel)
    return lambda seed, folder: outcome(TRIAL, sailed, seed, folder, ship=ship)


def _refusal_of(case: Case) -> Callable[[int, Path], Refusal]:
    return lambda seed, folder: refusal(case, seed, folder)


def main() -> None:
    """Sail and identify the chosen rows."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=4, help="recordings of each row; 0: those that are kept")
    parser.add_argument("--case", choices=[*GENERATOR, *GOVERNOR], action="append", help="some rows alone")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of recordings are kept")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    seeds = range(1, options.seeds + 1)
    results: dict[str, tuple[str, list[Any]]] = {}
    for key in options.case or [*GENERATOR, *GOVERNOR]:
        case, of_generator = (GENERATOR | GOVERNOR)[key], key in GENERATOR
        path = options.outcomes / f"{key}.jsonl" if options.outcomes else None
        make, kind = (_outcome_of(case), Outcome) if of_generator else (_refusal_of(case), Refusal)
        results[key] = (case.name, list(kept(case, seeds, path, make, kind)))
        print(f"{key}: {len(results[key][1])} recordings", file=sys.stderr, flush=True)
    text = "".join([
        generator_table([results[key] for key in GENERATOR if key in results]),
        governor_table([results[key] for key in GOVERNOR if key in results], rejected=Requirements().lowest_p_value),
    ])  # fmt: skip
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
