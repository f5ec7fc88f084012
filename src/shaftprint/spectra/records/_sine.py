"""One sine a record: stepped or dwelt frequencies, of which each gives one line."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
import scipy

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import ResponseError
from shaftprint.spectra._response_covariance import products, rounding_floor
from shaftprint.spectra.records._excitation import Excitation, LineEstimates

if TYPE_CHECKING:
    from shaftprint.spectra.records._records import Records

# A record is cut into so many stretches of whole periods, whose scatter is the noise; into fewer where it is short.
_MOST_STRETCHES, _FEWEST_STRETCHES = 32, 4
# Stretches of one line: records whose frequencies differ by less than this share of what one record tells apart.
_ONE_LINE = 0.25


@dataclass(frozen=True, kw_only=True, slots=True)
class Sine(Excitation):
    """Each record holds one sine; its frequency is found in the input.

    After the settling time a record is cut into stretches of whole periods. In each the amplitudes are found by least
    squares, with a constant beside them, and a line where there is drift; their scatter about the response is the
    noise, that of the input and what other frequencies add included.
    """

    settling_s: float | None = None
    """Time at the beginning of every record that is left out [s]; a quarter of the record when not given."""

    def estimate(self, records: "Records", *, drift: bool, band_hz: tuple[float, float]) -> LineEstimates:
        """Return the response at the frequency of each record; records of one frequency give one line."""
        if len(records.inputs) != 1:
            raise ResponseError(f"sines: expected one input, found {', '.join(records.inputs)}.")
        runs = [self._run(run, values, records.rate_hz, drift) for run, values in enumerate(records.values)]
        kept = sorted((run for run in runs if band_hz[0] <= run[0] <= band_hz[1]), key=lambda run: run[0])
        if not kept:
            raise ResponseError(f"found no sine between {band_hz[0]:g} and {band_hz[1]:g} Hz.")
        groups = [kept[:1]]
        for run in kept[1:]:
            near = run[0] - groups[-1][-1][0] < _ONE_LINE / run[2]
            groups[-1].append(run) if near else groups.append([run])
        lines = [_line(np.concatenate([run[1] for run in group], axis=1)) for group in groups]
        return LineEstimates(
            frequency_hz=np.array([np.mean([run[0] for run in group]) for group in groups]),
            response=np.stack([response for response, _, _ in lines], axis=2),
            spread=np.stack([spread for _, spread, _ in lines]),
            complex_samples=np.array([count for _, _, count in lines]),
            lost=np.zeros(len(lines), dtype=np.bool_),
        )

    def _run(self, run: int, values: FloatArray, rate_hz: float, drift: bool) -> tuple[float, ComplexArray, float]:
        """Return the frequency [Hz], amplitudes of the stretches (channels, stretches), and the length used [s]."""
        total_s = values.shape[1] / rate_hz
        settling_s = 0.25 * total_s if self.settling_s is None else self.settling_s
        settled = values[:, math.ceil(settling_s * rate_hz) :]
        samples = settled.shape[1]
        frequency_hz = _frequency(settled[0], rate_hz) if samples >= 2 * _FEWEST_STRETCHES else 0.0
        periods = int(samples / rate_hz * frequency_hz + 1e-6)
        if periods < _FEWEST_STRETCHES:
            raise ResponseError(
                f"record {run + 1}: expected {_FEWEST_STRETCHES} periods or more of a sine after {settling_s:.3g} s of "
                f"settling, found {periods} in {total_s - settling_s:.3g} s."
            )
        # of many periods as many stretches as use most of them
        most = min(periods, _MOST_STRETCHES)
        stretches = max(
            range((most + 1) // 2 if periods > most else most, most + 1), key=lambda n: (periods // n * n, n)
        )
        length_s = periods // stretches / frequency_hz
        amplitudes = np.empty((len(values), stretches), dtype=np.complex128)
        for place in range(stretches):
            part = slice(round(place * length_s * rate_hz), round((place + 1) * length_s * rate_hz))
            time = np.arange(part.start, part.stop) / rate_hz
            turn = np.exp(2j * math.pi * frequency_hz * time)
            centred = np.linspace(-1.0, 1.0, time.size)
            columns = np.stack([turn.real, -turn.imag, np.ones(time.size), *([centred] if drift else [])], axis=1)
            weights = np.linalg.lstsq(columns, settled[:, part].T, rcond=None)[0]
            amplitudes[:, place] = weights[0] + 1j * weights[1]
        return frequency_hz, amplitudes, samples / rate_hz


def _frequency(samples: FloatArray, rate_hz: float) -> float:
    """Return the frequency of the strongest sine [Hz]."""
    centred = samples - samples.mean()
    spectrum = np.abs(np.fft.rfft(centred * np.hanning(centred.size)))
    spectrum[0] = 0.0
    time, first = np.arange(centred.size) / rate_hz, float(np.argmax(spectrum))

    def left(bins: float) -> float:
        turn = 2.0 * math.pi * bins * rate_hz / centred.size * time
        columns = np.stack([np.cos(turn), np.sin(turn), np.ones(time.size)], axis=1)
        return float(np.sum((centred - columns @ np.linalg.lstsq(columns, centred, rcond=None)[0]) ** 2))

    bounds = (max(first - 1.0, 0.25), min(first + 1.0, 0.5 * centred.size))
    best = scipy.optimize.minimize_scalar(left, bounds=bounds, method="bounded", options={"xatol": 1e-5})
    found: float = best.x * rate_hz / centred.size
    return found


def _line(amplitudes: ComplexArray) -> tuple[ComplexArray, ComplexArray, float]:
    """Return the response of a line, shape (outputs, 1), its spread, and the complex samples behind it."""
    u, y = amplitudes[0], amplitudes[1:]
    power = float(np.sum(np.abs(u) ** 2))
    response = (y @ u.conj() / power)[:, None]
    left = y - response * u
    count = u.size - 1
    noise = left @ left.conj().T / count + rounding_floor(np.sum(np.abs(y) ** 2, axis=1)[None])[0]
    return response, products(noise[None], np.array([[[1.0 / power + 0j]]]))[0], float(count)
