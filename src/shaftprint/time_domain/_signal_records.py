"""From prepared signals to the records that are fitted in time.

The grid of a record is as coarse as its slowest sensor: 20 Hz by default, about the pulse rate of the thesis' engine
pick-up (one pulse a revolution, 19.7 Hz). A speed that is a spline through its pulses has no noise above half of their
rate: at the 200 Hz of the signals a whitening filter would find nine tenths of the band empty in it and give what is
left there, the errors of the interpolation, enormous weight. What drives the model stays on the grid of the signals,
so that steps stay sharp and nothing is interpolated coarsely; what it simulates goes through the same filter as the
data.
"""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Sine
from shaftprint.campaign._leg import Leg
from shaftprint.errors import SignalError
from shaftprint.signals._channel_signals import SpeedSignal
from shaftprint.signals._signals import Signals
from shaftprint.signals.levels._working_point import deviation
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._record import Record

RATE_HZ = 20.0
# Before an excitation begins the ship stands at the working point: a record sees a little of that.
BEFORE_S = 2.0
# Relative error of a rate that is rounding.
ROUNDING = 1e-9


def records_of(
    signals: Signals,
    campaign: Campaign,
    names: Sequence[str | Sequence[str]],
    *,
    rate_hz: float = RATE_HZ,
    settled: bool = False,
    speed: str | None = None,
) -> tuple[Record, ...]:
    """Cut excitations out of prepared signals, each as a record.

    Dropouts, saturated stretches and repairs longer than a sample of the record are gaps in it, as are those of the
    signals; what drives the model must be whole.

    Parameters
    ----------
    names
        Names of sines, chirps and staircases; several together, such as ``("C21", "C22", "C23")``, become one record
        from the start of the first to the end of the last.
    rate_hz
        Sample rate of the records [Hz], a whole fraction of the signals'. Choose about the pulse rate of the speed
        sensor: above half of it the speed holds neither response nor noise.
    settled
        Whether only the settled whole periods of a sine count, as for its frequency response; what comes before them
        drives the model all the same.
    speed
        Name of the speed sensor, by default the first of the vessel.

    Raises
    ------
    SignalError
        If an excitation or speed sensor is not known, the rates do not fit, the recording does not hold an excitation,
        or nothing of it is left.
    """
    excitations = {excitation.name: excitation for excitation in campaign.excitations}
    groups = [(name,) if isinstance(name, str) else tuple(name) for name in names]
    unknown = [name for group in groups for name in group if name not in excitations]
    if unknown or not all(groups):
        raise SignalError(
            f"campaign {campaign.name} has no excitation {', '.join(unknown) or 'in an empty group'}; it has "
            f"{', '.join(excitations)}."
        )
    if speed is not None and speed not in signals.speeds:
        raise SignalError(f"speed sensor {speed}: expected one of {', '.join(signals.speeds)}.")
    every = _every(signals.rate_hz, rate_hz)
    sensor = signals.engine_speed if speed is None else signals.speeds[speed]
    return tuple(_record(signals, [excitations[n] for n in group], sensor, every, settled=settled) for group in groups)


def _every(signals_hz: float, rate_hz: float) -> int:
    every = round(signals_hz / rate_hz) if rate_hz > 0.0 else 0
    if every < 1 or abs(every * rate_hz - signals_hz) > ROUNDING * signals_hz:
        raise SignalError(
            f"rate_hz = {rate_hz:g}: expected a whole fraction of the signals' rate of {signals_hz:g} Hz, such as "
            f"{signals_hz / 10:g}."
        )
    return every


def _record(
    signals: Signals, excitations: Sequence[Excitation], sensor: SpeedSignal, every: int, *, settled: bool
) -> Record:
    """Return one record; its first sample lies on the first sample of the signals at which it may begin."""
    excitations = sorted(excitations, key=lambda excitation: excitation.start_s)
    name = "+".join(excitation.name for excitation in excitations)
    margin = Decimator(every=every).half
    rate = signals.rate_hz
    first = max(int(np.ceil((excitations[0].start_s - BEFORE_S - signals.start_s) * rate - ROUNDING)), margin)
    stop = int(np.floor((excitations[-1].stop_s - signals.start_s) * rate + ROUNDING))
    stop = min(stop, signals.samples - margin)
    begins_late = first > (excitations[0].start_s - signals.start_s) * rate + ROUNDING
    count = (stop - 1 - first) // every + 1
    if begins_late or count < 1 or (excitations[-1].stop_s - signals.start_s) * rate > signals.samples + ROUNDING:
        raise SignalError(
            f"record {name}: expected signals from {excitations[0].start_s:g} to {excitations[-1].stop_s:g} s, found "
            f"them from {signals.start_s:g} to {signals.start_s + signals.samples / rate:g} s, of which the filter "
            f"needs {margin / rate:.2g} s at either end; leave this excitation out."
        )
    fine = slice(first - margin, first + (count - 1) * every + margin + 1)
    decimator = Decimator(every=every)
    point = signals.working_point
    drive = deviation(signals.set_point_rev_s[fine], point.engine_speed_rev_s)
    n = deviation(sensor.speed_rev_s[fine], point.engine_speed_rev_s)
    torque = deviation(signals.shaft_torque_nm[fine], point.shaft_torque_nm)
    start_s = signals.start_s + first / rate
    time = start_s + np.arange(count) * every / rate
    used = ~_repaired(signals, sensor, time, every) & ~_lost(signals, name, time, every)
    used &= _finite(decimator, n) & _finite(decimator, torque)
    if settled:
        used &= _settled(time, excitations)
    outputs = {"n": decimator.filtered(np.nan_to_num(n)), "M_s": decimator.filtered(np.nan_to_num(torque))}
    return Record(
        name=name,
        rate_hz=rate / every,
        start_s=start_s,
        inputs={"n_set": frozen_float(decimator.filtered(drive))},
        outputs={key: frozen_float(values) for key, values in outputs.items()},
        used=frozen_bool(used),
        drive={"n_set": frozen_float(drive)},
        every=every,
        load=load_of(outputs["n"], outputs["M_s"], used, rate / every),
        averaging_s=sensor.averaging_s,
        hold_s=sensor.hold_s,
        pick_up_delay_s=sensor.delay_s,
        engine_speed_rev_s=point.engine_speed_rev_s,
        shaft_torque_nm=point.shaft_torque_nm,
    )


def _settled(time_s: FloatArray, excitations: Sequence[Excitation]) -> BoolArray:
    """Return which samples lie in the settled whole periods of sines and legs, or in other excitations."""
    settled = np.zeros(time_s.size, dtype=np.bool_)
    for excitation in excitations:
        begin, end = excitation.start_s, excitation.stop_s
        if isinstance(excitation, Sine | Leg):
            begin, end = excitation.settled_s, excitation.window_stop_s
        settled |= (time_s >= begin) & (time_s < end)
    return settled


def _finite(decimator: Decimator, values: FloatArray) -> BoolArray:
    """Return which samples of the record come from finite values only."""
    lost = ~np.isfinite(values)
    if not lost.any():
        return np.ones((values.size - 2 * decimator.half - 1) // decimator.every + 1, dtype=np.bool_)
    sums = np.concatenate([[0], np.cumsum(lost)])
    begin = np.arange(0, values.size - 2 * decimator.half, decimator.every)
    return np.asarray(sums[begin + 2 * decimator.half + 1] == sums[begin])


def _repaired(signals: Signals, sensor: SpeedSignal, time_s: FloatArray, every: int) -> BoolArray:
    """Return which samples a repair reaches through the filter; shorter ones than a sample are as good as measured.

    The length of a repair of samples is counted at the rate of the signals: rather too long than too short, for the
    logger is faster.
    """
    others = {speed.channel for speed in signals.speeds.values() if speed.channel != sensor.channel}
    reach = Decimator(every=every).half / signals.rate_hz
    lost = np.zeros(time_s.size, dtype=np.bool_)
    for repair in signals.repairs:
        rate = sensor.pulse_rate_hz if repair.channel == sensor.channel else signals.rate_hz
        length = repair.count / rate
        unusable = repair.kind in ("dropout", "saturated") or length > every / signals.rate_hz
        if repair.channel not in others and unusable:
            lost |= (time_s > repair.time_s - reach) & (time_s < repair.time_s + length + reach)
    return lost


def _lost(signals: Signals, name: str, time_s: FloatArray, every: int) -> BoolArray:
    """Return which samples a gap of the signals reaches through the filter.

    Raises SignalError if the set point has a gap: what drove the ship is not known.
    """
    reach_s = Decimator(every=every).half / signals.rate_hz
    begin, end = float(time_s[0]) - reach_s, float(time_s[-1]) + reach_s
    lost = np.zeros(time_s.size, dtype=np.bool_)
    for gap in signals.coverage.touching(begin, end):
        if gap.channel == signals.channels["n_set"].channel:
            raise SignalError(
                f"record {name}: expected the set point from {begin:.1f} to {end:.1f} s, but {gap.sentence}; leave "
                "this excitation out."
            )
        lost |= (time_s > gap.first_s - reach_s) & (time_s < gap.last_s + reach_s)
    return lost


def load_of(n: FloatArray, torque: FloatArray, used: BoolArray, rate_hz: float) -> float:
    """Return the mean load over that of the working point: torque over the square of the speed; 1 where none is used.

    A record that ends faster than it began has accelerated the propeller: that torque is no load. Its size, the inertia
    time behind the gauge, is taken from the record.

    ``n``, ``torque``: deviations of speed and torque [-], shape (samples,). ``used``: which samples count, shape
    (samples,). ``rate_hz``: samples a second [Hz].
    """
    if not used.any():
        return 1.0
    square, whole = (1.0 + n[used]) ** 2, 1.0 + torque[used]
    rise = np.gradient(n)[used] * rate_hz if n.size > 1 else np.zeros(square.size)
    (_, inertia_s), *_ = np.linalg.lstsq(np.stack([square, rise], axis=1), whole, rcond=1e-9)
    mean = float(np.mean(whole)) - max(float(inertia_s), 0.0) * float(np.mean(rise))
    mean_square = float(np.mean(square))
    return mean / mean_square if mean > 0.0 and mean_square > 0.0 else 1.0
