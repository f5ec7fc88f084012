"""How much orders of the shaft line and the noise of the gauge put on top of the shaft torque, from raw samples."""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray

if TYPE_CHECKING:
    from shaftprint.recording._channel import Channel
    from shaftprint.recording._recording import Recording
    from shaftprint.signals._signals import Signals
    from shaftprint.survey._trial import Trial

# Of each excitation so much is looked at, at its end [s].
_LONGEST_S = 20.0
# A mean with Hann's weights over so long follows nine tenths of what the set point moves at 1.2 Hz, and holds a tenth
# of an order of 5 Hz and next to nothing of faster ones [s].
_SLOW_S = 0.35
# Samples that a mean needs, and those that a share of one in a hundred needs.
_LEAST_MEAN, _LEAST_SAMPLES = 9, 1000
_PASSED_BY = 0.01


def torque_ripple(recording: "Recording", signals: "Signals", trial: "Trial") -> float | None:
    """Return what one sample in a hundred passes of the raw torque beside its slow mean, over the load.

    The load goes with the square of the momentary speed. The signals do not show it: they are smoother than the samples
    which the full scale of the telemetry cuts off.

    ``recording``: the raw recording, open. ``signals``: what was prepared of it. ``trial``: vessel with the sensor, and
    campaign with the excitations. Returns the ripple, or None where nothing of it is to be seen: gaps, or too few
    samples a second.
    """
    channel = recording.channel(trial.vessel.sensors.shaft_torque.channel)
    pieces = [
        _over_load(channel, signals, trial, max(one.start_s, one.stop_s - _LONGEST_S), one.stop_s)
        for one in trial.campaign.excitations
    ]
    ratios = np.concatenate([np.empty(0), *pieces])
    return max(0.0, float(np.quantile(ratios, 1.0 - _PASSED_BY))) if ratios.size >= _LEAST_SAMPLES else None


def _over_load(channel: "Channel", signals: "Signals", trial: "Trial", start_s: float, stop_s: float) -> FloatArray:
    """Return torque beside its slow mean over the load, shape (samples,); nothing where samples are missing."""
    count = round(_SLOW_S * channel.rate_hz) | 1
    first, last = (round((time_s - channel.start_s) * channel.rate_hz) for time_s in (start_s, stop_s))
    whole = count >= _LEAST_MEAN and first >= 0 and last <= channel.count and last - first > 2 * count
    if not whole or signals.coverage.missing(start_s, stop_s):
        return np.empty(0)
    torque_nm = trial.vessel.driving_torque_nm(channel.values(first, last))
    weights = np.hanning(count + 2)[1:-1]
    weights /= weights.sum()
    beside = torque_nm[count // 2 : -(count // 2)] - np.convolve(torque_nm, weights, mode="valid")
    time_s = channel.time_s(first + count // 2, last - count // 2)
    speed = signals.engine_speed.values
    # of the grid no more than the excitation and a sample on either side
    ends = (time_s[[0, -1]] - signals.start_s) * signals.rate_hz + [-1.0, 3.0]
    begin, end = np.clip(ends, 0, speed.size).astype(int).tolist()
    grid_s = signals.start_s + np.arange(begin, end) / signals.rate_hz
    speed_rev_s = np.interp(time_s, grid_s, speed[begin:end])
    point = signals.working_point
    load_nm = abs(point.shaft_torque_nm) * (speed_rev_s / point.engine_speed_rev_s) ** 2
    turning = load_nm > 0.0
    ratio = beside[turning] / load_nm[turning]
    return np.asarray(ratio[np.isfinite(ratio)])
