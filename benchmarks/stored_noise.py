"""Noise of the simulated Stan Tug at four speeds: the table of ``survey/shipped_noise/stan-tug-1205-at-speeds.toml``.

Every seed sails legs that swing by half of the shipped two-speed campaign, at 0.70, 0.85, 1.00 and 1.15 of the working
speed. What is left between the lines, after the wander of the load and the orders of the shaft are taken out as in
every leg, is averaged over bands of a sixth of an octave. The part of the torque that goes with the speed, load and
inertia behind the gauge, is taken off before and put back at the middle of a band, since it turns within it. Run
``python benchmarks/stored_noise.py --seeds 10``; a seed takes about seven seconds of one core.
"""

import argparse
import sys
import tempfile
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT))

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.campaign import Campaign, Multisine, load_campaign
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra.legs._leg_lines import measure_leg
from shaftprint.spectra.legs._leg_window import cut_leg
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

SHARES = (1.0, 0.70, 0.85, 1.15)
SWING = 0.5
LEG_S = 310.0
# What is behind the gauge of the simulated tug at its working point.
LOAD_SLOPE, INERTIA_S = 2.0, 0.32
LOWEST_HZ, HIGHEST_HZ, BANDS = 0.02, 7.2, 25
# Half of a band: a twelfth of an octave, and two bins at least.
HALF_BAND, LEAST_HALF_HZ = 2.0 ** (1.0 / 12.0) - 1.0, 0.007


def campaign() -> Campaign:
    """Return a leg at each speed, at 1.0 first: its level is the offset."""
    shipped = load_campaign("two-speeds").multisines[0]
    legs = [
        Multisine(
            name=f"M{place}",
            level_v=-5.0 - (share - 1.0) / STAN_TUG_NOISE.set_point_per_v,
            period_s=shipped.period_s,
            harmonics=shipped.harmonics,
            amplitudes_v=tuple(SWING * size for size in shipped.amplitudes_v),
            phases_rad=shipped.phases_rad,
            start_s=10.0 + place * LEG_S,
            settled_s=10.0 + place * LEG_S + 14.0,
            stop_s=10.0 + place * LEG_S + 14.0 + 9.0 * shipped.period_s,
        )
        for place, share in enumerate(SHARES)
    ]
    return Campaign(
        name="noise", duration_s=20.0 + len(SHARES) * LEG_S, offset_v=-5.0, ramp_s=6.0, multisines=tuple(legs)
    )


def densities(signals: Signals, plan: Campaign, place: int, centre_hz: FloatArray) -> ComplexArray:
    """Return the densities of speed and of what the torque has of its own, and their cross term, by band [1/Hz].

    Shape (bands, 2, 2).
    """
    leg, state = plan.multisines[place], signals.legs[place]
    about = signals.about(state.name)
    channels = {name: one for name, one in about.channels.items() if name in ("n_set", *about.speeds, "M_s")}
    references = {name: one.reference for name, one in channels.items()}
    window = cut_leg(
        {name: one.values for name, one in channels.items()},
        references,
        state,
        leg.harmonics,
        excitation="n_set",
        rate_hz=about.rate_hz,
        start_s=about.start_s,
    )
    sensor = about.engine_speed
    lines = measure_leg(
        window, leg.harmonics, excitation="n_set", speed=sensor.name, orders=about.orders, references=references
    )
    spectrum, names = lines.window.spectrum(), lines.window.channels
    seconds = state.periods * state.period_s
    hertz = np.arange(spectrum.shape[1]) / seconds
    free = np.arange(hertz.size) % state.periods != 0
    table = np.empty((centre_hz.size, 2, 2), dtype=np.complex128)
    for row, centre in enumerate(centre_hz):
        band = free & (np.abs(hertz - centre) < max(HALF_BAND * centre, LEAST_HALF_HZ))
        speed = spectrum[names.index(sensor.name), band] / [sensor.gain(one) for one in hertz[band]]
        turning = LOAD_SLOPE + 2j * np.pi * hertz[band] * INERTIA_S / SHARES[place]
        both = np.stack([speed, spectrum[names.index("M_s"), band] - turning * speed])
        table[row] = both @ both.conj().T * (0.5 * seconds / band.sum())
    return table


def main() -> None:
    """Sail, average and print the table."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=10, help="number of recordings")
    chosen = parser.parse_args()
    vessel, plan = load_vessel("stan-tug-1205"), campaign()
    centre = np.geomspace(LOWEST_HZ, HIGHEST_HZ, BANDS)
    total = np.zeros((len(SHARES), BANDS, 2, 2), dtype=np.complex128)
    with tempfile.TemporaryDirectory() as folder:
        for seed in range(chosen.seeds):
            path = Path(folder) / f"{seed}.nc"
            sail(vessel, plan, path, seed=500 + seed)
            with read_recording(path) as recording:
                signals = prepare_signals(recording, vessel, plan)
            path.unlink()
            for place, share in enumerate(SHARES):
                total[place] += densities(signals, plan, place, centre * share) / chosen.seeds
    for place in np.argsort(SHARES):
        print(f"[[levels]]\nspeed_share = {SHARES[place]:.2f}\nrows = [")
        for row, hertz in enumerate(centre * SHARES[place]):
            mixing = np.array([[1.0, 0.0], [LOAD_SLOPE + 2j * np.pi * hertz * INERTIA_S / SHARES[place], 1.0]])
            s = mixing @ total[place, row] @ mixing.conj().T
            n, m = s[0, 0].real, s[1, 1].real
            c = s[0, 1] / np.sqrt(n * m)
            print(f"    [{hertz:.4g}, {n:.3g}, {m:.3g}, {c.real:.4f}, {c.imag:.4f}],")
        print("]\n")


if __name__ == "__main__":
    main()
