"""Lines of a period and what they do to the bounds of a leg, in time, with the gradient of a smooth largest use."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Self

import numpy as np
import scipy

from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.design.motion._bound import Bound

# Samples a period of the fastest line.
SAMPLES_PER_PERIOD = 8
# Powers of uses that are smaller than this against the largest one are left out of a sum of powers.
_NEGLIGIBLE = 1e-9
# Ships with the highest crests, in whose time beyond a bound is looked; and how often a strength is halved for it.
_WORST_SHIPS, _HALVINGS = 12, 20


def samples_of_period(highest_harmonic: int, samples_per_period: float) -> int:
    """Return a power of two of samples in which the fastest line has at least so many a period of its own."""
    samples: int = 2 ** int(np.ceil(np.log2(samples_per_period * highest_harmonic)))
    return samples


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Uses:
    """Uses of bounds over one period: signal over room, linear in the complex amplitudes of the lines."""

    transfer: ComplexArray
    """Use of each row for a unit of amplitude of each line, shape (rows, lines)."""
    harmonics: tuple[int, ...]
    """Harmonics of the period that the lines are."""
    samples: int
    """Samples a period."""
    draws: int
    """Number of possible ships; rows are bound by bound, and these in each."""

    @classmethod
    def of(cls, responses: ComplexArray, bounds: tuple[Bound, ...], harmonics: tuple[int, ...], fold: int = 1) -> Self:
        """Return the uses of every bound by every possible ship, rows bound by bound.

        ``responses``: responses of ``SIGNALS`` to the set point, shape (possible lines, signals, lines). ``harmonics``:
        harmonics of the lines. ``fold``: how many times more samples than usual are taken.
        """
        weights = np.array([bound.weights / bound.free for bound in bounds])
        transfer = np.einsum("bs,dsk->bdk", weights, responses).reshape(-1, len(harmonics))
        samples = samples_of_period(harmonics[-1], fold * SAMPLES_PER_PERIOD)
        return cls(transfer=transfer, harmonics=harmonics, samples=samples, draws=responses.shape[0])

    def in_time(self, amplitudes: ComplexArray) -> FloatArray:
        """Return the uses ``Re sum_k H_k c_k exp(j 2 pi h_k t / T)`` over one period, shape (rows, samples)."""
        spectrum = np.zeros((self.transfer.shape[0], self.samples // 2 + 1), dtype=np.complex128)
        spectrum[:, self.harmonics] = 0.5 * self.samples * self.transfer * amplitudes
        return np.fft.irfft(spectrum, n=self.samples, axis=1)

    def largest(self, amplitudes: ComplexArray) -> FloatArray:
        """Return the largest use of each bound by each possible ship, shape (bounds, draws)."""
        return np.asarray(self.in_time(amplitudes).max(axis=1).reshape(-1, self.draws))

    def strengths(self, amplitudes: ComplexArray, bounds: tuple[Bound, ...], share_over: float) -> FloatArray:
        """Return how many times as strong the lines may be for each bound, shape (bounds,).

        With the noise on top, normal and of any colour, every possible ship is beyond the bound for a share of the time
        at most; without it, never.

        ``amplitudes``: complex amplitudes of the lines. ``bounds``: the bounds that the rows are of. ``share_over``:
        share of the time.
        """
        every = self.in_time(amplitudes).reshape(len(bounds), self.draws, self.samples)
        largest = every.max(axis=2)
        return np.array(
            [
                _strength(
                    signals[np.argsort(peaks)[-_WORST_SHIPS:]] * (bound.free / bound.room),
                    bound.noise / bound.room,
                    share_over,
                )
                for bound, signals, peaks in zip(bounds, every, largest, strict=True)
            ]
        )

    def norm(self, amplitudes: ComplexArray, power: float) -> tuple[float, ComplexArray]:
        """Return the p-norm of all positive uses over one period, and its gradient.

        ``P = (sum_rows mean_t u_+^p)^(1/p)``: near the largest use for a large ``p``, and smooth.

        Returns ``P``, and ``dP/dRe c + j dP/dIm c``, shape (lines,).
        """
        use = self.in_time(amplitudes)
        highest = float(use.max())
        share = use / highest
        counted = share > _NEGLIGIBLE ** (1.0 / power)
        near = share[counted]
        slope = near ** (power - 1.0)
        total = float(np.sum(slope * near)) / self.samples
        norm = highest * total ** (1.0 / power)
        weights = np.zeros_like(use)
        weights[counted] = slope * (total ** (1.0 / power - 1.0) / self.samples)
        back = np.fft.rfft(weights, axis=1)[:, self.harmonics]
        return norm, np.asarray(np.sum(self.transfer.conj() * back, axis=0))

    def of_draws(self, places: IntArray) -> "Uses":
        """Return the uses by some of the possible ships."""
        table = self.transfer.reshape(-1, self.draws, len(self.harmonics))[:, places]
        return Uses(
            transfer=table.reshape(-1, len(self.harmonics)),
            harmonics=self.harmonics,
            samples=self.samples,
            draws=len(places),
        )

    def highest(self, amplitudes: ComplexArray, places: IntArray, count: int) -> "Uses":
        """Return the uses by those lines, among some, whose largest use is highest."""
        worst = self.largest(amplitudes)[:, places].max(axis=0)
        return self.of_draws(places[np.argsort(worst, kind="stable")[-count:]])


def _strength(signals: FloatArray, noise: float, share_over: float) -> float:
    """Return how many times as strong signals over their room may be, shape (ships, samples), by halving."""
    strongest = 1.0 / float(_crests(signals).max())
    if noise == 0.0:
        return strongest

    def share(strength: float) -> float:
        return float(scipy.special.ndtr((strength * signals - 1.0) / noise).mean(axis=1).max())

    low, high = 0.0, strongest
    if share(high) <= share_over:
        return high
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if share(middle) > share_over else (middle, high)
    return low


def _crests(signals: FloatArray) -> FloatArray:
    """Return the highest value of each periodic signal, between its samples too: the top of a parabola."""
    places, rows = np.argmax(signals, axis=1), np.arange(len(signals))
    before, at, after = (signals[rows, (places + step) % signals.shape[1]] for step in (-1, 0, 1))
    bend = 2.0 * at - before - after
    return np.asarray(at + np.where(bend > 0.0, (after - before) ** 2 / (8.0 * np.maximum(bend, 1e-300)), 0.0))


def held_draws(uses: Sequence[Uses], amplitudes: Sequence[ComplexArray], share: float) -> IntArray:
    """Return that share of the possible ships for which the legs ask least, as places of draws, ascending.

    A ship that asks for much in one leg does so in the others: where the limits of all legs hold for the same ships,
    fewer have to be allowed for than if each leg left out its own.
    """
    worst = [use.largest(leg).max(axis=0) for use, leg in zip(uses, amplitudes, strict=True)]
    relative = np.max([one / np.median(one) for one in worst], axis=0)
    return np.sort(np.argsort(relative, kind="stable")[: int(np.ceil(share * relative.size))])
