"""Does the program report short tests rightly? Quarter-hour tests of drawn ships, judged by what the fingerprint says.

Every test has a truth of its own: inertias, gains, delays and lag of the governor are drawn widely; the upstream
inertia, the scale, zero and latency of the gauge and ``g`` from the deviations that the vessel file states. The inflow
wanders by 1 to 3 % with a correlation time of 10 to 100 s, all other noise is halved to doubled, and the ship surges
in half of the tests. The recording goes through the steps of ``shaftprint identify``, and every number of the
fingerprint is held against the truth in the sense in which it is reported: normalised values at the mean load of the
ship, as the gauge shows it. Run ``python benchmarks/monte_carlo_short.py --tests 200 --write``; a test takes about six
seconds of one core.
"""

import argparse
import json
import sys
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.monte_carlo_tables import table
from benchmarks.result_tables import write_between_marks
from shaftprint.catalogue import structure
from shaftprint.distributions import NORMAL_95
from shaftprint.errors import ShaftprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate, Settings
from shaftprint.identify.likelihood._known import PRIOR_OF_G
from shaftprint.models import margins
from shaftprint.survey import Trial, fit, load_trial, measure, priors_of
from shaftprint.survey._survey import fingerprint_of
from shaftprint.tug import Noise, Truth, Tug, normalised_truth, sail
from shaftprint.vessel import Vessel

DOCUMENT = ROOT / "docs" / "monte-carlo.md"
BEGIN = "<!-- table of benchmarks/monte_carlo_short.py: begin -->"
END = "<!-- table of benchmarks/monte_carlo_short.py: end -->"
NAME = "GAUGE-CLOSED"
SEED = 33
# A ship whose line hunts is not tested; its governor is set first.
LEAST_GAIN_MARGIN = 1.3
# What each test draws about the reference truth: range of a factor.
FACTORS: Mapping[str, tuple[float, float]] = {
    "inertia_downstream_kg_m2": (0.8, 1.25),
    "proportional_gain": (0.7, 1.3),
    "integral_gain_per_s": (0.6, 1.5),
    "governor_delay_s": (0.6, 1.4),
    "set_point_latency_s": (0.5, 1.6),
    "natural_frequency_rad_s": (0.85, 1.3),
    "damping_ratio": (0.85, 1.5),
}
INFLOW_RMS, INFLOW_TIME_S = (0.01, 0.03), (10.0, 100.0)
NOISE_FACTOR, SURGE_HZ = (0.5, 2.0), (0.05, 0.2)
KEPT_NOISE = ("inflow_rms", "surge_rms")
TRUSTED_OUTSIDE = 0.06


@dataclass(frozen=True, kw_only=True, slots=True)
class Ship:
    """A ship that agrees with the vessel file to what that states."""

    tug: Tug
    """The line."""
    vessel: Vessel
    """What its gauge really does."""
    scale: float
    """Torque that the gauge shows over the true one."""
    late_s: float
    """Latency of the telemetry beyond that in the vessel file [s]."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Row:
    """One number of one test."""

    truth: float
    """True value in the sense in which the number is reported."""
    value: float
    """Reported value."""
    std: float
    """Reported standard deviation."""
    lower: float
    """Lower end of the 95 % interval; minus infinity where the data set none."""
    upper: float
    """Upper end, alike."""
    trusted: bool
    """Whether the verdict names the number among those that may be used."""

    @property
    def inside(self) -> bool:
        """Whether the interval holds the truth."""
        return self.lower <= self.truth <= self.upper


def drawn_ship(seed: int, vessel: Vessel) -> Ship:
    """Return the ship of a seed, with a governor that does not hunt."""
    rng = np.random.default_rng([SEED, seed])
    gauge = vessel.sensors.shaft_torque
    scale = 1.0 + float(rng.normal(0.0, gauge.scale_std_fraction or 0.0))
    latency_s = max(0.0, float(rng.normal(gauge.latency_s, gauge.latency_std_s or 0.0)))
    true = gauge.model_copy(update={"scale_nm_per_unit": gauge.scale_nm_per_unit / scale, "latency_s": latency_s})
    sensors = vessel.sensors.model_copy(update={"shaft_torque": true})
    zero_nm = float(rng.normal(0.0, gauge.zero_std_nm or 0.0))
    inertia = float(rng.normal(vessel.inertia_upstream_kg_m2, vessel.inertia_upstream_std_kg_m2))
    noise = drawn_noise(rng)
    while True:
        tug = replace(_drawn_line(rng, vessel), inertia_upstream_kg_m2=inertia, noise=noise)
        if gain_margin(tug, vessel) >= LEAST_GAIN_MARGIN:
            break
    return Ship(
        tug=replace(tug, torque_zero_offset_nm=zero_nm),
        vessel=vessel.model_copy(update={"sensors": sensors}),
        scale=scale,
        late_s=latency_s - gauge.latency_s,
    )


def _drawn_line(rng: np.random.Generator, vessel: Vessel) -> Tug:
    reference = replace(Tug(), inertia_downstream_kg_m2=vessel.inertia_downstream_kg_m2)
    drawn = {name: getattr(reference, name) * between(rng, *ends) for name, ends in FACTORS.items()}
    return replace(reference, **drawn, g=float(rng.normal(PRIOR_OF_G.mean, PRIOR_OF_G.std)))


def drawn_noise(rng: np.random.Generator) -> Noise:
    """Return a wander of the load, a surge in half of the tests, and all other noise halved to doubled."""
    factor = between(rng, *NOISE_FACTOR)
    surges = rng.random() < 0.5
    noise = Noise().scaled(factor, but=KEPT_NOISE)
    return replace(
        noise,
        inflow_rms=float(rng.uniform(*INFLOW_RMS)),
        inflow_corner_hz=1.0 / (2.0 * np.pi * between(rng, *INFLOW_TIME_S)),
        surge_rms=factor * noise.surge_rms if surges else 0.0,
        surge_hz=between(rng, *SURGE_HZ),
    )


def between(rng: np.random.Generator, low: float, high: float) -> float:
    """Draw from a range, each ratio being as likely."""
    return float(np.exp(rng.uniform(np.log(low), np.log(high))))


def gain_margin(tug: Tug, vessel: Vessel) -> float:
    """Return the gain margin of a true line, at most that against too little gain; 0 where it hunts."""
    closed = structure(NAME)
    found = margins(closed, closed.vector(_named(normalised_truth(tug, vessel))))
    return found.gain_margin if found.stable else 0.0


def _named(normalised: Mapping[str, float]) -> dict[str, float]:
    """Return a normalised truth by the names of the structure."""
    names = structure(NAME).names
    return {name: value for name, value in normalised.items() if name in names}


def true_values(truth: Truth, ship: Ship, found: Fingerprint) -> dict[str, float]:
    """Return the truth of every number of a fingerprint, in the sense in which it is reported.

    Deviations of the torque are shown ``scale`` times as large and divided by the shown mean, in which the zero is.
    """
    zero_nm = truth.physical["torque_zero_offset_nm"]
    without_zero = ship.scale * truth.shaft_torque_nm
    shown = without_zero + zero_nm
    share = without_zero / shown
    slope = found.quantity("set-point slope").value
    known = _named(truth.normalised)
    known |= {name: share * known[name] for name in ("K_p", "K_i", "tau_dn", "tau_up", "g", "k_q")}
    line = slope * found.quantity("set-point scale").value
    known |= {"c_set": truth.set_point_slope_rpm_per_v / line, "t_gauge": ship.late_s}
    closed = structure(NAME)
    loop = margins(closed, closed.vector(known))
    return (
        known
        | {c.name: float(c.of(known)) for c in closed.combinations}  # type: ignore[arg-type]
        | {
            "gain margin": loop.gain_margin,
            "phase margin": float(np.degrees(loop.phase_margin_rad)),
            "delay margin": loop.delay_margin_s,
            "n_0": truth.engine_speed_rpm,
            "M_s0": shown,
            "set-point slope": truth.set_point_slope_rpm_per_v,
            "set-point intercept": truth.set_point_intercept_rpm,
            "set-point scale": truth.set_point_slope_rpm_per_v / slope,
            "gauge zero share": 100.0 * zero_nm / without_zero,
        }
        | _true_physical(truth, ship.vessel)
        | _true_strips(truth, found)
    )


def _true_physical(truth: Truth, vessel: Vessel) -> dict[str, float]:
    normalised, shaft_rev_s = truth.normalised, truth.engine_speed_rpm / 60.0 / vessel.gearbox.ratio
    action = normalised["v"] * truth.shaft_torque_nm / truth.engine_speed_rpm
    size = vessel.water_density_kg_m3 * shaft_rev_s**2 * vessel.propeller.diameter_m**5
    return {
        "I_up": truth.physical["inertia_upstream_kg_m2"],
        "I_dn": truth.physical["inertia_downstream_kg_m2"],
        "governor proportional action": action * normalised["K_p"],
        "governor integral action": action * normalised["K_i"],
        "K_Q": truth.shaft_torque_nm * vessel.propeller.relative_rotative_efficiency / size,
    }


def _true_strips(truth: Truth, found: Fingerprint) -> dict[str, float]:
    """Return the true angles, begun at the strip at which the program began."""
    values = {}
    for strips in truth.strips:
        names = [q.name for q in found.calibration if q.name.startswith(f"{strips.channel} strip ")]
        if len(names) != len(strips.angle_deg):
            continue
        shown = np.array([found.quantity(name).value for name in names])
        turned = [np.roll(strips.angle_deg, turn) for turn in range(len(names))]
        nearest = min(turned, key=lambda angles: float(np.sum((angles - shown) ** 2)))
        values |= dict(zip(names, nearest.tolist(), strict=True))
    return values


def tested(seed: int, trial: Trial) -> dict[str, Row]:
    """Sail, identify and judge the ship of a seed; empty where the program refuses."""
    ship = drawn_ship(seed, trial.vessel)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "recording.h5"
        truth = sail(ship.vessel, trial.campaign, path, seed=seed, tug=ship.tug)
        try:
            found = identified(path, trial, seed)
        except ShaftprintError as error:
            print(f"seed {seed}: {error}", file=sys.stderr)
            return {}
    return rows_of(found, true_values(truth, ship, found))


def rows_of(found: Fingerprint, true: Mapping[str, float]) -> dict[str, Row]:
    """Return every number of a fingerprint beside its truth."""
    trusted = set(found.verdict.trusted)
    numbers = (*_numbers(found), found.conditions.engine_speed, found.conditions.shaft_torque)
    return {q.name: _row(q, true[q.name], trusted=q.name in trusted) for q in numbers}


def identified(path: Path, trial: Trial, seed: int, name: str = NAME) -> Fingerprint:
    """Return what ``shaftprint identify --structure NAME`` writes for a recording."""
    chosen = structure(name)
    measurement = measure(path, trial, mode="shaftprint")
    settings = Settings(priors=priors_of(chosen, trial.vessel, measurement.signals))
    fits = fit([chosen], measurement, settings={name: settings}, rng=np.random.default_rng(seed))
    return fingerprint_of(fits[0], measurement, trial)


def _numbers(found: Fingerprint) -> Iterator[Estimate]:
    yield from (*found.parameters, *found.combinations, *found.physical, *found.margins, *found.calibration)


def _row(quantity: Estimate, truth: float, *, trusted: bool) -> Row:
    if quantity.interval_95 is None:
        lower, upper = (quantity.value + side * NORMAL_95 * quantity.std for side in (-1.0, 1.0))
    else:
        lower, upper = quantity.interval_95
        lower = -np.inf if quantity.interval_open[0] else lower
        upper = np.inf if quantity.interval_open[1] else upper
    return Row(truth=truth, value=quantity.value, std=quantity.std, lower=lower, upper=upper, trusted=trusted)


def summary(tests: Sequence[Mapping[str, Row]], kind: str = "short tests") -> str:
    """Return the table of all numbers, and what holds over all of them."""
    names = dict.fromkeys(name for test in tests for name in test)
    lines, every, trusted = [], [], []
    for name in names:
        rows = [test[name] for test in tests if name in test]
        inside = np.array([row.inside for row in rows])
        named = [row.inside for row in rows if row.trusted]
        every += inside.tolist()
        trusted += named
        known = [row for row in rows if np.isfinite(row.std) and row.std > 0.0]
        errors = np.array([(row.value - row.truth) / row.std for row in known])
        widths = [(row.upper - row.lower) / abs(row.truth) for row in rows if row.truth]
        cells = [
            name,
            f"{len(rows)}",
            f"{100.0 * inside.mean():.1f} %",
            f"{np.sqrt(np.mean(errors**2)):.2f}",
            f"{errors.mean():+.2f}",
            f"{100.0 * np.median(widths):.3g} %" if widths else "",
            f"{np.sum(~np.array(named))} of {len(named)}" if named else "",
        ]
        lines.append(cells)
    header = ["number", "tests", "inside", "error / stated, rms", "mean", "width / truth, median", "trusted outside"]
    refused = sum(not test for test in tests)
    return (
        table(f"{len(tests)} {kind}, each with its own truth", header, lines)
        + f"\nAll numbers together: {100.0 * np.mean(every):.1f} % of {len(every)} inside. Trusted numbers: "
        + f"{100.0 * (1.0 - np.mean(trusted)):.1f} % of {len(trusted)} outside. No fingerprint: {refused} tests.\n"
    )


def main() -> None:
    """Run the tests and print their table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--tests", type=int, default=200, help="number of tests")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--keep", type=Path, help="file of JSON lines that results are added to and resumed from")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    trial = load_trial("stan-tug-1205", "short")
    kept = _kept(options.keep)
    for seed in range(options.first, options.first + options.tests):
        if seed in kept:
            continue
        kept[seed] = tested(seed, trial)
        if options.keep is not None:
            with options.keep.open("a", encoding="utf-8") as file:
                rows = {name: _fields(row) for name, row in kept[seed].items()}
                file.write(json.dumps({"seed": seed, "rows": rows}) + "\n")
    text = summary([kept[seed] for seed in range(options.first, options.first + options.tests)])
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


def _fields(row: Row) -> dict[str, float]:
    return {name: getattr(row, name) for name in Row.__dataclass_fields__}


def _kept(path: Path | None) -> dict[int, dict[str, Row]]:
    if path is None or not path.exists():
        return {}
    tests = [json.loads(line) for line in path.read_text(encoding="utf-8").splitlines()]
    return {test["seed"]: {name: Row(**row) for name, row in test["rows"].items()} for test in tests}


if __name__ == "__main__":
    main()
