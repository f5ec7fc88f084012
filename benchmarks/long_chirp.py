"""Row 3: a long chirp of 300,000 samples, fitted from 50 starts, beside one simulation of it by SciPy."""

from dataclasses import dataclass, field

import numpy as np
from scipy.signal import StateSpace, lsim, tf2ss

from benchmarks.thesis_case import TRUTH
from benchmarks.timing import Spread, cpu_seconds, print_table
from shaftprint.arrays import FloatArray
from shaftprint.catalogue import structure
from shaftprint.identify import Identification
from shaftprint.time_domain import Record, identify_chirp, record_from_arrays

SAMPLES, DURATION_S = 300_000, 1650.0
RATE_HZ = SAMPLES / DURATION_S
# Start and stop [s], first and last frequency [Hz] of the merged chirps of the thesis, with a little rest around them.
PARTS = ((5.0, 551.0, 0.001, 0.02), (551.0, 1097.0, 0.015, 0.27), (1097.0, 1640.0, 0.1, 3.981))
AMPLITUDE = 0.12
NOISE = np.array([0.01, 0.06])
# The record cut in motion [s].
CUT_S = (250.0, 1250.0)
PADE_5 = (30240.0, 15120.0, 3360.0, 420.0, 30.0, 1.0)


@dataclass(slots=True)
class Times:
    """CPU seconds, one value a repetition."""

    peer: list[float] = field(default_factory=list)
    """One simulation by ``scipy.signal.lsim``."""
    ours: list[float] = field(default_factory=list)
    """The whole fit."""
    at_rest: list[float] = field(default_factory=list)
    """The whole fit of a record that is known to begin and end at rest."""


def run(repetitions: int) -> None:
    """Measure row 3 and print it."""
    print("\n## Row 3: 50-start CL4 fit to a long chirp of 300,000 samples, exact delay")
    time = np.arange(SAMPLES) / RATE_HZ
    u = _set_point(time)
    clean = _exact_outputs(u)
    peer, times = _peer(), Times()
    for repetition in range(-1, repetitions):
        record = _record(u, clean + NOISE[:, None] * np.random.default_rng(repetition + 1).standard_normal(clean.shape))
        peer_s, (_, simulated, _) = cpu_seconds(lambda: lsim(peer, u, time))
        ours_s, found = cpu_seconds(lambda record=record: _fit(record))
        rest_s, _ = cpu_seconds(lambda record=record: _fit(record, transients=False))
        _expect_right(simulated, clean, found)
        # The first repetition is for imports and first calls.
        if repetition >= 0:
            times.peer.append(peer_s)
            times.ours.append(ours_s)
            times.at_rest.append(rest_s)
    _print_times(times)
    _print_errors(found, _fit(_cut(u, clean)))


def _set_point(time_s: FloatArray) -> FloatArray:
    found = np.zeros_like(time_s)
    for start, stop, first, last in PARTS:
        inside = (time_s >= start) & (time_s < stop)
        growth = np.log(last / first)
        phase = first * (stop - start) / growth * np.expm1(growth * (time_s[inside] - start) / (stop - start))
        found[inside] = AMPLITUDE * np.sin(2.0 * np.pi * phase)
    return found


def _exact_outputs(u: FloatArray) -> FloatArray:
    """Return speed and torque with the exact delay, through a transform that is long enough to come to rest."""
    length = u.size + round(60.0 * RATE_HZ)
    frequency = np.fft.rfftfreq(length, 1.0 / RATE_HZ)
    frequency[0] = 1e-9
    cl4 = structure("CL4")
    response = cl4.response(cl4.vector(TRUTH), 2j * np.pi * frequency)
    return np.asarray(np.fft.irfft(response * np.fft.rfft(u, length), length)[:, : u.size])


def _peer() -> StateSpace:
    """Return the closed loop in state space: governor, fifth-order Pade approximation, lag and shaft, nine states."""
    tau, k_p, k_i, t_d, omega, zeta = (TRUTH[n] for n in ("tau_n", "K_p", "K_i", "t_d", "omega_n", "zeta"))
    powers = np.array(PADE_5) * t_d ** np.arange(6)
    late = tf2ss((powers * (-1.0) ** np.arange(6))[::-1], powers[::-1])
    a, b, c, d = late
    whole, source = np.zeros((9, 9)), np.zeros((9, 1))
    integral, delay, lag, speed = 0, slice(1, 6), slice(6, 8), 8
    rack = np.zeros((1, 9))
    rack[0, integral], rack[0, speed] = k_i, -k_p
    whole[integral, speed], source[integral] = -1.0, 1.0
    whole[delay, delay] = a
    whole[delay] += b @ rack
    source[delay] = b * k_p
    given = np.zeros((1, 9))
    given[0, delay] = c[0]
    given += d @ rack
    whole[lag, lag] = [[0.0, 1.0], [-(omega**2), -2.0 * zeta * omega]]
    whole[7] += omega**2 * given[0]
    source[7] = omega**2 * float(d[0, 0]) * k_p
    whole[speed, 6], whole[speed, speed] = 1.0 / tau, -2.0 / tau
    shown = np.zeros((2, 9))
    shown[0, speed], shown[1, 6] = 1.0, 1.0
    return StateSpace(whole, source, shown, np.zeros((2, 1)))


def _record(u: FloatArray, outputs: FloatArray) -> Record:
    return record_from_arrays("C2", {"n_set": u}, {"n": outputs[0], "M_s": outputs[1]}, rate_hz=RATE_HZ)


def _cut(u: FloatArray, outputs: FloatArray) -> Record:
    part = slice(round(CUT_S[0] * RATE_HZ), round(CUT_S[1] * RATE_HZ))
    return _record(u[part], outputs[:, part])


def _fit(record: Record, *, transients: bool = True) -> Identification:
    return identify_chirp(structure("CL4"), record, rng=np.random.default_rng(7), transients=transients)


def _expect_right(simulated: FloatArray, clean: FloatArray, found: Identification) -> None:
    apart = float(np.sqrt(np.mean((simulated.T - clean) ** 2) / np.mean(clean**2)))
    if apart > 5e-3:
        raise RuntimeError(f"the peer's simulation is {apart:.2g} apart from the exact one.")
    far = max(abs(e.value - TRUTH[e.name]) / e.std for e in found.parameters)
    if far > 5.0:
        raise RuntimeError(f"an estimate is {far:.1f} standard deviations from the truth.")


def _print_times(times: Times) -> None:
    peer, ours, at_rest = (Spread(tuple(part)) for part in (times.peer, times.ours, times.at_rest))
    rows = [
        ("ONE scipy.signal.lsim, fifth-order Pade, 9 states", peer.text(1e3, 0), ""),
        ("whole fit, 50 starts, states at begin and end unknown", ours.text(1e3, 0), (peer / ours).text(digits=1)),
        ("whole fit, 50 starts, from rest to rest", at_rest.text(1e3, 0), (peer / at_rest).text(digits=1)),
    ]
    print_table("CPU time, median [min..max], and the peer's over it", ("what", "CPU, ms", "ratio"), rows)


def _print_errors(found: Identification, cut: Identification) -> None:
    bias = {e.name: e.value / TRUTH[e.name] - 1.0 for e in cut.parameters}
    rows = [
        (
            e.name,
            f"{100.0 * (e.value / TRUTH[e.name] - 1.0):+.2f}",
            f"{100.0 * e.std / e.value:.2f}",
            f"{100.0 * bias[e.name]:+.3f}",
        )
        for e in found.parameters
    ]
    title = f"Errors with noise (last repetition), and without noise in a record cut at {CUT_S[0]:g} and {CUT_S[1]:g} s"
    print_table(title, ("parameter", "error, %", "stated deviation, %", "cut in motion, error, %"), rows)
