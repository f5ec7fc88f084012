"""Orders of a shaft without a pick-up of its own: the gear ratio of the vessel file is rounded.

A ratio of 3.82 may be 3.8167: over five minutes at 5 Hz the angle of the order is then wrong by one and a half turns,
and of an order taken out by it nothing is gone. The torque turned back by the angle shows the order as a slow rotation,
whose speed is the error of the ratio. There is one ratio for all orders of the shaft: the one that stands out most
gives it roughly, and least squares with all of them, at the bins that are no test lines, exactly. Of a rotation alone
the bins that are left out would be missed: an order beside a line was off by six deviations.
"""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace

import numpy as np

from shaftprint.arrays import BoolArray, ComplexArray, FloatArray
from shaftprint.spectra.orders._order_fit import fit_orders
from shaftprint.spectra.orders._order_waves import OrderBand, order_waves, turns_of

# Half a unit of the third digit of a ratio such as 3.82, and somewhat more.
_LARGEST_ERROR = 2e-3
# Frequencies for each bin, so that a rotation between two bins is found.
_FINER = 4
# Power over the median of the bins that noise has once in a million.
_LEAST_PEAK = 20.0
_STEPS = 4


def with_measured_gears(
    bands: Sequence[OrderBand],
    speeds_rev_s: Mapping[str, FloatArray],
    load: FloatArray,
    torque: ComplexArray,
    chosen: BoolArray,
    *,
    rate_hz: float,
    transform: Callable[[FloatArray], ComplexArray],
) -> tuple[OrderBand, ...]:
    """Return the bands with their orders as the torque shows them, where the angle comes through the gears.

    ``bands``: orders that are wanted; those of a shaft with a pick-up stay, and all where none stands out.
    ``speeds_rev_s``: engine speed of every pick-up by its name [rev/s], each of shape (samples,). ``load``: propeller
    load over that at the working point, shape (samples,). ``torque``: Fourier amplitudes of the torque, shape (bins,).
    ``chosen``: bins of the bands without test lines, shape (bins,). ``rate_hz``: rate of the samples [Hz].
    ``transform``: gives the Fourier amplitudes of waves, (waves, samples) to (waves, bins), as those of the torque were
    made.
    """
    if not any(band.order.through_gears for band in bands):
        return tuple(bands)
    rest = np.fft.irfft(np.where(chosen, torque, 0.0), n=load.size)
    noise = float(np.median(np.abs(torque[chosen]) ** 2))
    peaks = {}
    for band in bands:
        if band.order.through_gears:
            cosine, sine = order_waves([band], speeds_rev_s, load, rate_hz=rate_hz)
            order_hz = band.order.per_turn * float(speeds_rev_s[band.order.speed].mean())
            hertz, height = _rotation_hz(rest * (cosine - 1j * sine), _LARGEST_ERROR * order_hz, rate_hz)
            if height > _LEAST_PEAK * noise:
                # what an order tells of the ratio goes with the square of its turns
                peaks[band.order.name] = height * order_hz**2, hertz / order_hz
    if not peaks:
        return tuple(bands)
    _, error = max(peaks.values())
    rough = error
    for _ in range(_STEPS):
        turned = _with_ratio(bands, error)
        error += _step(turned, list(peaks), speeds_rev_s, load, torque, chosen, rate_hz=rate_hz, transform=transform)
    return _with_ratio(bands, error if abs(error) <= 2.0 * _LARGEST_ERROR else rough)


def _with_ratio(bands: Sequence[OrderBand], error: float) -> tuple[OrderBand, ...]:
    """Return the bands with the orders behind the gears as another ratio makes them."""
    return tuple(
        replace(band, order=replace(band.order, per_turn=band.order.per_turn * (1.0 + error)))
        if band.order.through_gears
        else band
        for band in bands
    )


def _step(
    bands: Sequence[OrderBand],
    seen: Sequence[str],
    speeds_rev_s: Mapping[str, FloatArray],
    load: FloatArray,
    torque: ComplexArray,
    chosen: BoolArray,
    *,
    rate_hz: float,
    transform: Callable[[FloatArray], ComplexArray],
) -> float:
    """Return by how much the ratio of the orders that are seen is still off (Gauss-Newton)."""
    waves = order_waves(bands, speeds_rev_s, load, rate_hz=rate_hz)
    columns = transform(waves)
    size = fit_orders(torque, columns, chosen).coefficient
    turning = np.zeros(load.size)
    for place, band in enumerate(bands):
        if band.order.name in seen:
            angle = 2.0 * np.pi * band.order.per_turn * turns_of(speeds_rev_s[band.order.speed], rate_hz)
            of_angle = size[2 * place + 1] * waves[2 * place] - size[2 * place] * waves[2 * place + 1]
            turning += (angle - angle.mean()) * of_angle
    further = transform(_LARGEST_ERROR * turning[np.newaxis])
    return _LARGEST_ERROR * float(fit_orders(torque, np.concatenate([columns, further]), chosen).coefficient[-1])


def _rotation_hz(turned: ComplexArray, largest_hz: float, rate_hz: float) -> tuple[float, float]:
    """Return the frequency of what is strongest in a record that was turned back [Hz], and its power.

    The highest of the finer bins, and from there the highest power by Newton's method.
    """
    power = np.abs(np.fft.fft(turned, n=_FINER * turned.size)) ** 2
    bin_hz = rate_hz / power.size
    reach = int(np.ceil(largest_hz / bin_hz))
    place = np.arange(-reach, reach + 1)
    strongest = int(place[np.argmax(power[place])])
    angle = 2.0 * np.pi * (np.arange(turned.size) - 0.5 * turned.size) / rate_hz
    hertz = strongest * bin_hz
    for _ in range(_STEPS):
        still = turned * np.exp(-1j * hertz * angle)
        total, first, second = (complex(np.sum((-1j * angle) ** order * still)) for order in range(3))
        slope = (total.conjugate() * first).real
        curvature = abs(first) ** 2 + (total.conjugate() * second).real
        hertz -= slope / curvature
    return hertz, float(power[strongest])
