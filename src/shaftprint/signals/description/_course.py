"""The recorded set point on its grid, its noise, and the set point between all tests."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import FloatArray, in_blocks, runs_of

# A window that is flat for so long is not the crest of a sine of the tests' size [s].
FLAT_S = 1.0
# Noise of one sample, in its standard deviations, within which a flat stretch lies; and as a share of all motion.
_FLAT_STDS, _FLAT_SHARE, _QUIET_SHARE = 6.0, 0.002, 2e-4
# A slow sine passes the offset in a straight line: the thirds of a quiet stretch may not differ by more of its width.
_LEVEL_SHARE = 0.4
# Means of a second differ by so many of their standard deviations at most where the set point stands.
_MEAN_STDS, _FEWEST_FLAT = 5.0, 2
# Share of the samples that are independent: they come through a filter.
_INDEPENDENT = 0.3
# Each flat stretch counts for so long at most: the level to which most of them return is wanted, not the longest.
_COUNTED_S = 5.0
# The quietest windows show the noise.
_QUIETEST = 0.02


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Course:
    """The recorded set point on its grid."""

    values_v: FloatArray
    """Set point [V], shape (samples,)."""
    rate_hz: float
    """Samples a second [Hz]."""
    start_s: float
    """Time of the first sample [s]."""
    noise_v: float
    """Standard deviation of a sample where the set point stands [V]."""
    range_v: float
    """From its lowest to its highest value [V]."""
    offset_v: float
    """The level to which it returns between the tests [V]."""

    @property
    def flat_v(self) -> float:
        """How far a sample is from a level at which the set point stands, at most [V]."""
        return _FLAT_STDS * self.noise_v + _FLAT_SHARE * self.range_v

    @property
    def count(self) -> int:
        """Number of samples."""
        return int(self.values_v.size)

    def times(self, first: int, stop: int) -> FloatArray:
        """Return the times of samples [s], shape (stop - first,)."""
        return self.start_s + np.arange(first, stop) / self.rate_hz

    def index(self, time_s: float) -> int:
        """Return the first sample that is not before a time, within the recording."""
        place = int(np.ceil((time_s - self.start_s) * self.rate_hz - 1e-6))
        return min(max(place, 0), self.count)

    def quiet(self) -> list[tuple[int, int]]:
        """Return the stretches between the tests, as first sample and the one behind the last."""
        width_v = _FLAT_STDS * self.noise_v + _QUIET_SHARE * self.range_v
        beside = np.abs(self.values_v - self.offset_v) <= width_v
        found = []
        for first, stop in runs_of(beside):
            third = (stop - first) // 3
            if stop - first < FLAT_S * self.rate_hz:
                continue
            rise = self.values_v[stop - third : stop].mean() - self.values_v[first : first + third].mean()
            if abs(float(rise)) <= _LEVEL_SHARE * width_v:
                found.append((first, stop))
        return found


def course_of(values_v: FloatArray, *, rate_hz: float, start_s: float) -> Course:
    """Return a set point with its noise, and the level to which it returns.

    ``values_v``: set point on the grid [V], shape (samples,). ``rate_hz``, ``start_s``: the grid.
    """
    window = max(round(FLAT_S * rate_hz), 4)
    blocks = in_blocks(values_v, window)
    spread = blocks.std(axis=1)
    noise_v = float(np.quantile(spread, _QUIETEST)) if spread.size else 0.0
    range_v = float(np.ptp(np.quantile(values_v, [0.001, 0.999])))
    flat_v = _FLAT_STDS * noise_v + _FLAT_SHARE * range_v
    offset_v = _returned_to(values_v, flat_v=flat_v, noise_v=noise_v, rate_hz=rate_hz)
    return Course(
        values_v=values_v, rate_hz=rate_hz, start_s=start_s, noise_v=noise_v, range_v=range_v, offset_v=offset_v
    )


def _returned_to(values_v: FloatArray, *, flat_v: float, noise_v: float, rate_hz: float) -> float:
    """Return the level that most flat stretches have [V]; the middle of all values where none is flat."""
    window = max(round(FLAT_S * rate_hz), 2)
    blocks = in_blocks(values_v, window)
    means = blocks.mean(axis=1)
    flat = np.ptp(blocks, axis=1) <= 2.0 * flat_v
    allowed_v = _MEAN_STDS * noise_v / np.sqrt(_INDEPENDENT * window) + 1e-3 * flat_v
    same = flat[1:] & flat[:-1] & (np.abs(np.diff(means)) <= allowed_v)
    stretches = [(a, b + 1) for a, b in runs_of(same) if b + 1 - a >= _FEWEST_FLAT]
    if not stretches:
        return 0.5 * float(values_v.min() + values_v.max())
    levels = np.array([means[a:b].mean() for a, b in stretches])
    weights = np.minimum([(b - a) * window / rate_hz for a, b in stretches], _COUNTED_S)
    weights[[0, -1]] *= 2.0
    near = np.abs(levels[:, np.newaxis] - levels) <= flat_v
    best = int(np.argmax(near @ weights))
    chosen = np.concatenate([means[a:b] for (a, b), same in zip(stretches, near[best], strict=True) if same])
    return float(chosen.mean())
