"""The gain of the torque gauge piece by piece, from what accelerates the shaft: no weather and no load moves that.

Fast motion asks the shaft behind the gauge for ``tau_dn du/dt``, whatever the propeller does: over a test it changes
with the gain of the gauge alone. With ``u`` the speed and ``q = u^2``, both over their means, the torque is

    m = g (tau_dn du/dt + smaller terms) + k q + lags of q + noise

whose numbers are fitted once, to the whole recording, with a ``k`` of its own in each piece of it, and ``g`` then to
each. The second derivative takes what is late, in the load by the derivative of ``q``; the third a line that twists a
little, the lags a slipstream that follows the propeller.
What disturbs the ship moves the speed as well, so that least squares would take noise for gain: the equations are
weighted with the motion that the set point makes, by the mean response of the recording (instrumental variables;
L. Ljung, "System Identification", 1999, section 7.6). A piece in which nothing is moved tells nothing and says so. The
noise is made white beforehand by its own autoregression; its size is that of the pieces around.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, IntArray, in_blocks

# Rate at which torque and speed are compared [Hz]: faster, the shaft twists.
_RATE_HZ = 20.0
# Length of the parts whose spectra tell how the speed follows the set point [s].
_PART_S = 10.0
# Times in which a slipstream follows [s].
_LAGS_S = (0.2, 0.8)
# Share of a value that a lag keeps of it and no number shows.
_FORGOTTEN = 1e-17
# Of the autoregression of the noise, and rounds in which it and the fit improve each other.
_ORDER, _ROUNDS = 20, 3
# Pieces on either side whose noise counts as that of a piece.
_AROUND = 4
# Parts and terms that accelerate the shaft, the first ones; the others are the propeller's.
_OF_GAIN = 3
# By how much the load of a piece may differ from that of the whole.
_LOAD_STD = 0.05
_NOTHING = 1e-10
# Of a gain that is told with this or less, nothing is known.
_NO_NEWS = 1e-6
# Share of what the pieces say of a course that the common terms must leave.
_TOLD_SHARE = 1e-3


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class FastGains:
    """Gain of the torque gauge in pieces of a recording, over that of the whole."""

    start_s: FloatArray
    """When each piece begins [s], shape (pieces,)."""
    stop_s: FloatArray
    """When it ends [s], shape (pieces,)."""
    told: FloatArray
    """Sums over each piece for the common terms and for its own gain, the load of the piece taken out: their products
    with each other, and last with what the common terms leave, over the variance of the noise, shape (pieces, terms
    + 1, terms + 2)."""
    scatter: FloatArray
    """Covariance of what the common terms leave in them, shape (pieces, terms + 1, terms + 1)."""
    inertia_s: float
    """Inertia behind the gauge, a time: ``tau_dn`` at the mean speed and torque [s]."""

    @property
    def gain(self) -> FloatArray:
        """Gain of each piece where the common terms are right [-], shape (pieces,)."""
        return np.asarray(1.0 + self.told[:, -1, -1] / np.maximum(self.told[:, -1, -2], _NO_NEWS))

    @property
    def std(self) -> FloatArray:
        """Its standard deviation; very large where nothing moves fast, shape (pieces,)."""
        news, known = self.scatter[:, -1, -1], np.maximum(self.told[:, -1, -2], _NO_NEWS)
        return np.asarray(np.where(news > 0.0, np.sqrt(news) / known, _NO_NEWS**-0.5))

    def of_courses(self, courses: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return what the pieces say of the size ``a`` of a change of the gain, whatever the common terms are.

        ``courses``: mean of each course in each piece, shape (pieces, courses). Returns ``b`` and ``p`` of the
        log-likelihood ``a b - a^2 p / 2``, each of shape (courses,).
        """
        own, common = self.told[:, -1, :], self.told[:, :-1, :].sum(axis=0)
        of_terms, against_terms = courses.T @ own[:, :-2], self.told[:, :-1, -2].T @ courses
        size = np.sqrt(np.maximum(np.abs(np.diag(common)), np.finfo(np.float64).tiny))
        inverse = np.linalg.pinv(common[:, :-2] / np.outer(size, size), rcond=_NOTHING) / np.outer(size, size)
        taken = of_terms @ inverse
        along = courses.T @ own[:, -1] - taken @ common[:, -1]
        alone = courses.T**2 @ own[:, -2]
        power = alone - np.sum(taken * against_terms.T, axis=1)
        # weights are not the terms themselves: what varies is not what is told
        varies = courses.T**2 @ self.scatter[:, -1, -1] - 2.0 * np.sum(
            courses.T @ self.scatter[:, -1, :-1] * taken, axis=1
        )
        varies += np.sum(taken @ self.scatter[:, :-1, :-1].sum(axis=0) * taken, axis=1)
        # what the common terms explain as well is no change
        is_told = (power > _TOLD_SHARE * alone) & (varies > 0.0)
        share = np.where(is_told, power / np.where(is_told, varies, 1.0), 0.0)
        return along * share, power * share


def fast_gains(
    set_point: FloatArray,
    speed: FloatArray,
    torque: FloatArray,
    *,
    rate_hz: float,
    start_s: float,
    border_s: FloatArray,
    whole: BoolArray,
) -> FastGains:
    """Return the gain of the gauge in each piece.

    ``set_point``, ``speed``, ``torque``: signals on the grid, in any unit, shape (samples,). ``rate_hz``, ``start_s``:
    the grid. ``border_s``: where one piece ends and the next begins [s], ascending, shape (pieces + 1,). ``whole``:
    which pieces hold no gap, shape (pieces,).
    """
    step = max(round(rate_hz / _RATE_HZ), 1)
    rate = rate_hz / step
    count = speed.size // step
    place = np.clip(np.round((border_s - start_s) * rate).astype(int), 0, count)
    pieces = [slice(first, stop) for first, stop in zip(place[:-1].tolist(), place[1:].tolist(), strict=True)]
    of_use = [piece for piece, is_whole in zip(pieces, whole, strict=True) if is_whole]
    used = np.zeros(count, dtype=np.bool_)
    for piece in of_use:
        used[piece] = True
    parts, motion, values = _parts_of_torque(set_point, speed, torque, rate_hz=rate_hz, step=step)
    terms, of_noise = _first_terms(parts, motion, values, of_use), (parts, motion, values)
    for _ in range(_ROUNDS):
        white = _whitening(values - parts @ _shares(terms), used)
        # freed before the next are made, which are as large
        del of_noise
        of_noise = (_filtered(white, parts), _filtered(white, motion), _filtered(white, values))
        terms = terms + _step(_told(*of_noise, terms, pieces, whole)[0])
    told, scatter = _told(*of_noise, terms, pieces, whole)
    return FastGains(start_s=border_s[:-1], stop_s=border_s[1:], told=told, scatter=scatter, inertia_s=float(terms[0]))


def _shares(terms: FloatArray) -> FloatArray:
    """Return what the torque has of each part: what is late is so in the torque that accelerates and in the load."""
    inertia, late_s, twist, *load = terms
    return np.array([inertia, inertia * late_s, twist, load[0] * late_s, *load])


def _slopes_of_shares(terms: FloatArray) -> FloatArray:
    """Return the slopes of the shares by the terms, by the load of a piece, and by its gain, (parts, terms + 2)."""
    inertia, late_s, _, *load = terms
    shares = _shares(terms)
    slopes = np.zeros((shares.size, terms.size + 2))
    slopes[:2, 0], slopes[[1, _OF_GAIN], 1], slopes[2, 2] = (1.0, late_s), (inertia, load[0]), 1.0
    slopes[[_OF_GAIN, _OF_GAIN + 1], _OF_GAIN] = late_s, 1.0
    slopes[_OF_GAIN + 2 :, _OF_GAIN + 1 : -2] = np.eye(len(_LAGS_S))
    slopes[_OF_GAIN:, -2], slopes[:_OF_GAIN, -1] = shares[_OF_GAIN:], shares[:_OF_GAIN]
    return slopes


def _first_terms(parts: FloatArray, motion: FloatArray, values: FloatArray, pieces: Sequence[slice]) -> FloatArray:
    """Return terms that are right for a load that is not late."""
    kept = np.arange(parts.shape[1]) != _OF_GAIN
    products = sum((motion[of].T @ parts[of] for of in pieces), np.zeros((kept.size, kept.size)))
    against = sum((motion[of].T @ values[of] for of in pieces), np.zeros(kept.size))
    terms = np.asarray(np.linalg.lstsq(products[np.ix_(kept, kept)], against[kept], rcond=None)[0])
    terms[1] /= terms[0] or 1.0
    return terms


def _told(
    parts: FloatArray,
    motion: FloatArray,
    values: FloatArray,
    terms: FloatArray,
    pieces: list[slice],
    whole: BoolArray,
) -> tuple[FloatArray, FloatArray]:
    """Return what each piece tells of the common terms and of its own gain, and its scatter, as in ``FastGains``."""
    left = values - parts @ _shares(terms)
    variance, slopes, load = _variance(left, pieces, whole), _slopes_of_shares(terms), terms.size
    told = np.zeros((len(pieces), terms.size + 1, terms.size + 2))
    scatter = np.zeros((len(pieces), terms.size + 1, terms.size + 1))
    for row in np.flatnonzero(whole & (variance > 0.0)).tolist():
        shown, moved, rest = parts[pieces[row]] @ slopes, motion[pieces[row]] @ slopes, left[pieces[row]]
        sums, varies = moved.T @ shown / variance[row], moved.T @ moved / variance[row]
        # the load of the piece is its own: one that differs between two speeds would pass for lags of it
        sums[load, load] += _LOAD_STD**-2.0
        varies[load, load] += _LOAD_STD**-2.0
        without = np.delete(np.eye(slopes.shape[1]), load, axis=0)
        without[:, load] = -np.delete(sums[:, load] / sums[load, load], load)
        own = without @ np.delete(sums, load, axis=1)
        # where the motion is not what the set point makes, its weights say nothing
        if own[-1, -1] > 0.0 and sums[-1, -1] > 0.0:
            told[row] = np.column_stack([own, without @ (moved.T @ rest) / variance[row]])
            scatter[row] = without @ varies @ without.T
    return told, scatter


def _step(told: FloatArray) -> FloatArray:
    """Return by how much the common terms are off where each piece has a load of its own, shape (terms,)."""
    common = told[:, :-1, :].sum(axis=0)
    return np.asarray(np.linalg.lstsq(common[:, :-2], common[:, -1], rcond=None)[0])


def _parts_of_torque(
    set_point: FloatArray, speed: FloatArray, torque: FloatArray, *, rate_hz: float, step: int
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the parts of the torque, the same of the motion that the set point makes, and the torque.

    The parts are derivatives of the speed, and its square: the derivative of that, itself, and behind lags.
    """
    rate = rate_hz / step
    relative = speed / speed.mean()
    square, moved = _means(relative**2, step), _means(relative, step)
    derivatives = []
    for _ in range(_OF_GAIN):
        # each is as long as the recording: one is kept at a time
        relative = _slopes(relative, rate_hz)
        derivatives.append(_means(relative, step))
    del relative
    parts = np.column_stack([*derivatives, np.gradient(square) * rate, square, *_lags(square, rate)])
    motion = 1.0 + _motion(_means(set_point, step), moved, rate)
    of_motion = [np.gradient(motion) * rate]
    for _ in range(_OF_GAIN - 1):
        of_motion.append(np.gradient(of_motion[-1]) * rate)
    # at each speed the load is as steep as it is there
    motion *= motion
    return (
        parts,
        np.column_stack([*of_motion, np.gradient(motion) * rate, motion, *_lags(motion, rate)]),
        _means(torque, step) / torque.mean(),
    )


def _slopes(values: FloatArray, rate_hz: float) -> FloatArray:
    """Return what ``np.gradient`` gives, which would hold three more arrays of that length for it."""
    slopes = np.empty_like(values)
    np.subtract(values[2:], values[:-2], out=slopes[1:-1])
    slopes[1:-1] /= 2.0
    slopes[0], slopes[-1] = values[1] - values[0], values[-1] - values[-2]
    slopes *= rate_hz
    return slopes


def _means(values: FloatArray, step: int) -> FloatArray:
    return np.asarray(in_blocks(values, step).mean(axis=1))


def _lags(values: FloatArray, rate_hz: float) -> list[FloatArray]:
    """Return values behind lags of first order."""
    lags = []
    for time_s in _LAGS_S:
        share = -np.expm1(-1.0 / (rate_hz * time_s))
        lags.append(values[0] + _followed(values - values[0], share))
    return lags


def _followed(values: FloatArray, share: float) -> FloatArray:
    """Return values behind a lag of first order that was at 0 before them."""
    # scipy.signal has it as well, and takes a second to load
    behind, reach = share * values, 1
    while reach < values.size and (1.0 - share) ** reach > _FORGOTTEN:
        behind[reach:] += (1.0 - share) ** reach * behind[:-reach]
        reach *= 2
    return behind


def _motion(set_point: FloatArray, speed: FloatArray, rate_hz: float) -> FloatArray:
    """Return the motion of the speed that follows the set point, by their mean response."""
    length = min(round(_PART_S * rate_hz), speed.size)
    taper = np.hanning(length)
    begins = np.arange(0, speed.size - length + 1, max(length // 2, 1))
    # of differences: what is slow would leak all over the spectrum
    asked, shown = (np.fft.rfft(_parts(of, begins, length) * taper) for of in (set_point, speed))
    power = np.sum(np.abs(asked) ** 2, axis=0)
    response = np.sum(asked.conj() * shown, axis=0) / np.maximum(power, np.finfo(np.float64).tiny)
    hertz, coarse = np.fft.rfftfreq(speed.size, 1.0 / rate_hz), np.fft.rfftfreq(length, 1.0 / rate_hz)
    between = np.interp(hertz, coarse, response.real) + 1j * np.interp(hertz, coarse, response.imag)
    return np.asarray(np.fft.irfft(np.fft.rfft(set_point - set_point.mean()) * between, speed.size))


def _parts(values: FloatArray, begins: IntArray, length: int) -> FloatArray:
    """Return the differences of values in parts of the recording, shape (parts, length)."""
    return np.asarray(np.diff(values, prepend=values[0])[begins[:, np.newaxis] + np.arange(length)])


def _whitening(noise: FloatArray, used: BoolArray) -> FloatArray:
    """Return the filter that makes noise white: of its difference, as the load wanders, an autoregression."""
    change = np.where(used[1:] & used[:-1], np.diff(noise), 0.0)
    related = np.array([change[: change.size - lag] @ change[lag:] for lag in range(_ORDER + 1)])
    related[0] = 1.000001 * related[0] + np.finfo(np.float64).tiny
    lags = np.arange(_ORDER)
    matrix = related[np.abs(lags[:, np.newaxis] - lags)]
    return np.convolve([1.0, -1.0], np.append(1.0, np.linalg.solve(matrix, -related[1:])))


def _filtered(taps: FloatArray, values: FloatArray) -> FloatArray:
    if values.ndim == 1:
        return np.convolve(values - values[0], taps)[: values.size]
    filtered = np.empty_like(values)
    for column in range(values.shape[1]):
        filtered[:, column] = _filtered(taps, values[:, column])
    return filtered


def _variance(noise: FloatArray, pieces: list[slice], whole: BoolArray) -> FloatArray:
    """Return the variance of the noise in each piece: the median of those around, or its own where that is larger."""
    own = np.array(
        [np.mean(noise[piece] ** 2) if is_whole else np.nan for piece, is_whole in zip(pieces, whole, strict=True)]
    )
    around = np.lib.stride_tricks.sliding_window_view(np.pad(own, _AROUND, constant_values=np.nan), 2 * _AROUND + 1)
    median = np.array([np.median(row[np.isfinite(row)]) if np.isfinite(row).any() else np.nan for row in around])
    return np.asarray(np.fmax(own, median))
