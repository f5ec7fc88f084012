"""GAUGE-ECU from the log of a control unit's CAN bus: demand, torque, load and speed as messages.

The simulated Stan Tug 1205 sails the shipped campaign ``short``. Its control unit sends, every 20 ms with 15 % of
jitter and one in a hundred lost, the position of the pedal (SPN 91, 0.4 % a bit), the actual torque (SPN 513, 1 % a
bit) or the load at the speed (SPN 92, 1 %), and the engine speed (SPN 190, 0.125 rpm). The torque gauge is logged
beside it at 2000 Hz, the pick-ups in some of the cases. All noise and faults of the logger are in; in the cases "drawn"
governor, engine, inertias, gauge, latencies, bus and noise are drawn for each test. Run ``python benchmarks/can_log.py
--seeds 100 --write``, about 7 seconds a test of one core; ``--case`` runs one case alone, and tests that ``--outcomes
FOLDER`` holds are not sailed again.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks import monte_carlo_short
from benchmarks.message_log import Estimate, rows
from benchmarks.monte_carlo_short import Row, drawn_noise, rows_of, summary
from benchmarks.result_tables import write_between_marks
from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import ShaftprintError
from shaftprint.identify import Settings, identify, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.survey import Trial
from shaftprint.tug import Truth, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

DOCUMENT = ROOT / "docs" / "can-log.md"
BEGIN, END = "<!-- table of benchmarks/can_log.py: begin -->", "<!-- table of benchmarks/can_log.py: end -->"
ALONE = tuple(f"<!-- messages alone, of benchmarks/can_log.py: {end} -->" for end in ("begin", "end"))
SEED = 16
ECU, CAMPAIGN, SHIP = structure("GAUGE-ECU"), load_campaign("short"), load_vessel("stan-tug-1205-ecu")
CYCLE_S, JITTER, LOST = 0.02, 0.15, 0.01
# The pedal asks for 600 rpm at 0 % and for 1800 rpm at 100 %, by the line of the simulated tug.
RPM_PER_PERCENT, IDLE_RPM, RPM_PER_V, RPM_AT_ZERO_V = 12.0, 600.0, -250.97, -83.467
PEDAL = {
    "channel": "AcceleratorPedalPosition1",
    "unit": "%",
    "v_per_unit": RPM_PER_PERCENT / RPM_PER_V,
    "v_at_zero": (IDLE_RPM - RPM_AT_ZERO_V) / RPM_PER_V,
    "message_latency_s": 0.01,
}
SPEED: dict[str, Any] = {"name": "n_e", "channel": "EngineSpeed", "shaft": "engine", "unit": "rpm", "latency_s": 0.01}
# A ship test of which messages alone tell: the demand in rpm, 0.125 rpm a bit, and torque of a telemetry whose values
# are up to a period old, or means over it; senders whose clocks are this far apart.
TORQUE_CYCLE_S, APART, DEMAND_STEP_RPM = 0.01, 50e-6, 0.125
DEMAND: dict[str, Any] = {
    "channel": "EngineDesiredOperatingSpeed",
    "unit": "rpm",
    "v_per_unit": 1.0 / RPM_PER_V,
    "v_at_zero": -RPM_AT_ZERO_V / RPM_PER_V,
    "message_latency_s": 0.01,
}
# Working point of the truth, by which its numbers are normalised.
TRUE_SPEED_REV_S, TRUE_TORQUE_NM = 1183.8 / 60.0, 1725.0


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One way to log the line."""

    name: str
    """What it is."""
    speed: bool = False
    """Whether the speed comes from messages too, and there is no pick-up."""
    rack: Mapping[str, Any] = field(default_factory=dict)
    """What the vessel file says of the rack in another way."""
    drawn: bool = False
    """Whether truth and nuisances are drawn."""
    most: int = 1000
    """Largest number of tests that are sailed."""


CASES: Mapping[str, Case] = {
    "beside": Case(name="Pedal and torque from messages, beside pick-ups and torque gauge"),
    "only": Case(name="Pedal, torque and speed from messages, beside the torque gauge alone", speed=True),
    "load": Case(
        name="The same with percent load in place of percent torque",
        speed=True,
        rack={"channel": "EnginePercentLoadAtCurrentSpeed", "shows": "load"},
        most=40,
    ),
    "fuel": Case(
        name="The same with the fuel rate",
        speed=True,
        rack={"channel": "EngineFuelRate", "unit": "L/h", "rated_l_h": 58.0},
        most=40,
    ),
    "drawn": Case(name="Pedal, torque and speed from messages, truth and nuisances drawn", speed=True, drawn=True),
}
ALL = "all"


def _all_messages() -> Vessel:
    """Return what the vessel file says of a ship of which messages alone tell."""
    content = load_vessel("stan-tug-1205").model_dump()
    gauge = content["sensors"]["shaft_torque"]
    gauge |= {"latency_s": gauge["latency_s"] + 0.5 * TORQUE_CYCLE_S, "latency_std_s": None}
    content["sensors"] |= {"set_point": DEMAND, "speed": [SPEED]}
    return Vessel.model_validate(content)


ALL_MESSAGES = _all_messages()


@dataclass(frozen=True, kw_only=True, slots=True)
class Ship:
    """What sails, and what is known of it."""

    known: Vessel
    """The vessel file."""
    true: Vessel
    """The same with the gauge and the latencies that it really has."""
    tug: Tug
    """The truth."""
    scale: float = 1.0
    """What the gauge shows over what it should."""

    @property
    def late_s(self) -> tuple[float, float]:
        """By how much the messages with set point and speed are later than known [s]."""
        known, true = self.known.sensors, self.true.sensors
        set_point = true.set_point.message_latency_s - known.set_point.message_latency_s
        return set_point, true.speed[0].latency_s - known.speed[0].latency_s


def known_vessel(case: Case) -> Vessel:
    """Return what the vessel file says."""
    content = SHIP.model_dump()
    content["sensors"]["set_point"] = PEDAL
    content["sensors"]["rack"] |= {"cycle_s": CYCLE_S, **case.rack}
    if case.speed:
        content["sensors"]["speed"] = [SPEED]
    return Vessel.model_validate(content)


def ship_of(case: Case, seed: int) -> Ship:
    """Return the ship of a test: the reference truth, or one that is drawn."""
    known = known_vessel(case)
    tug = Tug(speed_cycle_s=CYCLE_S, set_point_cycle_s=CYCLE_S, message_jitter=JITTER, messages_lost=LOST)
    if not case.drawn:
        return Ship(known=known, true=known, tug=tug)
    rng, gauge = np.random.default_rng([SEED, seed]), known.sensors.shaft_torque
    scale = 1.0 + float(rng.normal(0.0, gauge.scale_std))
    content = known.model_dump()
    content["sensors"]["shaft_torque"] |= {
        "scale_nm_per_unit": float(gauge.scale_nm_per_unit or 1.0) / scale,
        "latency_s": _late(rng, gauge.latency_s, gauge.latency_std or 0.0),
    }
    content["sensors"]["set_point"] |= {"message_latency_s": _late(rng, 0.01, 0.003)}
    if case.speed:
        content["sensors"]["speed"] = [SPEED | {"latency_s": _late(rng, 0.01, 0.002)}]
    rack = content["sensors"]["rack"]
    true = replace(
        tug,
        proportional_gain=float(rng.uniform(4.5, 6.5)),
        integral_gain_per_s=float(rng.uniform(3.0, 5.0)),
        governor_delay_s=float(rng.uniform(0.05, 0.08)),
        natural_frequency_rad_s=float(rng.uniform(9.5, 12.5)),
        damping_ratio=float(rng.uniform(0.45, 0.65)),
        set_point_latency_s=float(rng.uniform(0.03, 0.08)),
        g=float(rng.normal(0.0, 0.1)),
        v=float(rng.uniform(0.9, 1.1)),
        inertia_upstream_kg_m2=float(rng.normal(known.inertia_upstream_kg_m2, known.inertia_upstream_std_kg_m2)),
        inertia_downstream_kg_m2=float(rng.normal(known.inertia_downstream_kg_m2, known.inertia_downstream_std_kg_m2)),
        torque_zero_offset_nm=float(rng.normal(0.0, gauge.zero_std_nm or 0.0)),
        rack_latency_s=_late(rng, rack["latency_s"], rack["latency_std_s"]),
        message_jitter=float(rng.uniform(0.02, 0.25)),
        messages_lost=float(rng.uniform(0.0, 0.03)),
        noise=replace(drawn_noise(rng), surge_rms=0.0),
    )
    return Ship(known=known, true=Vessel.model_validate(content), tug=true, scale=scale)


def all_messages(seed: int) -> dict[str, Any]:
    """Sail and identify a ship of which messages alone tell, by all steps of the program; return its numbers."""
    ship = drawn_in_messages(seed)
    trial = Trial(vessel=ALL_MESSAGES, campaign=CAMPAIGN)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.nc"
        truth = sail(ship.vessel, CAMPAIGN, path, tug=ship.tug, seed=seed)
        found = monte_carlo_short.identified(path, trial, seed)
    true = monte_carlo_short.true_values(truth, ship, found)
    late_speed_s = ship.vessel.sensors.speed[0].latency_s - SPEED["latency_s"]
    late_set_point_s = ship.vessel.sensors.set_point.message_latency_s - DEMAND["message_latency_s"]
    true["t_gauge"] -= late_speed_s
    for name in ("t_sp", "t_d + t_sp"):
        true[name] -= late_set_point_s
    named = {name: asdict(row) for name, row in rows_of(found, true).items()}
    return {
        "seed": seed,
        "rows": named,
        "trustworthy": found.verdict.trustworthy,
        "reasons": [one.sentence for one in found.verdict.reasons],
    }


def drawn_in_messages(seed: int) -> monte_carlo_short.Ship:
    """Return the ship of a seed, of which messages tell: how old their values are is drawn too."""
    rng, ship = np.random.default_rng([SEED, seed, 1]), monte_carlo_short.drawn_ship(seed, ALL_MESSAGES)
    age = 1.0 / np.sqrt(12.0)
    stated = ALL_MESSAGES.sensors.shaft_torque
    latency_s = _late(rng, stated.latency_s, np.hypot(stated.latency_std, TORQUE_CYCLE_S * age))
    content = ship.vessel.model_dump()
    content["sensors"]["shaft_torque"] |= {"latency_s": latency_s}
    content["sensors"]["speed"] = [SPEED | {"latency_s": _late(rng, SPEED["latency_s"], CYCLE_S * age)}]
    content["sensors"]["set_point"] |= {"message_latency_s": _late(rng, DEMAND["message_latency_s"], CYCLE_S * age)}
    fast, slow = 1.0 + 0.5 * APART, 1.0 - 0.5 * APART
    tug = replace(
        ship.tug,
        speed_cycle_s=CYCLE_S * slow,
        set_point_cycle_s=CYCLE_S * slow,
        torque_cycle_s=TORQUE_CYCLE_S * fast,
        torque_is_mean=bool(rng.random() < 0.5),
        set_point_resolution=DEMAND_STEP_RPM,
        message_jitter=JITTER,
        messages_lost=LOST,
        messages_wait=bool(rng.random() < 0.5),
    )
    return replace(ship, tug=tug, vessel=Vessel.model_validate(content), late_s=latency_s - stated.latency_s)


def _late(rng: np.random.Generator, stated_s: float, std_s: float) -> float:
    return max(0.0, float(rng.normal(stated_s, std_s)))


def true_values(ship: Ship, truth: Truth, signals: Signals) -> dict[str, float]:
    """Return the truth in the sense in which it is found: over the working point of the recording, as the gauge shows.

    A speed that is late by more than known makes the set point's latency longer and that of the rack shorter.
    """
    values = dict(truth.normalised)
    rack = signals.channels["X"].reference / values["X_0"]
    speed = signals.working_point.engine_speed_rev_s / TRUE_SPEED_REV_S
    torque = signals.working_point.shaft_torque_nm / (TRUE_TORQUE_NM * ship.scale)
    late_set_point_s, late_speed_s = ship.late_s
    values["K_p"] *= speed / rack
    values["K_i"] *= speed / rack
    values["v"] *= rack / torque
    values["g"] *= speed / torque
    for name in ("tau_dn", "tau_up"):
        values[name] *= speed / torque
    values["k_q"] *= 1.0 - ship.tug.torque_zero_offset_nm / (TRUE_TORQUE_NM * torque)
    values["t_sp"] += late_speed_s - late_set_point_s
    values["t_rack"] -= late_speed_s
    return values


def outcome(case: Case, seed: int) -> dict[str, Any]:
    """Sail and identify one test; return its estimates beside their truth and its p-value."""
    ship = ship_of(case, seed)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "log.nc"
        truth = sail(ship.true, CAMPAIGN, path, tug=ship.tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, ship.known, CAMPAIGN)
    response = estimate_response(signals, CAMPAIGN)
    known = Settings(priors=priors_from_vessel(ECU, ship.known, signals.working_point))
    found = identify(ECU, response, rng=np.random.default_rng(seed), settings=known)
    true = true_values(ship, truth, signals)
    estimates = [
        Estimate(
            name=one.name,
            error=one.value - true[one.name],
            std=one.std,
            truth=true[one.name],
            is_held=one.limits_95[0] <= true[one.name] <= one.limits_95[1],
        )
        for one in found.parameters
        if one.name in true
    ]
    return {"seed": seed, "p_value": found.p_value, "estimates": [asdict(one) for one in estimates]}


def outcomes_of(key: str, seeds: range, *, folder: Path | None) -> Iterator[dict[str, Any]]:
    """Give what each test of a case gave, from the file where it stands there already."""
    kept = folder / f"{key}.jsonl" if folder else None
    lines = kept.read_text(encoding="utf-8").splitlines() if kept and kept.exists() else []
    earlier = {one["seed"]: one for one in map(json.loads, lines)}
    for seed in seeds:
        if seed in earlier:
            yield earlier[seed]
            continue
        try:
            one = all_messages(seed) if key == ALL else outcome(CASES[key], seed)
        except ShaftprintError as error:
            one = {"seed": seed, "refused": str(error)}
        if kept:
            with kept.open("a", encoding="utf-8") as file:
                file.write(json.dumps(one) + "\n")
        yield one


def table(case: Case, outcomes: list[dict[str, Any]]) -> str:
    """Return the table of a case in Markdown, errors over stated deviations in place of percent where it is drawn."""
    held = [one for one in outcomes if "estimates" in one]
    tests = [[Estimate(**estimate) for estimate in one["estimates"]] for one in held]
    text = f"\n### {case.name}\n\n{len(held)} tests"
    refused = [f"{one['seed']} ({one['refused']})" for one in outcomes if "refused" in one]
    text += f"; refused: {'; '.join(refused)}.\n\n" if refused else ".\n\n"
    if case.drawn:
        tests = [[replace(one, error=one.error / one.std, std=1.0, truth=0.0) for one in test] for test in tests]
        lines = [_drawn_row(row) for row in rows(tests)]
    else:
        lines = list(rows(tests))
    p_values = np.array([one["p_value"] for one in held])
    return text + "\n".join(lines) + f"\n\np-values below 0.05: {100.0 * np.mean(p_values < 0.05):.0f} %.\n"


def table_of_all(outcomes: list[dict[str, Any]]) -> str:
    """Return the table of the ships of which messages alone tell, in Markdown."""
    tests = [{name: Row(**row) for name, row in one.get("rows", {}).items()} for one in outcomes]
    trusted = sum(bool(one.get("trustworthy")) for one in outcomes)
    return (
        "\n### Torque, speed and demand from messages alone, ships drawn\n\n"
        + summary(tests, "tests of messages alone")
        + f"\nTrustworthy: {trusted} of {len(outcomes)}.\n"
    )


def _drawn_row(row: str) -> str:
    """Leave out of a row what means nothing where every test has another truth."""
    cells = row.split("|")
    return "|".join([*cells[:2], *cells[3:5], *cells[6:]]).replace("scatter [%]", "scatter [% of the stated]")


def main() -> None:
    """Sail and identify the chosen cases."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--seeds", type=int, default=4, help="tests of each case")
    parser.add_argument("--case", choices=[*CASES, ALL], action="append", help="some cases alone")
    parser.add_argument("--outcomes", type=Path, help="folder in which outcomes of tests are kept")
    parser.add_argument("--write", action="store_true", help=f"put the tables into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    if options.outcomes:
        options.outcomes.mkdir(parents=True, exist_ok=True)
    text, alone = "", ""
    for key in options.case or [*CASES, ALL]:
        most = options.seeds if key == ALL else CASES[key].most
        outcomes = list(outcomes_of(key, range(1, min(options.seeds, most) + 1), folder=options.outcomes))
        of_case = table_of_all(outcomes) if key == ALL else table(CASES[key], outcomes)
        print(of_case, flush=True)
        text, alone = (text, of_case) if key == ALL else (text + of_case, alone)
    if options.write and text:
        write_between_marks(DOCUMENT, text, BEGIN, END)
    if options.write and alone:
        write_between_marks(DOCUMENT, alone, *ALONE)


if __name__ == "__main__":
    main()
