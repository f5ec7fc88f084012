"""Ways to spoil a recording or the files that describe it; each returns what changes one trial."""

from collections.abc import Callable
from dataclasses import replace
from functools import partial

import numpy as np
from scipy.signal import butter, sosfilt
from tests.wrong_recordings.trial import TORQUE, TWO_SPEEDS, Change, Trial, Values, clean, of_ship

from shaftprint.campaign import Multisine
from shaftprint.recording import ClockJump


def changed(channel: str, of: Callable[[Values, Values], Values]) -> Change:
    """Apply a function of time [s] and values to a channel."""
    return lambda trial: trial.with_values(channel, of(trial.time_s(channel), trial.values(channel)))


def both(*changes: Change) -> Change:
    """Apply one change after the other."""

    def applied(trial: Trial) -> Trial:
        for change in changes:
            trial = change(trial)
        return trial

    return applied


def within(change: Change, first_s: float, last_s: float = np.inf) -> Change:
    """Apply a change to samples between two instants only, such as those of one leg."""

    def applied(trial: Trial) -> Trial:
        spoilt = change(trial)
        for name in trial.recording.channels:
            time, before, after = trial.time_s(name), trial.values(name), spoilt.values(name)
            inside = (time >= first_s) & (time < last_s)
            if not np.array_equal(before, after):
                spoilt = spoilt.with_values(name, np.where(inside, after, before))
        return spoilt

    return applied


def another_ship(first_s: float, last_s: float = np.inf, **tug: object) -> Change:
    """Take what another ship did in the two-speed test between two instants."""
    return within(lambda trial: replace(trial, recording=clean(of_ship(TWO_SPEEDS, tug))[0].recording), first_s, last_s)


def exchanged(one: tuple[float, float], other: tuple[float, float]) -> Change:
    """Exchange two stretches of one length in all channels."""

    def applied(time: Values, values: Values) -> Values:
        first, second = ((time >= begin) & (time < end) for begin, end in (one, other))
        found = values.copy()
        found[first], found[second] = values[second], values[first]
        return found

    return lambda trial: both(*(changed(name, applied) for name in trial.recording.channels))(trial)


def cross_talk(share: float, of: str, into: str) -> Change:
    """Add a share of one channel to another."""
    return lambda trial: trial.with_values(into, trial.values(into) + share * trial.values(of))


def loses_pieces(seconds: float, every_s: float, channel: str) -> Change:
    """Let a channel lose a piece at times, so that it comes earlier and earlier."""

    def applied(time: Values, values: Values) -> Values:
        kept = values[np.mod(time - time[0], every_s) >= seconds]
        return np.concatenate([kept, np.full(values.size - kept.size, kept[-1])])

    return changed(channel, applied)


def slips(share: float, *channels: str) -> Change:
    """Let the shaft of pick-ups turn more slowly, by a share that swings between nothing and twice its mean."""

    def applied(time: Values, values: Values) -> Values:
        swing_s = 60.0
        lost = share * (time - swing_s / (2.0 * np.pi) * np.sin(2.0 * np.pi * time / swing_s))
        return np.interp(time - lost, time, values)

    return both(*(changed(channel, applied) for channel in channels))


def gain(channel: str, of: Callable[[Values], Values]) -> Change:
    """Multiply a channel by a function of time."""
    return changed(channel, lambda time, values: values * of(time))


def bent(channel: str, share: float) -> Change:
    """Let a channel bend: its mean is shown as it is, a change about it larger by a share."""

    def applied(time: Values, values: Values) -> Values:
        over = values / values.mean()
        return values * (1.0 + share * (over - 1.0))

    return changed(channel, applied)


def late(seconds: float, *channels: str) -> Change:
    """Let channels come late; before the begin they keep their first value."""

    def applied(time: Values, values: Values) -> Values:
        return np.interp(time - seconds, time, values)

    return both(*(changed(channel, applied) for channel in channels))


def low_pass(channel: str, corner_hz: float) -> Change:
    """Smooth a channel by a filter of first order."""

    def applied(time: Values, values: Values) -> Values:
        sections = butter(1, corner_hz, fs=1.0 / (time[1] - time[0]), output="sos")
        return values[0] + sosfilt(sections, values - values[0])

    return changed(channel, applied)


def noise(channel: str, rms: float) -> Change:
    """Add white noise."""
    return changed(channel, lambda time, values: values + np.random.default_rng(5).normal(0.0, rms, values.size))


def slow_noise(channel: str, rms: float, rate_hz: float) -> Change:
    """Add noise below a frequency: drawn values with straight lines between them."""

    def applied(time: Values, values: Values) -> Values:
        knots = np.arange(time[0], time[-1] + 1.0 / rate_hz, 1.0 / rate_hz)
        return values + np.interp(time, knots, np.random.default_rng(5).normal(0.0, rms, knots.size))

    return changed(channel, applied)


def hum(channel: str, amplitude: float) -> Change:
    """Add mains hum of 50 Hz."""
    return changed(channel, lambda time, values: values + amplitude * np.sin(2.0 * np.pi * 50.0 * time))


def swell(frequency_hz: float, share: float, first_s: float, last_s: float) -> Change:
    """Let the torque swing as in a swell, between two instants."""

    def of(time: Values) -> Values:
        inside = (time >= first_s) & (time < last_s)
        return 1.0 + share * inside * np.sin(2.0 * np.pi * frequency_hz * time)

    return gain(TORQUE, of)


def without_pulses(channel: str, share: float) -> Change:
    """Lose pulses by chance."""

    def applied(time: Values, values: Values) -> Values:
        first, last = pulses(values)
        rng = np.random.default_rng(6)
        found = values.copy()
        for begin, end in zip(first, last, strict=True):
            if rng.random() < share:
                found[max(begin - 8, 0) : end + 8] = values.min()
        return found

    return changed(channel, applied)


def every_second_pulse(channel: str) -> Change:
    """Lose every second pulse."""

    def applied(time: Values, values: Values) -> Values:
        first, last = pulses(values)
        found = values.copy()
        for begin, end in zip(first[::2], last[::2], strict=False):
            found[max(begin - 8, 0) : end + 8] = values.min()
        return found

    return changed(channel, applied)


def doubled_pulses(channel: str, share: float) -> Change:
    """Break pulses in two by chance."""

    def applied(time: Values, values: Values) -> Values:
        first, last = pulses(values)
        rng = np.random.default_rng(6)
        found = values.copy()
        for begin, end in zip(first, last, strict=True):
            third = max((end - begin) // 3, 1)
            if rng.random() < share:
                found[begin + third : end - third] = values.min()
        return found

    return changed(channel, applied)


def pulses(values: Values) -> tuple[Values, Values]:
    """Return the first and last sample of every pulse."""
    high = values > 0.5 * (values.max() + values.min())
    step = np.diff(high.astype(np.int8))
    first, last = np.flatnonzero(step == 1) + 1, np.flatnonzero(step == -1) + 1
    last = last[last > first[0]]
    return first[: last.size], last


def rate(factor: float, *channels: str) -> Change:
    """Declare another rate; all channels where none is named."""

    def applied(trial: Trial) -> Trial:
        for name in channels or tuple(trial.recording.channels):
            trial = trial.with_channel(name, rate_hz=factor * trial.recording.channels[name].rate_hz)
        return trial

    return applied


def sampled_at(factor: float, *channels: str) -> Change:
    """Sample channels with a clock that is too fast by a factor, and say nothing of it."""

    def applied(time: Values, values: Values) -> Values:
        return np.interp(time / factor, time, values)

    return both(*(changed(channel, applied) for channel in channels))


def attributes(channel: str, **fields: object) -> Change:
    """Change what the file says of a channel."""
    return lambda trial: trial.with_channel(channel, **fields)


def in_another_unit(channel: str, factor: float) -> Change:
    """Store a channel in a unit that is so many times as large, and say nothing of it."""

    def applied(trial: Trial) -> Trial:
        one = trial.recording.channels[channel]
        return trial.with_channel(channel, scale=one.scale / factor, offset=one.offset / factor)

    return applied


def everywhere(of: Callable[[Values], Values]) -> Change:
    """Apply a function of the values to every channel; it may make them shorter."""

    def applied(trial: Trial) -> Trial:
        for name in trial.recording.channels:
            trial = trial.with_values(name, of(trial.values(name)))
        return trial

    return applied


def cut_out(first_s: float, last_s: float, *channels: str) -> Change:
    """Take a stretch out, so that what follows comes too early.

    Where channels are named, their end keeps its last value, as all channels of a file are of one length.
    """

    def applied(time: Values, values: Values) -> Values:
        inside = (time >= first_s) & (time < last_s)
        kept = values[~inside]
        return np.concatenate([kept, np.full(values.size - kept.size if channels else 0, kept[-1])])

    return lambda trial: both(*(changed(name, applied) for name in channels or tuple(trial.recording.channels)))(trial)


def missing(first_s: float, last_s: float, *channels: str) -> Change:
    """Let a stretch hold no numbers, in all channels where none is named."""

    def applied(trial: Trial) -> Trial:
        for name in channels or tuple(trial.recording.channels):
            time, values = trial.time_s(name), trial.values(name)
            values[(time >= first_s) & (time < last_s)] = np.nan
            trial = trial.with_channel(
                name, source=lambda begin, end, values=values: values[begin:end].copy(), scale=1.0, offset=0.0
            )
        return trial

    return applied


def begun_late(seconds: float) -> Change:
    """Begin all channels later, which their start says."""

    def applied(trial: Trial) -> Trial:
        for name in trial.recording.channels:
            time, values = trial.time_s(name), trial.values(name)
            trial = trial.with_values(name, values[time >= seconds]).with_channel(name, start_s=seconds)
        return trial

    return applied


def held(first_s: float, last_s: float, *channels: str) -> Change:
    """Let channels keep the value that they have at the begin of a stretch; at its end where it begins with the file.

    Channels are all where none is named.
    """

    def applied(time: Values, values: Values) -> Values:
        inside = (time >= first_s) & (time < last_s)
        place = int(np.flatnonzero(inside)[0]) if first_s > 0.0 else int(np.flatnonzero(inside)[-1])
        return np.where(inside, values[place], values)

    return lambda trial: both(*(changed(name, applied) for name in channels or tuple(trial.recording.channels)))(trial)


def held_in_bursts(share: float, burst_s: float, channel: str) -> Change:
    """Let a channel keep its last value for a share of the time, in bursts at times of chance."""

    def applied(time: Values, values: Values) -> Values:
        rng, length = np.random.default_rng(7), round(burst_s / (time[1] - time[0]))
        found, first = values.copy(), 1
        while first + length < values.size:
            found[first : first + length] = found[first - 1]
            first += length + 1 + int(rng.exponential(length * (1.0 - share) / share))
        return found

    return changed(channel, applied)


def held_at(rate_hz: float, channel: str) -> Change:
    """Let a channel hold each value until the next of a lower rate."""

    def applied(time: Values, values: Values) -> Values:
        step_s = time[1] - time[0]
        return values[np.floor(np.floor((time - time[0]) * rate_hz + 1e-6) / rate_hz / step_s + 0.5).astype(int)]

    return changed(channel, applied)


def mean_of(seconds: float, channel: str) -> Change:
    """Show the mean of what was last."""

    def applied(time: Values, values: Values) -> Values:
        length = round(seconds / (time[1] - time[0]))
        total = np.cumsum(np.concatenate([np.full(length, values[0]), values]))
        return (total[length:] - total[:-length]) / length

    return changed(channel, applied)


def clock_jump(jump_s: float, at_s: float) -> Change:
    """Let the clock of all channels jump, as a reader says it."""

    def applied(trial: Trial) -> Trial:
        for name, channel in trial.recording.channels.items():
            jump = ClockJump(sample=round(at_s * channel.rate_hz), jump_s=jump_s)
            trial = trial.with_channel(name, clock_jumps=(jump,))
        return trial

    return applied


def without(channel: str) -> Change:
    """Take a channel out of the file."""

    def applied(trial: Trial) -> Trial:
        channels = {name: one for name, one in trial.recording.channels.items() if name != channel}
        return replace(trial, recording=replace(trial.recording, channels=channels))

    return applied


def swapped(one: str, other: str) -> Change:
    """Exchange what two channels hold."""

    def applied(trial: Trial) -> Trial:
        channels = dict(trial.recording.channels)
        channels[one], channels[other] = (
            replace(channels[other], name=one),
            replace(channels[one], name=other),
        )
        return replace(trial, recording=replace(trial.recording, channels=channels))

    return applied


def campaign(of: Callable[[Trial], dict[str, object]]) -> Change:
    """Change fields of the campaign file."""
    return lambda trial: replace(trial, campaign=trial.campaign.model_copy(update=of(trial)))


def sine(name: str, **fields: object) -> Change:
    """Change what the campaign file says of one sine."""
    return campaign(
        lambda trial: {
            "sines": tuple(one.model_copy(update=fields) if one.name == name else one for one in trial.campaign.sines)
        }
    )


def sines(of: Callable[[object], dict[str, object]]) -> Change:
    """Change what the campaign file says of every sine."""
    return campaign(lambda trial: {"sines": tuple(one.model_copy(update=of(one)) for one in trial.campaign.sines)})


def leg(name: str, of: Callable[[Multisine], dict[str, object]]) -> Change:
    """Change what the campaign file says of a leg."""
    return campaign(
        lambda trial: {
            "multisines": tuple(
                one.model_copy(update=of(one)) if one.name == name else one for one in trial.campaign.multisines
            )
        }
    )


def sensor(name: str, **fields: object) -> Change:
    """Change what the vessel file says of a sensor."""
    return lambda trial: trial.with_sensor(name, **fields)


def pick_up(place: int, **fields: object) -> Change:
    """Change what the vessel file says of a pick-up."""

    def applied(trial: Trial) -> Trial:
        speeds = list(trial.vessel.sensors.speed)
        speeds[place] = speeds[place].model_copy(update=fields)
        sensors = trial.vessel.sensors.model_copy(update={"speed": tuple(speeds)})
        return replace(trial, vessel=trial.vessel.model_copy(update={"sensors": sensors}))

    return applied


def alone(place: int, **fields: object) -> Change:
    """Leave one pick-up in the vessel file, and change what is said of it."""

    def applied(trial: Trial) -> Trial:
        speed = trial.vessel.sensors.speed[place].model_copy(update=fields)
        sensors = trial.vessel.sensors.model_copy(update={"speed": (speed,)})
        return replace(trial, vessel=trial.vessel.model_copy(update={"sensors": sensors}))

    return applied


def divided(*channels: str) -> Change:
    """Let a flip-flop halve the pulses of channels: high from one to the next, low to the one after."""

    def applied(time: Values, values: Values) -> Values:
        high = values > 2.5
        begins = np.concatenate([[False], high[1:] & ~high[:-1]])
        return np.where(np.cumsum(begins) % 2, 4.6, 0.3)

    return both(*(changed(channel, applied) for channel in channels))


def slower(hz: float) -> Change:
    """Let the logger take fewer samples of every channel, without a filter."""

    def applied(trial: Trial) -> Trial:
        for name, one in trial.recording.channels.items():
            counts = one.read(0, one.count)[:: round(one.rate_hz / hz)].copy()
            source = partial(_part, counts)
            trial = trial.with_channel(name, source=source, count=counts.size, rate_hz=hz)
        return trial

    return applied


def _part(counts: Values, first: int, stop: int) -> Values:
    return counts[first:stop]


def vessel(part: str, **fields: object) -> Change:
    """Change what the vessel file says of a part."""
    return lambda trial: trial.with_vessel(part, **fields)


def inertias(factor: float, side: str) -> Change:
    """Change the inertias of the vessel file on one side of the gauge."""

    def applied(trial: Trial) -> Trial:
        rows = tuple(
            row.model_copy(update={"inertia_kg_m2": factor * row.inertia_kg_m2}) if row.gauge == side else row
            for row in trial.vessel.inertia
        )
        return replace(trial, vessel=trial.vessel.model_copy(update={"inertia": rows}))

    return applied
