"""What a step response is described by: overshoot, rise time, settling time, peak and when it is reached.

Heights are from the mean before the step to the mean of the last third of the excerpt. The definitions are those of
Ogata, "Modern control engineering", section 5.3: the rise time is that from 10 to 90 % of the height, and a step has
settled when it stays within a share of the height. A response that goes beyond its end by less than that share has no
peak of which a time could be told.
"""

import numpy as np

from shaftprint.arrays import FloatArray

STEP_NUMBERS = {
    "overshoot": "%",
    "rise time": "s",
    "settling time": "s",
    "peak": "-",
    "peak time": "s",
}
"""Unit of each number; the peak is a deviation from the working point."""

_LOW, _HIGH = 0.1, 0.9
_LAST_SHARE = 1.0 / 3.0
# Hundreds of long responses together would need several times their memory.
_SAMPLES_AT_ONCE = 1 << 17


def step_numbers(values: FloatArray, time_s: FloatArray, *, settled_share: float) -> FloatArray:
    """Return the numbers of ``STEP_NUMBERS`` of step responses, shape (numbers, responses).

    A number that an excerpt does not show, such as the settling time of a response that does not settle in it, is not a
    number.

    ``values``: responses, shape (responses, samples). ``time_s``: time after the step [s], shape (samples,), negative
    before it. ``settled_share``: share of the height within which a response has settled.
    """
    blocks = -(-values.size // _SAMPLES_AT_ONCE)
    parts = np.array_split(values, min(blocks, len(values)))
    return np.concatenate([_of_block(part, time_s, settled_share) for part in parts], axis=1)


def _of_block(values: FloatArray, time_s: FloatArray, settled_share: float) -> FloatArray:
    after = time_s >= 0.0
    time, later = time_s[after], values[:, after]
    last = later.shape[1] - max(int(_LAST_SHARE * later.shape[1]), 1)
    before = values[:, ~after].mean(axis=1)
    final = later[:, last:].mean(axis=1)
    height = final - before
    share = (later - before[:, None]) / height[:, None]
    top = np.argmax(share, axis=1)
    peak, peak_time = _refined(share, top, time)
    return np.array(
        [
            100.0 * (peak - 1.0),
            _crossing(share, _HIGH, time) - _crossing(share, _LOW, time),
            _settled(share, settled_share, time, last),
            before + peak * height,
            np.where(peak - 1.0 >= settled_share, peak_time, np.nan),
        ]
    )


def _refined(share: FloatArray, top: FloatArray, time: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return height and time of the maxima, from the parabola through three samples."""
    rows = np.arange(share.shape[0])
    inner = np.clip(top, 1, share.shape[1] - 2)
    left, middle, right = (share[rows, inner + side] for side in (-1, 0, 1))
    bend = left - 2.0 * middle + right
    inside = (top == inner) & (bend < 0.0)
    shift = np.where(inside, 0.5 * (left - right) / np.where(inside, bend, 1.0), 0.0)
    height = np.where(inside, middle - 0.25 * (left - right) * shift, share[rows, top])
    step = time[1] - time[0]
    return height, np.where(inside, time[inner] + shift * step, time[top])


def _crossing(share: FloatArray, level: float, time: FloatArray) -> FloatArray:
    """Return when each response first reaches a share of its height [s], between the samples."""
    above = share >= level
    sample = np.argmax(above, axis=1)
    rows = np.arange(share.shape[0])
    before = np.maximum(sample - 1, 0)
    width = share[rows, sample] - share[rows, before]
    part = np.where(width > 0.0, (level - share[rows, before]) / np.where(width > 0.0, width, 1.0), 0.0)
    crossing = time[before] + part * (time[sample] - time[before])
    return np.where(above.any(axis=1), crossing, np.nan)


def _settled(share: FloatArray, settled_share: float, time: FloatArray, last: int) -> FloatArray:
    """Return from when on each response stays within a share of its height [s]; nan if it does so only at the end."""
    off = np.abs(share - 1.0)
    outside = off > settled_share
    sample = share.shape[1] - 1 - np.argmax(outside[:, ::-1], axis=1)
    rows = np.arange(share.shape[0])
    behind = np.minimum(sample + 1, share.shape[1] - 1)
    width = off[rows, sample] - off[rows, behind]
    part = np.where(width > 0.0, (off[rows, sample] - settled_share) / np.where(width > 0.0, width, 1.0), 0.0)
    settled = time[sample] + part * (time[behind] - time[sample])
    settled = np.where(outside.any(axis=1), settled, 0.0)
    return np.where(sample < last, settled, np.where(outside.any(axis=1), np.nan, 0.0))
