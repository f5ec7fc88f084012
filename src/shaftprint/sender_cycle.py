"""Whether messages were late, or the values that they hold: their stamps tremble in either case.

A sender works out a value at every cycle. Where it does so early or late and sends it at once, the stamps are the times
of the values. Where it keeps its cycle and the message waits for the bus, or for the computer that records, the values
are those of the cycle. Sines tell the two apart: taken at times that are wrong by ``e``, a sine leaves ``-e`` times its
slope.
"""

import math

import numpy as np

from shaftprint.arrays import FloatArray

# A sender that keeps a cycle has stamps that agree on its phase: of 1, with jitter of 15 % of a cycle 0.64 is left,
# with times that wander 0.
_LEAST_AGREEMENT = 0.3
# The period of a sender is known to this part from its messages; the cycle is sought on steps of a quarter of a turn.
_KNOWN, _TURN = 4e-3, 0.25
_FIRST_MESSAGES = 400
# The share of the jitter that is in the stamps alone must be above a half by so many standard deviations.
_SURE, _HALF = 3.0, 0.5


def times_of_course(
    time_s: FloatArray, residual: FloatArray, slope: FloatArray, *, rate_hz: float
) -> FloatArray | None:
    """Return when the values of messages were taken, where that is not at their stamps.

    Parameters
    ----------
    time_s
        The stamps [s], shape (messages,).
    residual
        What a course that was fitted at the stamps does not explain, shape (messages,).
    slope
        Slope of the course at the stamps [1/s], shape (messages,).
    rate_hz
        Messages a second, as a rule [Hz].

    Returns
    -------
    Times, shape (messages,); None where the stamps are those of the values, the sender keeps no cycle, or the course is
    too slow or too weak to tell.
    """
    late_s = behind_cycle(time_s, rate_hz)
    return None if late_s is None or not is_late_by(late_s, residual, slope) else time_s - late_s


def is_late_by(late_s: FloatArray, residual: FloatArray, slope: FloatArray) -> bool:
    """Return whether messages that are so late behind a cycle [s] hold values of the cycle; as `times_of_course`."""
    moved = -late_s * slope
    power = float(moved @ moved)
    if power == 0.0:
        return False
    share = float(residual @ moved) / power
    std = float(residual.std()) / math.sqrt(power)
    return share - _HALF > _SURE * std


def behind_cycle(time_s: FloatArray, rate_hz: float) -> FloatArray | None:
    """Return how late each message is behind its sender's cycle, within half a cycle [s]; None where there is none.

    The cycle is where the stamps agree most, found from the first messages on, with twice as many each time.
    """
    since_s = time_s - time_s[0]
    count, span_hz = min(_FIRST_MESSAGES, time_s.size), _KNOWN * rate_hz
    while True:
        first_s = since_s[:count]
        step_hz = _TURN / max(float(first_s[-1]), 1.0 / rate_hz)
        tried_hz = rate_hz + step_hz * np.arange(-math.ceil(span_hz / step_hz), math.ceil(span_hz / step_hz) + 1)
        agreement = [complex(np.exp(2j * np.pi * one * first_s).mean()) for one in tried_hz.tolist()]
        best = int(np.argmax(np.abs(agreement)))
        rate_hz, span_hz = float(tried_hz[best]), 2.0 * step_hz
        if count == time_s.size:
            break
        count = min(2 * count, time_s.size)
    if abs(agreement[best]) < _LEAST_AGREEMENT:
        return None
    turned = np.exp(2j * np.pi * rate_hz * since_s) * np.conj(agreement[best])
    return np.asarray(np.angle(turned) / (2.0 * np.pi * rate_hz))
