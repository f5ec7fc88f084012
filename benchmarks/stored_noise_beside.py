"""Noise of a log underway and of a controllable pitch: tables of ``survey/shipped_noise``, with a third output.

Every seed sails a leg, or a leg of the speed beside one of the pitch, with weak lines on a dense grid; what
``identify`` takes as the noise of a line is averaged over the seeds. Slow lines underway, where a leg has the wander of
the load taken out, are those of the sines of ``dither``. Run
``python -m benchmarks.stored_noise_beside --of underway``, ``--of pitch`` or ``--of speed-beside-pitch``, what stands
under the set point of the speed in the same recordings, or ``--of combinator``; a seed takes ten to twenty seconds of
one core.
"""

import argparse
import tempfile
from collections.abc import Callable, Sequence
from itertools import combinations
from pathlib import Path

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.campaign import Campaign, Multisine, load_campaign
from shaftprint.identify import NoiseLevels
from shaftprint.survey import Measurement, Trial, measure
from shaftprint.survey._noise import noise_at_speeds, noise_of_further
from shaftprint.tug import like_stan_tug_1205, sail
from shaftprint.vessel import Vessel, load_vessel

FIRST_SEED = 600
UNDERWAY, PITCHED, COMBINED = "stan-tug-1205-underway", "nifs-research-vessel", "nifs-research-vessel-combinator"
# Slower than this the sines tell [Hz]; faster than this no log shows a line, and its noise is that of its last band.
SLOW_HZ, LAST_OF_LOG_HZ = 0.04, 2.2
LINES, HIGHEST_HZ = 36, 7.2
OF_TEN_MINUTES = {"period_s": 48.0, "periods": 12}


def odd(highest: float, count: int, step: int = 1) -> tuple[int, ...]:
    """Return odd multiples of a step up to a number, spread over the octaves."""
    every = 2 * np.round((np.geomspace(1.0, highest / step, count) - 1.0) / 2.0).astype(int) + 1
    return tuple(step * int(one) for one in np.unique(every))


def multisine(name: str, harmonics: Sequence[int], *, period_s: float, periods: int, **fields: object) -> Multisine:
    """Return weak lines with phases of their own."""
    phases = np.random.default_rng(len(harmonics)).uniform(0.0, 2.0 * np.pi, len(harmonics))
    return Multisine.model_validate(
        {
            "name": name,
            "period_s": period_s,
            "harmonics": tuple(harmonics),
            "amplitudes_v": (0.02,) * len(harmonics),
            "phases_rad": tuple(phases.tolist()),
            "start_s": 10.0,
            "settled_s": 40.0,
            "stop_s": 40.0 + periods * period_s,
            **fields,
        }
    )


def leg_underway() -> Campaign:
    """Return a leg of half an hour at the working point underway."""
    leg = multisine("M1", odd(HIGHEST_HZ * 80.0, LINES), period_s=80.0, periods=20, level_v=-6.66)
    return Campaign(name="noise", duration_s=1650.0, offset_v=-6.66, ramp_s=4.0, multisines=(leg,))


def legs_of_pitch() -> Campaign:
    """Return ten minutes in which speed and pitch move at once."""
    pitch = multisine("P1", odd(2.5 * 48.0, 18, step=3), level_v=4.0, input="pitch_set_point", **OF_TEN_MINUTES)
    return leg_of_speed().model_copy(
        update={"further_offsets_v": {"pitch_set_point": 4.0}, "multisines": (*leg_of_speed().multisines, pitch)}
    )


def leg_of_speed() -> Campaign:
    """Return ten minutes in which the set point of the speed moves, and with a combinator the pitch."""
    of_speed_alone = tuple(one for one in odd(3.5 * 48.0, 60) if one % 3)
    speed = multisine("M1", of_speed_alone, level_v=-5.0, **OF_TEN_MINUTES)
    return Campaign(name="noise", duration_s=620.0, offset_v=-5.0, ramp_s=2.0, multisines=(speed,))


Shown = Callable[[Measurement, Campaign], NoiseLevels]


def of_speed(measurement: Measurement, campaign: Campaign) -> NoiseLevels:
    """Return the noise under the set point of the speed."""
    (levels,) = noise_at_speeds(measurement, campaign).values()
    return levels


def of_pitch(measurement: Measurement, campaign: Campaign) -> NoiseLevels:
    """Return the noise under the set point of the pitch."""
    return noise_of_further(measurement, campaign)["theta_set"]


def averaged(vessel: Vessel, campaign: Campaign, shown: Shown, seeds: int) -> NoiseLevels:
    """Sail and return the mean of the densities."""
    found = []
    tug = like_stan_tug_1205(vessel, offset_v=campaign.offset_v)
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(FIRST_SEED, FIRST_SEED + seeds):
            path = Path(folder) / f"{seed}.nc"
            sail(vessel, campaign, path, tug=tug, seed=seed)
            found.append(shown(measure(path, Trial(vessel=vessel, campaign=campaign)), campaign))
            path.unlink()
    density = np.mean([one.density for one in found], axis=0)
    first = found[0]
    return NoiseLevels(
        frequency_hz=first.frequency_hz,
        density=density,
        outputs=first.outputs,
        set_point_per_v=first.set_point_per_v,
        orders_hz=first.orders_hz,
    )


def rows(levels: NoiseLevels, kept: FloatArray) -> list[str]:
    """Return the lines of the table; what no log shows has the noise of its last band, without coherence."""
    density, last = levels.density.copy(), int(np.flatnonzero(levels.frequency_hz <= LAST_OF_LOG_HZ)[-1])
    if "v_s" in levels.outputs:
        density[last + 1 :, 2, 2] = density[last, 2, 2]
    lines = []
    for row in np.flatnonzero(kept):
        size = np.sqrt(np.diagonal(density[row]).real)
        parts = [f"{size[i] ** 2:.3g}" for i in range(size.size)]
        for i, j in combinations(range(size.size), 2):
            one = density[row, i, j] / (size[i] * size[j])
            parts.append(f"{one.real:.4f}, {one.imag:.4f}")
        lines.append(f"    [{levels.frequency_hz[row]:.4g}, {', '.join(parts)}],")
    return lines


def main() -> None:
    """Sail, average and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    of = ["underway", "pitch", "speed-beside-pitch", "combinator"]
    parser.add_argument("--of", choices=of, required=True, help="what the table is of")
    parser.add_argument("--seeds", type=int, default=10, help="number of recordings")
    chosen = parser.parse_args()
    if chosen.of != "underway":
        shown = of_pitch if chosen.of == "pitch" else of_speed
        is_combined = chosen.of == "combinator"
        vessel = load_vessel(COMBINED if is_combined else PITCHED)
        levels = averaged(vessel, leg_of_speed() if is_combined else legs_of_pitch(), shown, chosen.seeds)
        print(levels.outputs, levels.set_point_per_v, levels.orders_hz)
        print("\n".join(rows(levels, np.ones(levels.frequency_hz.size, dtype=bool))))
        return
    vessel = load_vessel(UNDERWAY)
    slow = averaged(vessel, load_campaign("dither"), of_speed, chosen.seeds)
    fast = averaged(vessel, leg_underway(), of_speed, chosen.seeds)
    print(fast.outputs, fast.set_point_per_v, fast.orders_hz)
    print("\n".join([*rows(slow, slow.frequency_hz <= SLOW_HZ), *rows(fast, fast.frequency_hz > SLOW_HZ)]))


if __name__ == "__main__":
    main()
