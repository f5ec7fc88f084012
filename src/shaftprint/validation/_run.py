"""One record with what the model makes of it: data and model, raw and through the low-pass."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.campaign._campaign import Campaign
from shaftprint.signals._signals import Signals
from shaftprint.signals.levels._working_point import deviation
from shaftprint.spectra.orders._order_waves import order_bands, order_waves
from shaftprint.validation._model import Model
from shaftprint.validation._prediction import OUTPUTS, Predict, add_quadratic_torque
from shaftprint.validation._settings import ValidationSettings
from shaftprint.validation._validation_records import Excerpt
from shaftprint.validation.measures._misfit import Compared, Unfiltered
from shaftprint.validation.measures._noise_pieces import LEAST_LOAD, QuietNoise, quiet_noise
from shaftprint.validation.measures._reach import EVERYWHERE, Reach, Swept, while_settling

# Time behind a record that is predicted too: the low-pass and the search for a delay look beyond its end.
_BEHIND_S = 5.0
# What the low-pass lets through of an order that is faster than its cut-off ends here, as a share of that.
_PASSED_TO = 1.25
# An order is one sine of the angle over so long; through a gear ratio that is rounded its phase turns before [s].
_STRETCH_S, _STRETCH_THROUGH_GEARS_S = 200.0, 40.0


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Data:
    """A recording as deviations from its working point, with its noise.

    Only stretches of it are made when they are asked for: a whole recording through the low-pass would take as much
    memory as its signals.
    """

    signals: Signals
    """The prepared recording."""
    highest_hz: float
    """Cut-off of the low-pass [Hz]."""
    raw_noise: QuietNoise
    """Noise of all frequencies."""
    noise: QuietNoise
    """Noise through the low-pass."""

    @classmethod
    def of(cls, signals: Signals, campaign: Campaign, settings: ValidationSettings) -> "Data":
        """Return the data of a recording.

        Raises ValidationError if no noise can be measured.
        """
        highest_hz = settings.highest_hz
        raw_noise, noise = (
            quiet_noise(outputs, campaign, signals, rest_s=settings.rest_s)
            for outputs in (partial(_raw, signals), partial(_quiet, signals, highest_hz=highest_hz))
        )
        return cls(signals=signals, highest_hz=highest_hz, raw_noise=raw_noise, noise=noise)

    def places(self, begin_s: float, end_s: float) -> slice:
        """Return the samples between two times, as far as they are in the recording."""
        first, last = (round((time - self.signals.start_s) * self.signals.rate_hz) for time in (begin_s, end_s))
        return slice(max(first, 0), min(last, self.signals.shaft_torque_nm.size))

    def set_point(self, there: slice) -> FloatArray:
        """Return the set point in some samples, shape (samples,)."""
        return deviation(self.signals.set_point_rev_s[there], self.signals.working_point.engine_speed_rev_s)

    def raw(self, there: slice) -> FloatArray:
        """Return speed and torque in some samples, shape (2, samples)."""
        return _raw(self.signals, there)

    def smooth(self, there: slice, model: FloatArray) -> FloatArray:
        """Return the same through the low-pass, without the orders that it lets through.

        ``model``: what the model makes of them, shape (2, samples): what moves the line is no order.
        """
        orders = _orders(self.signals, there, self.raw(there)[1] - model[1], highest_hz=self.highest_hz)
        smooth = _smooth(self.signals, there, highest_hz=self.highest_hz)
        smooth[1] -= low_pass(orders, self.signals.rate_hz, self.highest_hz)
        return smooth


def _raw(signals: Signals, there: slice) -> FloatArray:
    point = signals.working_point
    return np.stack(
        [
            deviation(signals.engine_speed.speed_rev_s[there], point.engine_speed_rev_s),
            deviation(signals.shaft_torque_nm[there], point.shaft_torque_nm),
        ]
    )


def _smooth(signals: Signals, there: slice, *, highest_hz: float) -> FloatArray:
    # what the filter reaches beyond either end belongs to the recording
    reach = reach_of_low_pass(signals.rate_hz, highest_hz)
    first = max(there.start - reach, 0)
    smooth = low_pass(_raw(signals, slice(first, there.stop + reach)), signals.rate_hz, highest_hz)
    return smooth[:, there.start - first : there.stop - first]


def _quiet(signals: Signals, there: slice, *, highest_hz: float) -> FloatArray:
    """Return what `_smooth` does, without the orders that stand in it."""
    smooth = _smooth(signals, there, highest_hz=highest_hz)
    smooth[1] -= _orders(signals, there, smooth[1], highest_hz=highest_hz)
    return smooth


def _orders(signals: Signals, there: slice, torque: FloatArray, *, highest_hz: float) -> FloatArray:
    """Return the orders below the cut-off in a torque of some samples over the working point, shape (samples,).

    They move with the speed, in and out of what the low-pass lets through: no noise of another level is like them.
    """
    rate_hz = signals.rate_hz
    speeds = {name: speed.values[there] for name, speed in signals.speeds.items()}
    every = order_bands(signals.orders, speeds, rate_hz=rate_hz)
    bands = [band for band in every if band.lowest_hz < _PASSED_TO * highest_hz]
    load = (speeds[signals.engine_speed.name] / signals.working_point.engine_speed_rev_s) ** 2
    waves = order_waves(bands, speeds, load, rate_hz=rate_hz)
    good = ~signals.coverage.lost(signals.start_s + np.arange(there.start, there.stop) / rate_hz)
    through_gears = any(band.order.through_gears for band in bands)
    stretch_s = _STRETCH_THROUGH_GEARS_S if through_gears else _STRETCH_S
    orders = np.zeros(torque.size)
    for part in np.array_split(np.arange(torque.size), max(round(torque.size / (stretch_s * rate_hz)), 1)):
        # a phase that turns evenly: to first order, what time makes of the waves
        of_time = [waves[:, part] * np.linspace(-1.0, 1.0, part.size)] if through_gears else []
        columns = np.concatenate([waves[:, part], *of_time, np.ones((1, part.size))]).T
        used = good[part]
        sizes, *_ = np.linalg.lstsq(columns[used], torque[part][used], rcond=None)
        orders[part] = columns[:, :-1] @ sizes[:-1]
    return orders


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Run:
    """A stretch of the recording around one record: its data, and what the model makes of it."""

    data: Data
    """The recording."""
    first: int
    """Sample of the recording with which it begins."""
    set_point: FloatArray
    """Set point, shape (samples,)."""
    measured: FloatArray
    """Measured speed and torque, shape (2, samples)."""
    measured_smooth: FloatArray
    """The same through the low-pass, the torque without orders, shape (2, samples)."""
    raw: FloatArray
    """Speed and torque of the model, shape (2, samples)."""
    smooth: FloatArray
    """The same through the low-pass, shape (2, samples)."""
    slopes: FloatArray
    """Derivatives of the latter to the free parameters, shape (free, 2, samples)."""

    def excerpt(self, excerpt: Excerpt, margin: int = 0) -> slice:
        """Return the samples of the run that an excerpt takes, with a margin at either end."""
        samples = self.data.places(excerpt.start_s, excerpt.stop_s)
        return slice(samples.start - self.first - margin, samples.stop - self.first + margin)

    def time_s(self, excerpt: Excerpt) -> FloatArray:
        """Return the times of the samples of an excerpt [s], shape (samples,)."""
        there = self.data.places(excerpt.start_s, excerpt.stop_s)
        return self.data.signals.start_s + np.arange(there.start, there.stop) / self.data.signals.rate_hz

    def compared(self, excerpt: Excerpt, *, settled_share: float) -> list[tuple[Unfiltered, Compared]]:
        """Return data and model of speed and of torque in an excerpt, at all frequencies and through the low-pass.

        ``settled_share`` is the share of a step's height within which it has settled.
        """
        there = self.excerpt(excerpt)
        load = self._load(there)
        variance = _noise_variance(self.data.raw_noise, there.stop - there.start, load)
        noise = self.data.noise.like(there.stop - there.start, load)
        return [
            (
                Unfiltered(
                    measured=self.measured[row, there], model=self.raw[row, there], noise_variance=variance[row]
                ),
                Compared(
                    output=output,
                    place=row,
                    measured=self.measured_smooth[row, there],
                    model=self.smooth[row, there],
                    slopes=self.slopes[:, row, there],
                    noise=noise,
                    reach=self._reach(excerpt, row, settled_share=settled_share) if noise.as_long else EVERYWHERE,
                ),
            )
            for row, output in enumerate(OUTPUTS)
        ]

    def _reach(self, excerpt: Excerpt, row: int, *, settled_share: float) -> Reach:
        """Return where in an excerpt the error of an output can lie."""
        if excerpt.lowest_hz is not None:
            return Swept(rate_hz=self.data.signals.rate_hz, lowest_hz=excerpt.lowest_hz)
        if excerpt.step_s is None:
            return EVERYWHERE
        time_s = self.time_s(excerpt) - excerpt.step_s
        model = self.smooth[row, self.excerpt(excerpt)]
        return while_settling(model, time_s, settled_share=settled_share, highest_hz=self.data.highest_hz)

    def noise_std(self, excerpt: Excerpt) -> FloatArray:
        """Return the standard deviation of the noise of speed and torque through the low-pass, shape (2,)."""
        there = self.excerpt(excerpt)
        return np.sqrt(_noise_variance(self.data.noise, there.stop - there.start, self._load(there)))

    def _load(self, there: slice) -> float:
        """Return the load of an excerpt: the median, since a step spends most of its time at the level it ends at."""
        return max(1.0 + float(np.median(self.measured_smooth[1, there])), LEAST_LOAD)


def _noise_variance(noise: QuietNoise, samples: int, load: float) -> list[float]:
    """Return the variance of the noise in an excerpt, of speed and of torque, with what it is off on average."""
    pieces = noise.like(samples, load).pieces
    return [
        float(np.mean(pieces[:, row] ** 2)) + load**2 * float(noise.offset_variance[row]) for row in range(len(OUTPUTS))
    ]


def run_model(
    model: Model,
    data: Data,
    excerpts: Sequence[Excerpt],
    settings: ValidationSettings,
    *,
    predict: Predict,
    quadratic_propeller: bool,
) -> Run:
    """Return what a model makes of the record that some excerpts are cut from.

    Raises ValidationError if the structure is not from ``n_set`` to ``n`` and ``M_s``.
    """
    begin, end = min(e.start_s for e in excerpts), max(e.stop_s for e in excerpts)
    there = data.places(begin - settings.lead_s, end + _BEHIND_S)
    set_point, rate_hz = data.set_point(there), data.signals.rate_hz
    raw, slopes = predict(
        model.structure,
        model.values,
        set_point,
        rate_hz=rate_hz,
        wanted=[p.name for p in model.structure.free] if model.has_uncertainty else [],
    )
    if quadratic_propeller:
        add_quadratic_torque(raw, slopes)
    if not model.has_uncertainty:
        slopes = np.zeros((len(model.structure.free), *raw.shape))
    return Run(
        data=data,
        first=there.start,
        set_point=set_point,
        measured=data.raw(there),
        measured_smooth=data.smooth(there, raw),
        raw=raw,
        smooth=low_pass(raw, rate_hz, settings.highest_hz),
        # in place: the derivatives of a chirp of ten minutes are most of the memory that a validation takes
        slopes=low_pass(slopes, rate_hz, settings.highest_hz, out=slopes),
    )


# Transition from pass to stop takes about 3.3 / length of a Hamming window: half of the cut-off frequency here.
_LENGTH_TIMES_CUT_OFF = 6.6
# A block of the convolution is so many times as long as the filter.
_BLOCK_OF_TAPS = 8


def reach_of_low_pass(rate_hz: float, highest_hz: float) -> int:
    """Return how many samples on either side of one go into it."""
    return int(np.ceil(0.5 * _LENGTH_TIMES_CUT_OFF * rate_hz / highest_hz))


def low_pass(values: FloatArray, rate_hz: float, highest_hz: float, *, out: FloatArray | None = None) -> FloatArray:
    """Return signals without what is faster than a frequency, neither late nor early, shape of ``values``.

    The ends are continued by their last value, so that half a filter's length from either end counts less.

    ``values``: signals along the last axis, shape (..., samples). ``rate_hz``, ``highest_hz``: sample rate and
    frequency at which half of the amplitude is left [Hz]. ``out``: where the result goes; ``values`` itself may be
    given.
    """
    if highest_hz >= rate_hz / 2.0:
        return values
    half = reach_of_low_pass(rate_hz, highest_hz)
    # a windowed sinc (Oppenheim and Schafer, "Discrete-Time Signal Processing", section 7.5)
    taps = np.sinc(2.0 * highest_hz / rate_hz * np.arange(-half, half + 1)) * np.hamming(2 * half + 1)
    taps /= taps.sum()
    size = 1 << (_BLOCK_OF_TAPS * taps.size).bit_length()
    response = np.fft.rfft(taps, size)
    smooth = np.empty_like(values) if out is None else out
    # one signal after the other: the transforms of all together would need several times their memory
    for row in np.ndindex(values.shape[:-1]):
        smooth[row] = _convolved(np.pad(values[row], half, mode="edge"), response, size, taps.size)
    return smooth


def _convolved(values: FloatArray, response: ComplexArray, size: int, taps: int) -> FloatArray:
    """Return where taps lie wholly on values, shape (values - taps + 1,): block by block, overlaps saved.

    The response is that of the taps at the frequencies of a block of ``size`` samples.
    """
    new = size - taps + 1
    out = np.empty(values.size - taps + 1)
    for first in range(0, out.size, new):
        block = np.fft.irfft(np.fft.rfft(values[first : first + size], size) * response, size)
        part = out[first : first + new]
        part[:] = block[taps - 1 : taps - 1 + part.size]
    return out
