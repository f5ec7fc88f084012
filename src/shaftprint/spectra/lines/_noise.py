"""Covariance of the noise under a line, from what the window shows beside the line.

The error of a fitted amplitude is the noise's own Fourier amplitude at the line. Two views on it are combined.

The residual's Fourier amplitudes at the bins on both sides are averaged as a matrix, so that correlation between
channels stays. Three things would make the plain mean wrong, and are put right first:

*The density falls or rises from bin to bin.* Ship noise falls steeply with frequency (slow changes of the propeller
load), so that under a line of a few periods the plain mean of the neighbours can be four times too large. Each
channel's local slope ``S ~ f^-a`` is therefore found (Whittle likelihood with weights that fall with the distance in
bins and in octaves, and a weak prior on ``a``), and the neighbours are brought to the line with it.

*The torque goes with the speed, but not at all bins alike.* What disturbs engine and governor moves the line as the
sine does: the torque follows the speed with the ratio ``a + j b f`` of load and inertia, which is found at the line
itself. Near the peak of the closed loop such noise is fifty times what the torque has of its own, and its change from
bin to bin would pass for noise of the torque: the standard deviation of their ratio, from which inertia and load slope
come, would be one and a half times too large. That change is taken out as far as it is there.

*What the torque has of its own has a slope of its own.* It is separated from what goes with the speed before the slopes
are found.

The mean is a Wishart matrix of the equivalent number of bins. Tests compare the stated covariance with the scatter over
repeated simulated windows, for white and ``1/f^2`` noise, correlated outputs, few periods, and noise through a shaft.
Scatter between the periods of the window would be another view of the same record; it sees a wider band still.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.spectra.lines._line_fit import LineFit

# Twice the reach halves the variance of the estimate, but smears humps: the surge against the mooring is four bins wide
# in a window of the thesis, the peak of the closed loop ten in one of half a minute.
_REACH_BINS = 7
# A line of few periods has half of its neighbours cut off by zero frequency: the others reach up to here.
_REACH_OF_FEW = 14
_REACH_RATIO = 3.5
_LEAST_REACH_BINS = 8
_SLOPE_PRIOR = 1.0
# Beside the broad slope of all ship noise, a hump may change the density e-fold within the reach of the neighbours.
_BROAD_SLOPE_STD = 2.0
_SLOPE_LIMIT = 2.0
# Fewer neighbours cannot afford more numbers; at low frequency the inertia turns the ratio little.
_FEWEST_TO_SEPARATE = 12
_ROUNDS = 3
_NOTHING = np.finfo(np.float64).tiny


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineNoise:
    """Covariance of the complex amplitudes of all channels at one frequency."""

    covariance: ComplexArray
    """``E[a a^H]`` of the noise amplitudes, Hermitian, shape (channels, channels)."""
    complex_samples: float
    """Number of independent complex samples behind it: half the real degrees of freedom."""

    def variance_of(self, place: int) -> float:
        """Return the variance ``E|a|^2`` of the amplitude of one channel."""
        return float(self.covariance[place, place].real)

    def with_torque_variance(self, torque: int, variance: float) -> "LineNoise":
        """Return the covariance with something more on one channel, unrelated to the others.

        ``torque``: place of the channel. ``variance``: variance ``E|a|^2`` that is added.
        """
        covariance = self.covariance.copy()
        covariance[torque, torque] += variance
        return replace(self, covariance=covariance)

    def with_share_of(self, speed: int, torque: int, share: complex) -> "LineNoise":
        """Return the covariance where a share of one channel was added to another, noise and all.

        ``speed``: place of the channel of which a share is added. ``torque``: place of the channel to which it is
        added. ``share``: how much of it.
        """
        mixing = np.eye(len(self.covariance), dtype=np.complex128)
        mixing[torque, speed] = share
        return replace(self, covariance=mixing @ self.covariance @ mixing.conj().T)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Neighbours:
    """Bins beside a line with their weights."""

    bins: FloatArray
    """Where they stand: number in the window, or frequency [Hz], shape (bins,)."""
    log_ratio: FloatArray
    """Logarithm of their frequency over that of the line, shape (bins,)."""
    weight: FloatArray
    """Their weights, 1 at the line, shape (bins,)."""
    related: FloatArray | None = None
    """Squared correlation of the noise in two of them, shape (bins, bins); unrelated where not given. Noise that swells
    and fades in time relates bins."""

    def square_sum(self, share: FloatArray) -> float:
        """Return ``sum(share^2)`` of unrelated bins, ``share^T R share`` of related ones.

        ``share``: how much the power in each bin counts, shape (bins,).
        """
        return float(share @ share if self.related is None else share @ self.related @ share)


@dataclass(frozen=True, kw_only=True, slots=True)
class ShaftRelation:
    """How the torque goes with the speed where both are moved from the engine's side."""

    speed: int
    """Place of the speed among the channels."""
    torque: int
    """Place of the torque among the channels."""
    ratio: complex
    """Torque over speed at the line: load slope and, imaginary, inertia."""

    def turn(self, distance: FloatArray) -> ComplexArray:
        """Return by how much the ratio differs beside the line.

        ``distance``: frequency over that of the line, minus 1, shape (bins,).
        """
        turned: ComplexArray = (1j * self.ratio.imag * distance).astype(np.complex128)
        return turned


def residual_spectrum(fit: LineFit) -> ComplexArray:
    """Return the residual's Fourier amplitudes, ``2/N`` times the DFT, shape (channels, bins)."""
    spectrum: ComplexArray = np.fft.rfft(fit.residual, axis=1)
    spectrum *= 2.0 / fit.residual.shape[1]
    return spectrum


def line_noise(
    spectrum: ComplexArray,
    *,
    periods: int,
    order: int = 1,
    relation: ShaftRelation | None = None,
    taken: FloatArray | None = None,
) -> LineNoise:
    """Estimate the covariance of the noise under a line or under one of its harmonics.

    ``spectrum``: Fourier amplitudes of the residual, shape (channels, bins). ``periods``: number of periods in the
    window. ``order``: 1 for the line itself, 2 and 3 for its harmonics. ``relation``: how the torque goes with the
    speed; taken as unrelated when not given. ``taken``: share of the noise of the torque in each bin that the orders of
    the shaft have taken with them, shape (bins,). Returns the covariance with the number of complex samples behind it.
    """
    neighbours = _neighbours(spectrum.shape[1], periods, order)
    # what the drift in the fit takes from the neighbours, it adds to the uncertainty of the line
    kept = _kept_by_drift(neighbours.bins) * _kept_by_drift(np.array([float(order * periods)]))
    near = neighbours.bins.astype(np.int64)
    of_torque = None if taken is None else taken[near]
    return noise_from_neighbours(spectrum[:, near], neighbours, relation, kept=kept, taken=of_torque)


def noise_from_neighbours(
    values: ComplexArray,
    neighbours: Neighbours,
    relation: ShaftRelation | None = None,
    *,
    kept: FloatArray | float = 1.0,
    taken: FloatArray | None = None,
) -> LineNoise:
    """Estimate the covariance of the noise under a line from amplitudes beside it.

    ``values``: Fourier amplitudes where there is noise alone, shape (channels, bins). ``neighbours``: where they stand,
    with their weights. ``relation``: how the torque goes with the speed at the line; taken as unrelated when not given.
    ``kept``: share of the power of each bin that is left in the amplitudes, shape (bins,). ``taken``: share of the
    noise of the torque in each bin that the orders of the shaft have taken with them, shape (bins,): what is left is
    enlarged, and the number of samples is smaller by that much. Returns the covariance with the number of complex
    samples behind it.
    """
    chosen = values
    samples = equivalent_samples(neighbours)
    if taken is not None and relation is not None:
        chosen = values.copy()
        chosen[relation.torque] /= np.sqrt(1.0 - taken)
        samples *= 1.0 - float(neighbours.weight @ taken / neighbours.weight.sum())
    mixing = np.eye(len(chosen), dtype=np.complex128)
    if relation is not None and neighbours.bins.size >= _FEWEST_TO_SEPARATE:
        chosen = chosen.copy()
        chosen[relation.torque], mixing[relation.torque, relation.speed] = _own_torque(chosen, relation, neighbours)
    level = levelled(chosen, neighbours)
    weight = neighbours.weight / neighbours.weight.sum() / kept
    covariance = mixing @ (level * weight) @ level.conj().T @ mixing.conj().T
    return LineNoise(covariance=covariance, complex_samples=samples)


def _own_torque(values: ComplexArray, relation: ShaftRelation, neighbours: Neighbours) -> tuple[ComplexArray, complex]:
    """Return what the torque has of its own at the bins, and the share of the speed that it has at the line.

    The change from bin to bin that the ratio at the line predicts is taken out as far as it is there: not at all where
    the noise comes from the load.
    """
    torque, speed = values[relation.torque], values[relation.speed]
    turning = relation.turn(np.expm1(neighbours.log_ratio)) * speed
    independent, share = torque, 0j
    # weights of the mean over the bins, first with the slope of the torque as it is, then of what it has of its own
    for _ in range(_ROUNDS):
        slopes = _local_slope(np.abs(np.stack([independent, speed])) ** 2, neighbours)
        weight = neighbours.weight * np.exp(0.5 * slopes.sum() * neighbours.log_ratio)
        power = float(weight @ np.abs(speed) ** 2) + _NOTHING
        bend = turning - complex(weight * speed.conj() @ turning) / power * speed
        present = float((weight * bend.conj() @ torque).real) / (float(weight @ np.abs(bend) ** 2) + _NOTHING)
        unrelated = torque - min(max(present, 0.0), 1.0) * turning
        share = complex(weight * speed.conj() @ unrelated) / power
        independent = unrelated - share * speed
    return independent, share


def levelled(values: ComplexArray, neighbours: Neighbours) -> ComplexArray:
    """Return the amplitudes at the bins as large as they would be at the line, each channel by its own slope.

    Their mean power is that at the line: what the slope, which is fitted to them, takes of it is given back.

    ``values``: Fourier amplitudes where there is noise alone, shape (channels, bins). ``neighbours``: where they stand,
    with their weights.
    """
    slope = _local_slope(np.abs(values) ** 2, neighbours)
    growth = np.exp(0.5 * slope[:, np.newaxis] * neighbours.log_ratio)
    level: ComplexArray = np.sqrt(_slope_allowance(neighbours)) * growth * values
    return level


def _neighbours(bins: int, periods: int, order: int) -> Neighbours:
    line = periods * order
    reach_ratio = max(_REACH_RATIO, (line + _LEAST_REACH_BINS) / line)
    reach = max(_REACH_BINS, _REACH_OF_FEW - line)
    lowest = max(line - reach, int(np.ceil(line / reach_ratio)), 1)
    # the drift in the fit has taken most of the power of the first bin
    lowest = 2 if lowest == 1 and line > 3 else lowest
    highest = min(line + reach, int(line * reach_ratio), bins - 1)
    number = np.arange(lowest, highest + 1)
    number = number[number % periods != 0].astype(np.float64)
    log_ratio = np.log(number / line)
    octaves = 1.0 - (log_ratio / np.log(1.05 * reach_ratio)) ** 2
    distance = 1.0 - ((number - line) / (reach + 1.0)) ** 2
    return Neighbours(bins=number, log_ratio=log_ratio, weight=octaves * distance)


def _kept_by_drift(place: FloatArray) -> FloatArray:
    """Share of the power of bin ``m`` that is not explained by a straight line and a parabola.

    The straight line takes ``6 / (pi m)^2`` of the power of the bin's sine part, the parabola ``90 / (pi m)^4`` of its
    cosine part: squared Fourier coefficients of the first two Legendre polynomials.
    """
    kept: FloatArray = 1.0 - 3.0 / (np.pi * place) ** 2 - 45.0 / (np.pi * place) ** 4
    return kept


def _local_slope(power: FloatArray, neighbours: Neighbours) -> FloatArray:
    """Find the exponent ``a`` of ``S ~ f^-a`` of each channel: Newton steps on a convex profile likelihood.

    ``power``: squared magnitudes at the bins, shape (channels, bins). ``neighbours``: the bins. Returns the exponents,
    shape (channels,); without contrast between the bins about 1.
    """
    weight, log_ratio = neighbours.weight, neighbours.log_ratio
    prior_std = _slope_std(neighbours)
    lowest, highest = _SLOPE_PRIOR - _SLOPE_LIMIT * prior_std, _SLOPE_PRIOR + _SLOPE_LIMIT * prior_std
    total = weight.sum()
    relative = power / np.maximum(power.mean(axis=1, keepdims=True), np.finfo(np.float64).tiny)
    slope = np.full(len(power), _SLOPE_PRIOR)
    for _ in range(12):
        share = weight * relative * np.exp(slope[:, np.newaxis] * log_ratio) + 1e-300
        share /= share.sum(axis=1, keepdims=True)
        centre = share @ log_ratio
        spread = share @ log_ratio**2 - centre**2
        gradient = total * centre - weight @ log_ratio + (slope - _SLOPE_PRIOR) / prior_std**2
        step = gradient / (total * spread + 1.0 / prior_std**2)
        slope = np.clip(slope - np.clip(step, -1.0, 1.0), lowest, highest)
    return slope


def equivalent_samples(neighbours: Neighbours) -> float:
    """Return the equivalent number of bins: variance of the level, with the part that the unknown slope adds."""
    weight, (deviation, _, information) = neighbours.weight, _about_centre(neighbours)
    centre = neighbours.log_ratio[0] - deviation[0]
    return 1.0 / neighbours.square_sum(weight / weight.sum() - centre * weight * deviation / information)


def _slope_allowance(neighbours: Neighbours) -> float:
    """Return by what factor the mean over the levelled bins is too small, because their slope was fitted to them.

    The slope makes the mean as small as it can. To second order, with ``w`` the weights, ``x`` the centred logarithms
    of frequency and ``t`` the prior's information, it takes ``sum(w^2 x^2) / H (1 - sum(w x^2) / 2 H) / sum(w)`` of
    it, ``H = sum(w x^2) + t``.
    """
    weight, (deviation, of_bins, information) = neighbours.weight, _about_centre(neighbours)
    taken = neighbours.square_sum(weight * deviation) / information * (1.0 - 0.5 * of_bins / information)
    return float(np.exp(taken / weight.sum()))


def _about_centre(neighbours: Neighbours) -> tuple[FloatArray, float, float]:
    """Return the centred logarithms of frequency, and what is known of the slope from the bins and in all."""
    weight = neighbours.weight
    deviation = neighbours.log_ratio - (weight @ neighbours.log_ratio) / weight.sum()
    of_bins = float(weight @ deviation**2)
    return deviation, of_bins, of_bins + 1.0 / _slope_std(neighbours) ** 2


def _slope_std(neighbours: Neighbours) -> float:
    """Return the standard deviation of the prior of the slopes: over a narrow reach a hump makes steep ones."""
    return float(np.hypot(_BROAD_SLOPE_STD, 1.0 / np.abs(neighbours.log_ratio).max()))
