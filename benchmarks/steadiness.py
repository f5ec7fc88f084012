"""How often a torque gauge whose gain changes within a test is named, a set point that does, and a sound one.

Healthy recordings of drawn ships are sailed once (``monte_carlo_short.drawn_ship``; the planned test with all nuisances
of ``planned_tests.py``). What was read of them, set point, speed and torque on the grid of 200 Hz, is kept in a folder.
Each fault is put into these channels, at a drawn time and with a drawn sign, and only the check is run, not the fit:

- gauge: step of 4 % between a tenth and nine tenths of the test; straight drift of 6 %; warm-up by 6 % with a time
  constant of 90 to 300 s;
- set point: amplitude off by 1 % from a drawn time on, about its offset or about zero volts, between a tenth and nine
  tenths of the time that its sines or legs take. A staircase ahead of them may change: they get their scale from the
  speed.

Run ``python benchmarks/steadiness.py --recordings build/steadiness --seeds 100``; 5 s of one core for each recording
that is not there yet, 0.3 s for its faults. ``--write`` puts the table into the decision.
"""

import argparse
import sys
import tempfile
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from functools import cache
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.monte_carlo_short import drawn_ship
from benchmarks.monte_carlo_tables import table
from benchmarks.planned_tests import CASES, OFFSET_V, SLOPE_RPM_PER_V, VESSEL, planned, ship_of
from benchmarks.result_tables import write_between_marks
from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, load_campaign
from shaftprint.design import campaign_of
from shaftprint.reasons import Reason
from shaftprint.recording import read_recording
from shaftprint.signals._channel_readings import read_channels
from shaftprint.signals.levels._set_point_steadiness import expect_steady_set_point
from shaftprint.signals.levels._steadiness import expect_steady_gauge
from shaftprint.tug import sail

DOCUMENT = ROOT / "docs" / "decisions" / "0102-gain-within-a-test.md"
BEGIN, END = (
    "<!-- table of benchmarks/steadiness.py: begin -->",
    "<!-- table of benchmarks/steadiness.py: end -->",
)
SEED = 102
TESTS = ("short", "12min", "planned")
STEP, DRIFT, WARM_UP, AMPLITUDE = 0.04, 0.06, 0.06, 0.01
WARM_UP_S = (90.0, 300.0)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Channels:
    """What was read of a recording."""

    set_point_v: FloatArray
    """Set point [V], shape (samples,)."""
    speed_rev_s: FloatArray
    """Engine speed [rev/s], shape (samples,)."""
    torque_nm: FloatArray
    """Shaft torque [N m], shape (samples,)."""
    rate_hz: float
    """Rate of the grid [Hz]."""
    start_s: float
    """When it begins [s]."""

    @property
    def time_s(self) -> FloatArray:
        """Time of the samples [s]."""
        return self.start_s + np.arange(self.torque_nm.size) / self.rate_hz


Fault = Callable[[Channels, np.random.Generator, Campaign], tuple[FloatArray, FloatArray]]


def _gauge(gain: Callable[[FloatArray, float, np.random.Generator], FloatArray]) -> Fault:
    """Return set point and torque, the torque with a gain that changes by a drawn sign."""

    def applied(of: Channels, rng: np.random.Generator, _: Campaign) -> tuple[FloatArray, FloatArray]:
        sign = float(rng.choice([-1.0, 1.0]))
        return of.set_point_v, of.torque_nm * (1.0 + sign * gain(of.time_s, float(of.time_s[-1]), rng))

    return applied


def _warm_up(time_s: FloatArray, _: float, rng: np.random.Generator) -> FloatArray:
    constant_s = np.exp(rng.uniform(*np.log(WARM_UP_S)))
    return np.asarray(WARM_UP * np.exp(-time_s / constant_s))


def _amplitude(of: Channels, rng: np.random.Generator, campaign: Campaign) -> tuple[FloatArray, FloatArray]:
    about_v, size = float(rng.choice([0.0, of.set_point_v.mean()])), float(rng.choice([-1.0, 1.0])) * AMPLITUDE
    lines = (*campaign.sines, *campaign.legs)
    first_s, last_s = min(line.settled_s for line in lines), max(line.stop_s for line in lines)
    later = of.time_s >= first_s + rng.uniform(0.1, 0.9) * (last_s - first_s)
    return about_v + (of.set_point_v - about_v) * (1.0 + size * later), of.torque_nm


FAULTS: Mapping[str, tuple[str, Fault]] = {
    "none": ("", lambda of, *_: (of.set_point_v, of.torque_nm)),
    "gauge: step of 4 %": (
        "gauge steadiness",
        _gauge(lambda time_s, end_s, rng: STEP * (time_s >= rng.uniform(0.1, 0.9) * end_s)),
    ),
    "gauge: drift of 6 %": ("gauge steadiness", _gauge(lambda time_s, end_s, _: DRIFT * time_s / end_s)),
    "gauge: warm-up by 6 %": ("gauge steadiness", _gauge(_warm_up)),
    "set point: amplitude 1 %": ("set-point shape", _amplitude),
}


@cache
def campaign_of_test(test: str) -> Campaign:
    """Return the campaign of a kind of test."""
    if test != "planned":
        return load_campaign(test)
    case = CASES["12-drawn"]
    return campaign_of(planned(case), name=case.name, offset_v=OFFSET_V, slope_rpm_per_v=SLOPE_RPM_PER_V)


def recorded(test: str, seed: int, folder: Path) -> Channels:
    """Return what was read of the healthy recording of a seed; it is sailed where the folder does not hold it."""
    kept = folder / f"{test}-{seed}.npz"
    if not kept.exists():
        ship = ship_of(CASES["12-drawn"], seed) if test == "planned" else drawn_ship(seed, VESSEL)
        with tempfile.TemporaryDirectory() as place:
            path = Path(place) / "recording.h5"
            sail(ship.vessel, campaign_of_test(test), path, seed=seed, tug=ship.tug)
            with read_recording(path) as recording:
                read = read_channels(recording, VESSEL)
        speed = next(name for name in read.by_name if name.startswith("n_") and name != "n_set")
        values = {key: read.by_name[name].values for key, name in (("v", "n_set"), ("n", speed), ("m", "M_s"))}
        np.savez(
            kept,
            rate=read.clock.rate_hz,
            start=read.clock.start_s,
            **{key: of.astype(np.float32) for key, of in values.items()},
        )
    with np.load(kept) as of:
        v, n, m = (of[key].astype(np.float64) for key in "vnm")
        return Channels(
            set_point_v=v, speed_rev_s=n, torque_nm=m, rate_hz=float(of["rate"]), start_s=float(of["start"])
        )


def reasons_of(of: Channels, campaign: Campaign, fault: Fault, rng: np.random.Generator) -> tuple[Reason, ...]:
    """Return what is said of a recording with a fault."""
    set_point_v, torque_nm = fault(of, rng, campaign)
    grid = {"rate_hz": of.rate_hz, "start_s": of.start_s}
    of_gauge, _ = expect_steady_gauge(
        campaign, set_point=set_point_v, speed_rev_s=of.speed_rev_s, torque_nm=torque_nm, **grid, channel="M_s"
    )
    return (
        *of_gauge,
        *expect_steady_set_point(campaign, set_point_v, **grid, channel="U_setpoint"),
    )


def rows_of(test: str, seeds: range, folder: Path) -> Iterator[list[str]]:
    """Give a row for each fault: how often it was named, as what, and how often something else was."""
    counts = {name: np.zeros(3, dtype=int) for name in FAULTS}
    for seed in seeds:
        channels = recorded(test, seed, folder)
        for place, (name, (kind, fault)) in enumerate(FAULTS.items()):
            rng = np.random.default_rng([SEED, seed, place])
            reasons = reasons_of(channels, campaign_of_test(test), fault, rng)
            right = [one for one in reasons if one.kind == kind]
            counts[name] += [
                bool(right),
                any("gain of the torque gauge" in one.sentence or kind != "gauge steadiness" for one in right),
                len(right) < len(reasons),
            ]
            if len(right) < len(reasons) or (kind and not right):
                print(f"{test}, seed {seed}, {name}: {[one.sentence[:110] for one in reasons]}", file=sys.stderr)
    for name, (named, as_such, other) in counts.items():
        of = len(seeds)
        told = [f"{named} of {of}", f"{as_such if named else 0}"] if name != "none" else ["", ""]
        yield [test, name, f"{of}", *told, f"{other}"]


def main() -> None:
    """Sail what is missing, spoil it and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20, help="recordings of each kind of test")
    parser.add_argument("--first", type=int, default=1, help="seed of the first recording")
    parser.add_argument("--test", choices=TESTS, action="append", help="some kinds alone")
    parser.add_argument("--recordings", type=Path, required=True, help="folder in which recordings are kept")
    parser.add_argument("--write", action="store_true", help=f"put the table into {DOCUMENT.relative_to(ROOT)}")
    options = parser.parse_args()
    options.recordings.mkdir(parents=True, exist_ok=True)
    seeds = range(options.first, options.first + options.seeds)
    rows = [row for test in options.test or TESTS for row in rows_of(test, seeds, options.recordings)]
    header = ["test", "fault", "recordings", "named", "of these as gain or amplitude", "something else said"]
    text = table("Changes within a test", header, rows)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END, beside=False)


if __name__ == "__main__":
    main()
