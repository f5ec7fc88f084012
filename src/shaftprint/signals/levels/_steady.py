"""Stretches in which set point, speed and torque stand still, found from the signals themselves."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, in_blocks
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitations import Chirp, Sine
from shaftprint.campaign._leg import Leg
from shaftprint.signals._gaps import EVERYTHING, Coverage

_BLOCK_S = 1.0
_SHORTEST_S = 15
_SHORTEST_SETTLED_S = 8
_BATCH_BLOCKS = 8
_PRIOR_DEGREES = 4.0

# The set point stands still when it stays within this share of its whole range.
_TOLERANCE = 0.005
# The speed has settled when it is this near to where it ends, or within its own scatter.
_SETTLED, _SCATTERS = 5e-4, 4.0


@dataclass(frozen=True, kw_only=True, slots=True)
class SteadyStretch:
    """One stretch of standing still, after everything has settled."""

    start_s: float
    """When it begins, in seconds of the recording."""
    stop_s: float
    """When it ends, in seconds of the recording."""
    set_point_v: float
    """Mean set point [V]."""
    speed_rev_s: float
    """Mean engine speed [rev/s]."""
    speed_std_rev_s: float
    """Standard deviation of that mean [rev/s]."""
    torque_nm: float
    """Mean shaft torque [N m]."""
    torque_std_nm: float
    """Standard deviation of that mean [N m]."""

    @property
    def duration_s(self) -> float:
        """Its length [s]."""
        return self.stop_s - self.start_s


def steady_stretches(
    set_point_v: FloatArray,
    speed_rev_s: FloatArray,
    torque_nm: FloatArray,
    campaign: Campaign,
    *,
    rate_hz: float,
    start_s: float,
    coverage: Coverage = EVERYTHING,
) -> tuple[SteadyStretch, ...]:
    """Return every stretch of at least 15 s in which the set point stands still, in order of time.

    The crest of a slow sine stands nearly still too; therefore sines, legs and chirps of the campaign
    are left out.

    ``set_point_v``, ``speed_rev_s``, ``torque_nm``: signals on the grid, shape (samples,). ``campaign``: says where the
    sines, legs and chirps are. ``rate_hz``, ``start_s``: the grid. ``coverage``: says where the gaps are.
    """
    length = round(_BLOCK_S * rate_hz)
    means = [in_blocks(values, length).mean(axis=1) for values in (set_point_v, speed_rev_s, torque_nm)]
    starts = start_s + np.arange(means[0].size) * length / rate_hz
    complete = _without_gaps(starts, length / rate_hz, coverage)
    tolerance = _TOLERANCE * float(np.ptp(means[0][complete])) if complete.any() else 0.0
    still = (in_blocks(set_point_v, length).std(axis=1) <= tolerance) & complete
    still &= _outside_waves(starts, length / rate_hz, campaign)
    moved = np.abs(np.diff(means[0], prepend=means[0][:1])) > tolerance
    settled = [_settled(run, means[1]) for run in _runs(still, moved)]
    kept = [run for run in settled if run is not None]
    volts = [float(means[0][slice(*run)].mean()) for run in kept]
    speed, torque = (_means(values, kept) for values in means[1:])
    return tuple(
        SteadyStretch(
            start_s=float(starts[first]),
            stop_s=float(starts[stop - 1]) + length / rate_hz,
            set_point_v=volts[k],
            speed_rev_s=speed[k][0],
            speed_std_rev_s=speed[k][1],
            torque_nm=torque[k][0],
            torque_std_nm=torque[k][1],
        )
        for k, (first, stop) in enumerate(kept)
    )


def _settled(run: tuple[int, int], speed: FloatArray) -> tuple[int, int] | None:
    """Return the part of a run after everything has settled, or nothing if too little is left."""
    first, stop = run
    if stop - first < _SHORTEST_S:
        return None
    first += _settling(speed[first:stop])
    return (first, stop) if stop - first >= _SHORTEST_SETTLED_S else None


def _outside_waves(starts: FloatArray, length_s: float, campaign: Campaign) -> BoolArray:
    outside = np.ones(starts.size, dtype=np.bool_)
    for wave in campaign.excitations:
        if isinstance(wave, Sine | Chirp | Leg):
            outside &= (starts + length_s <= wave.start_s) | (starts >= wave.stop_s)
    return outside


def _without_gaps(starts: FloatArray, length_s: float, coverage: Coverage) -> BoolArray:
    complete = np.ones(starts.size, dtype=np.bool_)
    for gap in coverage.gaps:
        complete &= (starts + length_s <= gap.first_s) | (starts >= gap.last_s)
    return complete


def _runs(still: BoolArray, moved: BoolArray) -> list[tuple[int, int]]:
    """Return [first, stop) of every run of blocks that are still and did not move since the last."""
    runs = []
    first: int | None = None
    for k in range(still.size):
        if first is not None and (moved[k] or not still[k]):
            runs.append((first, k))
            first = None
        if first is None and still[k]:
            first = k
    if first is not None:
        runs.append((first, still.size))
    return runs


def _settling(speed: FloatArray) -> int:
    """Return how many blocks to leave out: twice as many as the speed needs to come near its end."""
    second_half = speed[speed.size // 2 :]
    final = float(np.median(second_half))
    scatter = 1.4826 * float(np.median(np.abs(second_half - final)))
    near = np.abs(speed - final) <= max(_SCATTERS * scatter, _SETTLED * abs(final))
    # three in a row: noise may leave the band again, and one block may only pass through it
    arrived = np.flatnonzero(near[:-2] & near[1:-1] & near[2:])
    return 2 * int(arrived[0]) + 1 if arrived.size else speed.size


def _means(values: FloatArray, runs: list[tuple[int, int]]) -> list[tuple[float, float]]:
    """Return mean and standard deviation of each run.

    The variance of a mean is that of batches, because neighbouring values are correlated. A run has few
    batches: its variance is drawn towards that of all runs.
    """
    densities, freedoms = [], []
    for run in runs:
        inside = values[slice(*run)]
        batch = min(_BATCH_BLOCKS, inside.size // 2)
        batches = in_blocks(inside, batch).mean(axis=1)
        densities.append(float(np.var(batches, ddof=1)) * batch)
        freedoms.append(batches.size - 1)
    density, freedom = np.array(densities), np.array(freedoms)
    common = float(density @ freedom) / max(float(freedom.sum()), 1.0)
    drawn = (freedom * density + _PRIOR_DEGREES * common) / (freedom + _PRIOR_DEGREES)
    return [
        (float(values[slice(*run)].mean()), float(np.sqrt(drawn[k] / (run[1] - run[0])))) for k, run in enumerate(runs)
    ]
