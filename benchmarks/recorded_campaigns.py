"""How much of a campaign comes back from its set point: ``python -m benchmarks.recorded_campaigns --draws 100``.

Campaigns of all kinds of tests are drawn at random, put out by a generator with another clock, gain and offset, in half
of all cases with steps and cycles, and recorded with noise.
"""

import argparse
import math
import time as clock
from collections import Counter
from dataclasses import dataclass

import numpy as np

from shaftprint.campaign import Campaign, setpoint
from shaftprint.errors import SignalError
from shaftprint.signals.description._describe import described

PPM = 1e-6
RATE_HZ = 200.0
# How far the set point of the proposal may be off: a share of all motion; so many samples beside a jump are its own.
SHARE, BESIDE_JUMP = 0.02, 6


@dataclass(frozen=True, kw_only=True)
class Chain:
    """What stands between the campaign and the file."""

    ppm: float = 0.0
    gain: float = 1.0
    offset_v: float = 0.0
    step_v: float = 0.0
    cycle_s: float = 0.0
    noise_v: float = 0.0008

    def true_volts(self, campaign, time_s):
        """Return the set point as it is meant, by the clock of the logger."""
        return self.offset_v + self.gain * setpoint(campaign, time_s / (1.0 + PPM * self.ppm))

    def recorded_volts(self, campaign, time_s, rng):
        """Return the set point as it is recorded."""
        time = time_s / (1.0 + PPM * self.ppm)
        if self.cycle_s:
            time = self.cycle_s * (np.floor(time / self.cycle_s + 1e-9) + 0.5)
        volts = setpoint(campaign, time)
        if self.step_v:
            volts = self.step_v * np.round(volts / self.step_v)
        volts = self.offset_v + self.gain * volts + self.noise_v * rng.standard_normal(time.size)
        count_v = 10.0 / 32768
        return count_v * np.round(volts / count_v)


def drawn_chain(rng):
    """Draw another clock, gain and offset; steps and cycles of the generator in half of all."""
    coarse = rng.random() < 0.5
    return Chain(
        ppm=float(rng.uniform(-100.0, 100.0)),
        gain=float(rng.uniform(0.9, 1.1)),
        offset_v=float(rng.uniform(-0.2, 0.2)),
        step_v=float(rng.choice([0.0024, 0.0049])) if coarse else 0.0,
        cycle_s=float(rng.choice([0.01, 0.02])) if coarse else 0.0,
    )


def drawn_campaign(rng):
    """Draw four to eight tests of all kinds in any order, phase and sign, with or without a pause between them."""
    kinds = rng.choice(
        ["sine", "sine", "sine", "stairs", "linear", "logarithmic", "multisine", "binary"], size=int(rng.integers(4, 9))
    ).tolist()
    offset = float(np.round(rng.uniform(-7.0, -3.0), 2))
    ramp_s = float(np.round(rng.uniform(2.0, 6.0), 1))
    tests = {name: [] for name in ("sines", "multisines", "binary_sequences", "chirps", "staircases")}
    now, was_leg = float(np.round(rng.uniform(3.0, 12.0), 2)), False
    for number, kind in enumerate(kinds):
        is_leg = kind in ("multisine", "binary")
        now += ramp_s * (1 + was_leg) + 0.2 if is_leg or was_leg else 0.0
        was_leg = is_leg
        test, section, stop = _drawn(kind, f"T{number}", max(float(np.round(now, 2)), now), offset, rng)
        tests[section].append(test)
        # two sines may follow each other at once
        now = stop + float(rng.choice([0.0, rng.uniform(1.5, 8.0)], p=[0.25, 0.75]))
    ramps = {"ramp_s": ramp_s} if tests["multisines"] or tests["binary_sequences"] else {}
    return Campaign.model_validate(
        {"name": "drawn", "duration_s": math.ceil(now + ramp_s + 8.0), "offset_v": offset} | tests | ramps
    )


def _drawn(kind, name, start, offset, rng):
    """Return the fields of one test, the list to which it belongs, and when it stops."""
    amplitude = float(np.round(rng.uniform(0.15, 0.8), 2))
    phase = float(np.round(rng.choice([0.0, 0.0, math.pi, rng.uniform(0.0, 6.0)]), 4))
    head = {"name": name, "start_s": start}
    if kind == "sine":
        hertz = float(f"{10.0 ** rng.uniform(-1.7, 0.55):.3g}")
        stop = float(np.round(start + (rng.uniform(1.5, 4.0) + hertz * rng.uniform(8.0, 20.0)) / hertz, 2))
        sine = {"frequency_hz": hertz, "amplitude_v": amplitude, "phase_rad": phase, "stop_s": stop}
        return head | sine | {"settled_s": stop - 1.001 / hertz}, "sines", stop
    if kind == "stairs":
        dwell = float(np.round(rng.uniform(4.0, 15.0), 1))
        levels = [offset]
        for _ in range(int(rng.integers(2, 7))):
            others = [v for v in np.arange(offset - 2, offset + 2.1, 0.5) if abs(v - levels[-1]) > 0.1]
            levels.append(float(np.round(rng.choice(others), 2)))
        levels = levels[1:]
        return head | {"levels_v": levels, "dwell_s": dwell}, "staircases", start + dwell * len(levels)
    if kind in ("linear", "logarithmic"):
        ends = [float(f"{10.0 ** rng.uniform(-1.5, -0.7):.3g}"), float(f"{10.0 ** rng.uniform(-0.2, 0.5):.3g}")]
        first, last = ends if rng.random() < 0.7 else ends[::-1]
        stop = float(np.round(start + rng.uniform(40.0, 120.0), 2))
        sweep = {"start_frequency_hz": first, "stop_frequency_hz": last, "sweep": kind, "phase_rad": phase}
        return head | sweep | {"amplitude_v": amplitude, "stop_s": stop}, "chirps", stop
    level = float(np.round(offset + rng.uniform(-1.5, 1.5), 3))
    periods = float(rng.uniform(2.1, 4.0))
    if kind == "binary":
        order = int(rng.integers(4, 7))
        clock = float(np.round(rng.uniform(0.2, 0.6), 2))
        clocks = 2 * (2**order - 1)
        stop = start + (round(periods * clocks) + 0.0) * clock
        fields = {
            "order": order,
            "clock_s": clock,
            "first_clock": int(rng.integers(0, clocks)),
            "amplitude_v": amplitude,
        }
        return (
            head | fields | {"level_v": level, "settled_s": stop - 2.001 * clocks * clock, "stop_s": stop},
            "binary_sequences",
            stop,
        )
    period = float(np.round(rng.uniform(8.0, 25.0), 3))
    odd = np.arange(1, int(3.0 * period), 2)
    lines = np.sort(rng.choice(odd, size=min(int(rng.integers(6, 25)), odd.size), replace=False))
    sizes = np.round(rng.uniform(0.03, 0.3, lines.size), 5)
    stop = float(np.round(start + periods * period, 3))
    fields = {
        "level_v": level,
        "period_s": period,
        "harmonics": lines.tolist(),
        "amplitudes_v": sizes.tolist(),
        "phases_rad": np.round(rng.uniform(0.0, 6.28, lines.size), 5).tolist(),
    }
    return head | fields | {"settled_s": stop - 2.001 * period, "stop_s": stop}, "multisines", stop


def wrong_samples(found, chain, campaign, time_s):
    """Return the times at which a proposed set point is another than the true one, off the jumps."""
    truth_v = chain.true_volts(campaign, time_s)
    error = np.abs(setpoint(found, time_s) - truth_v)
    near = np.zeros(time_s.size, dtype=bool)
    for k in np.flatnonzero(np.abs(np.diff(truth_v)) > 0.05):
        near[max(k - BESIDE_JUMP, 0) : k + BESIDE_JUMP + 1] = True
    return time_s[(error > SHARE * np.ptp(truth_v) + chain.step_v) & ~near]


def kinds(campaign):
    """Return how many tests of each kind there are."""
    return Counter(type(one).__name__ for one in campaign.excitations)


def main() -> None:
    """Draw campaigns and print what came back of them."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks.recorded_campaigns", description=__doc__)
    parser.add_argument("--draws", type=int, default=30, help="campaigns to draw")
    whole, took, errors = 0, 0.0, []
    draws = parser.parse_args().draws
    for seed in range(draws):
        rng = np.random.default_rng(seed)
        campaign, chain = drawn_campaign(rng), drawn_chain(rng)
        time_s = np.arange(int(campaign.duration_s * RATE_HZ)) / RATE_HZ
        volts = chain.recorded_volts(campaign, time_s, rng)
        began = clock.process_time()
        try:
            shown = described(volts, rate_hz=RATE_HZ, start_s=0.0, name="drawn")
        except SignalError as error:
            print(f"seed {seed}: {error}")
            continue
        took += clock.process_time() - began
        wrong = wrong_samples(shown.campaign, chain, campaign, time_s).size / time_s.size
        if kinds(shown.campaign) == kinds(campaign) and wrong < 0.0005 and not shown.unexplained_s:
            whole += 1
            errors.append(shown.difference_v)
            continue
        named = ", ".join(f"{begin_s:.1f} to {end_s:.1f} s" for begin_s, end_s in shown.unexplained_s)
        print(f"seed {seed}: {100.0 * wrong:.2g} % of the samples differ; named: {named or 'nothing'}")
    print(f"{whole} of {draws} came back whole; what differs, noise included: {1e3 * np.median(errors):.2g} mV rms")
    print(f"{took / draws:.2g} CPU s each")


if __name__ == "__main__":
    main()
