"""Elastic lines through raw recordings: whether the coupling is offered, and whether the truth lies in its intervals.

Every ship is drawn: governor, delays, inertias, what the vessel file states of gauge and coupling with a standard
deviation, and where its mode lies. It is tested twice: with a toothed wheel on the shaft and lines up to 25 Hz, and
with the pick-ups of the Stan Tug and the lines of the short check. Rigid ships are drawn as well; every other of them
has a vessel file that states a coupling.

``python -m benchmarks.elastic --seeds 50 --outcomes build/elastic --write`` sails what is not there yet, fits it, and
writes the table of ``docs/elastic.md``; an outcome is a small JSON file, so that a run goes on where it ended.
"""

import argparse
import json
import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from benchmarks.drawn_lines import REJECTED_P, covers, names_in, numbers_of, rows_of, seen_by_gauge
from benchmarks.kept_outcomes import kept
from benchmarks.limits import line_of
from benchmarks.monte_carlo_recordings import Ship, drawn_gauge
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import Campaign, Sine, load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify.likelihood._known import PRIOR_OF_G
from shaftprint.rehearsal._true_fingerprint import fingerprint_truth
from shaftprint.signals import Signals
from shaftprint.survey import Survey, run
from shaftprint.survey._survey import fingerprint_of
from shaftprint.torsion._coupling import line_coupling
from shaftprint.tug import Coupling, Truth, sail
from shaftprint.vessel import SpeedSensor, Vessel, load_vessel
from shaftprint.vessel._links import ShaftLink

ELASTIC, RIGID = "GAUGE-ELASTIC", "GAUGE-CLOSED"
SEED = 18
MODES_HZ = (4.0, 25.0)
DAMPING_RATIOS = (0.04, 0.1)
"""Of the mode; a relative damping of 0.5 to 1.25."""
STIFFNESS_STD, DAMPING_STD = 0.12, 0.25
"""What the vessel file states of its coupling, over the values."""
COUPLED = ("Elastic coupling CX45, primary", "Elastic coupling CX45, secondary")
SHORT = load_campaign("short")
HIGH_HZ = (4.4, 6.1, 7.3, 8.6, 11.2, 12.7, 14.2, 17.1, 18.6, 21.3, 23.4, 25.4)
"""Lines up to the highest mode, between the orders of engine (half and first: 9.9 and 19.7 Hz), shaft (5.2 Hz) and
blades (15.5 Hz)."""
SLOWEST_HZ = 0.05
"""Slower sines of the short check, four minutes of it, are left out."""
SETTLED_S, WINDOW_S, BETWEEN_S = 4.0, 16.0, 1.0
RATE_HZ = 1000.0
"""Of the logger: six samples for each tooth."""
PAGE = Path(__file__).parents[1] / "docs" / "elastic.md"
BEGIN, END = "<!-- elastic: begin -->\n", "<!-- elastic: end -->\n"
NUMBERS = ("tau_up", "tau_m", "tau_dn", "k_c", "d_c", "f_1", "I_up", "I_dn", "k", "d")


def up_to_the_mode() -> Campaign:
    """Return the short check from 0.06 Hz on, with lines of 16 s up to 25 Hz after it."""
    slow = [sine for sine in SHORT.sines if sine.frequency_hz < SLOWEST_HZ]
    kept_sines = [sine for sine in SHORT.sines if sine not in slow]
    earlier_s = kept_sines[0].start_s - slow[0].start_s
    sines = [
        sine.model_copy(update={name: getattr(sine, name) - earlier_s for name in ("start_s", "settled_s", "stop_s")})
        for sine in kept_sines
    ]
    for number, frequency_hz in enumerate(HIGH_HZ, start=1):
        begin_s = sines[-1].stop_s + BETWEEN_S
        settled_s = begin_s + SETTLED_S
        sines.append(
            Sine(
                name=f"H{number}",
                frequency_hz=frequency_hz,
                amplitude_v=0.6,
                start_s=begin_s,
                settled_s=settled_s,
                stop_s=settled_s + round(WINDOW_S * frequency_hz) / frequency_hz + 0.05,
            )
        )
    words = {"name": "Up to the mode", "duration_s": sines[-1].stop_s + BETWEEN_S, "sample_rate_hz": RATE_HZ}
    return SHORT.model_copy(update=words | {"sines": tuple(sines)})


def with_wheel(vessel: Vessel) -> Vessel:
    """Return a vessel with a wheel of 30 teeth on the propeller shaft in place of its strips, and a slower logger."""
    wheel = SpeedSensor(
        name="n_s",
        channel="PTM_30",
        shaft="propeller",
        wheel="30",
        unit="V",
        pulse_width_deg=6.0,
        jitter_us=50.0,
    )
    logger = vessel.logger.model_copy(update={"sample_rate_hz": RATE_HZ})  # type: ignore[union-attr]
    sensors = vessel.sensors.model_copy(update={"speed": (wheel,)})
    return vessel.model_copy(update={"sensors": sensors, "logger": logger})


TUG = load_vessel("stan-tug-1205")
TESTS = {"up to the mode": (with_wheel(TUG), up_to_the_mode()), "short": (TUG, SHORT)}


@dataclass(frozen=True, kw_only=True, slots=True)
class Drawn:
    """One ship: what it is, and what its vessel file states of the coupling."""

    ship: Ship
    """Line and gauge."""
    links: tuple[ShaftLink, ...]
    """The links of its vessel file."""
    mode_hz: float
    """Its mode [Hz]."""


def _links(stiffness_nm_rad: float, damping_ratio: float) -> tuple[ShaftLink, ...]:
    """Return the links of the tug with one elastic coupling, referred to the propeller shaft, and all else rigid."""
    scale = TUG.gearbox.ratio**2
    coupling = ShaftLink(
        between=COUPLED,
        stiffness_nm_rad=stiffness_nm_rad / scale,
        stiffness_std_nm_rad=STIFFNESS_STD * stiffness_nm_rad / scale,
        relative_damping=4.0 * np.pi * damping_ratio,
        relative_damping_std=4.0 * np.pi * damping_ratio * DAMPING_STD,
        source="assumed",
    )
    others = (link for link in TUG.links if link.between != COUPLED)
    return (coupling, *(ShaftLink(between=link.between, source="assumed") for link in others))


def drawn(vessel: Vessel, seed: int, *, elastic: bool) -> Drawn:
    """Return the ship of a seed, whose vessel file states its coupling as far off as it says."""
    rng = np.random.default_rng([SEED, seed, int(elastic)])
    gauge = drawn_gauge(vessel, rng)
    tug = replace(
        line_of(rng),
        torque_zero_offset_nm=gauge.zero_nm,
        inertia_downstream_kg_m2=rng.normal(vessel.inertia_downstream_kg_m2, vessel.inertia_downstream_std_kg_m2),
        g=rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std),
    )
    mode_hz, ratio = rng.uniform(*MODES_HZ), rng.uniform(*DAMPING_RATIOS)
    expected = line_coupling(vessel.model_copy(update={"links": _links(1e5, ratio)}))
    driven = rng.normal(expected.driven_kg_m2, expected.driven_std_kg_m2)  # type: ignore[union-attr]
    pair = 1.0 / (tug.inertia_upstream_kg_m2 - driven) + 1.0 / (tug.inertia_downstream_kg_m2 + driven)
    omega = 2.0 * np.pi * mode_hz
    stiffness, damping = omega**2 / pair, 2.0 * ratio * omega / pair
    stated = stiffness * (1.0 + STIFFNESS_STD * rng.standard_normal())
    links = _links(stated, ratio * (1.0 + DAMPING_STD * rng.standard_normal()))
    if elastic:
        coupling = Coupling(stiffness_nm_rad=stiffness, damping_nm_s_rad=damping, driven_kg_m2=driven)
        return Drawn(ship=replace(gauge, tug=replace(tug, coupling=coupling)), links=links, mode_hz=mode_hz)
    return Drawn(ship=replace(gauge, tug=tug), links=links if seed % 2 == 0 else (), mode_hz=mode_hz)


def true_values(truth: Truth, signals: Signals, of: Ship, name: str) -> dict[str, float]:
    """Return the truth as the measured working point normalises it, by the names of a structure."""
    model, shown_nm = structure(name), signals.working_point.shaft_torque_nm
    named = fingerprint_truth(truth, model, signals)
    seen = seen_by_gauge(named, model, of, shown_nm=shown_nm)
    return seen | {key: named[key] for key in ("k", "d") if key in named}


def judged(fingerprint: Fingerprint, true: Mapping[str, float]) -> dict[str, Any]:
    """Return each number whose truth is known, and whether it is trusted."""
    trusted = fingerprint.verdict.trusted
    return {name: one | {"trusted": name in trusted} for name, one in numbers_of(fingerprint, true).items()}


def tested(test: str, seed: int, *, elastic: bool) -> dict[str, Any]:
    """Sail and identify the ship of a seed in one of the tests, as a user would who knows of no coupling."""
    vessel, campaign = TESTS[test]
    of = drawn(vessel, seed, elastic=elastic)
    stated = vessel.model_copy(update={"links": of.links})
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "test.nc"
        truth = sail(of.ship.vessel, campaign, path, tug=of.ship.tug, seed=seed)
        begin = time.process_time()
        try:
            survey = run(path, stated, campaign, judge=False, rng=np.random.default_rng(1))
        except ShaftprintError as error:
            return {"refused": str(error)}
        cpu_s = time.process_time() - begin
    fingerprint = survey.fingerprint
    result: dict[str, Any] = {
        "mode_hz": of.mode_hz,
        "cpu_s": cpu_s,
        "p": survey.identification.p_value,
        "trustworthy": fingerprint.verdict.trustworthy,
        "offered": len(survey.fits) > 1,
        "first": bool(fingerprint.verdict.reasons) and fingerprint.verdict.reasons[0].kind == "elastic coupling",
        "suspects": [one.words for one in fingerprint.verdict.suspects],
        "sentences": list(fingerprint.verdict.sentences[:3]),
        "numbers": judged(fingerprint, true_values(truth, survey.signals, of.ship, RIGID)),
    }
    return result | ({"elastic": _elastic(survey, truth, of.ship)} if elastic and len(survey.fits) > 1 else {})


def _elastic(survey: Survey, truth: Truth, of: Ship) -> dict[str, Any]:
    """Return what the fit of the elastic line states."""
    fit = survey.fits[-1]
    fingerprint = fingerprint_of(fit, survey.measurement, survey.trial)
    return {
        "p": fit.p_value,
        "trustworthy": fingerprint.verdict.trustworthy,
        "numbers": judged(fingerprint, true_values(truth, survey.signals, of, ELASTIC)),
    }


PARTS: Mapping[str, tuple[str, bool]] = {
    "up to the mode": ("up to the mode", True),
    "rigid": ("up to the mode", False),
    "short": ("short", True),
}
"""What is sailed of every seed: which test, and whether the ship has a coupling."""


def outcome(part: str, seed: int, folder: Path) -> dict[str, Any]:
    """Return what one part gave for a seed; sailed and fitted where it is not there yet."""
    test, elastic = PARTS[part]
    path = folder / f"{part.replace(' ', '-')}-{seed:03d}.json"
    found = kept(path, partial(tested, test, seed, elastic=elastic))
    print(json.dumps({"part": part, "seed": seed} | found), flush=True)
    return found


def plain_words(found: Sequence[Mapping[str, Any]], *, at: str) -> str:
    """Return how often the rigid line was rejected or told better of, and whether what it trusts elsewhere is right."""
    left = [one for one in found if one["trustworthy"]]
    trusted = [number for one in left for number in one["numbers"].values() if number["trusted"]]
    right = [covers(number) for number in trusted]
    share = f", of whose trusted numbers {100.0 * np.mean(right):.1f} % held the truth" if right else ""
    wrong = sum(one["p"] < REJECTED_P for one in found)
    return (
        f"{at}: {RIGID} was rejected in {wrong} of {len(found)}, {ELASTIC} offered in "
        f"{sum(one['offered'] for one in found)}, as the first thing said in {sum(one['first'] for one in found)}; "
        f"{RIGID} was trusted in {len(left)}{share}. The speed pick-up was suspected in "
        f"{sum(any('pick-up' in words for words in one['suspects']) for one in found)}."
    )


def table(outcomes: Mapping[str, Sequence[Mapping[str, Any]]]) -> str:
    """Return how often the coupling was offered, and a row for each number of the elastic line, in Markdown."""
    of = {part: [one for one in found if "refused" not in one] for part, found in outcomes.items()}
    offered = [one["elastic"] for one in of["up to the mode"] if "elastic" in one]
    names = names_in(offered)
    order = sorted(names, key=lambda one: (one not in NUMBERS, names.index(one)))
    rigid = of["rigid"]
    spent = np.median([one["cpu_s"] for found in of.values() for one in found])
    return "\n".join(
        [
            f"Modes between {MODES_HZ[0]:g} and {MODES_HZ[1]:g} Hz; {spent:.1f} CPU s a test.",
            "",
            plain_words(of["up to the mode"], at="With a toothed wheel and lines up to 25 Hz"),
            "",
            *([plain_words(of["short"], at="With strips and lines up to 3.3 Hz"), ""] if of["short"] else []),
            f"{len(rigid)} rigid ships, with the wheel and lines up to 25 Hz: {ELASTIC} was offered in "
            f"{sum(one['offered'] for one in rigid)}, {RIGID} rejected in "
            f"{sum(one['p'] < REJECTED_P for one in rigid)}.",
            "",
            f"{ELASTIC} where it was offered, {sum(one['trustworthy'] for one in offered)} of {len(offered)} "
            "trustworthy:",
            "",
            *rows_of(offered, order),
        ]
    )


def main() -> None:
    """Sail and fit what is not there, and print the table of what is."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50, help="number of ships")
    parser.add_argument("--first", type=int, default=0, help="number of the first")
    parser.add_argument("--parts", nargs="+", choices=PARTS, default=list(PARTS), help="what is sailed")
    parser.add_argument("--outcomes", type=Path, default=Path("build/elastic"), help="folder of the outcomes")
    parser.add_argument("--write", action="store_true", help="put the table into its page")
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    seeds = range(options.first, options.first + options.seeds)
    outcomes: dict[str, list[dict[str, Any]]] = {part: [] for part in PARTS}
    for seed in seeds:
        for part in options.parts:
            outcomes[part].append(outcome(part, seed, options.outcomes))
    text = table(outcomes)
    print(text)
    if options.write:
        write_between_marks(PAGE, text, BEGIN, END)


if __name__ == "__main__":
    main()
