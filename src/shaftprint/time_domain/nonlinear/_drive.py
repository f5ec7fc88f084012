"""What drives a model with limits: jumps that are jumps again, on a grid fine enough for them.

The set point of prepared signals has gone through a low pass, so that a jump rings for some 0.1 s before and behind
it. A linear model does not mind. A rate limit answers the ringing itself: it follows the first swing, and begins late.
Between two samples a set point is straight, and a rate limit moves as soon as the ramp begins; so that is put to where
the jump lies. Measured at steps of 2 V of the simulated tug without noise, rack limited to 3.8 1/s::

    drive                                   model behind the tug
    as filtered, 200 Hz                           6.2 ms
    jump at the middle of a ramp, 200 Hz         -4.7 ms
    ramp begins at the jump, 200 Hz               0.3 ms
    ramp begins at the jump, 400 Hz               0.3 ms

In a chirp the limit turns where the rack that is asked for crosses the one that is given, which a simulation sees at
its next step: half a step early, 1.2 ms at 400 Hz. Hence the finer grid.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_float
from shaftprint.campaign._campaign import Campaign
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain._record import Record

DRIVE_RATE_HZ = 400.0
# The low pass of the signals rings for so long beside a jump; its level is measured over the next stretch.
RINGING_S, LEVEL_S = 0.08, 0.25
# The jump of a staircase lies within this of where the campaign has it.
NEAR_S = 0.5
# Jumps smaller than this deviation are left as they are.
LEAST_JUMP = 1e-3


def with_exact_jumps(record: Record, campaign: Campaign, *, rate_hz: float = DRIVE_RATE_HZ) -> Record:
    """Return a record whose drive jumps where the campaign's staircases do, on a grid of about a rate.

    ``rate_hz``: samples of the drive a second [Hz]: a whole multiple of the record's rate is taken, the nearest.
    """
    every = max(round(rate_hz / record.rate_hz), 1)
    first_s = record.start_s - record.margin / record.drive_rate_hz
    drive_time = first_s + record.drive_time_s
    margin = Decimator(every=every).half
    count = (record.samples - 1) * every + 1 + 2 * margin
    time = record.start_s + (np.arange(count) - margin) / (record.rate_hz * every)
    drive = {}
    for name, values in record.drive.items():
        fine = np.interp(time, drive_time, values)
        for near_s in _jumps(campaign, drive_time[0], drive_time[-1]):
            fine = _restored(time, fine, near_s)
        drive[name] = frozen_float(fine)
    return replace(record, drive=drive, every=every)


@dataclass(frozen=True, slots=True, eq=False)
class Jump:
    """A jump of a filtered set point."""

    inside: BoolArray
    """Samples in which the filter rings, shape (samples,)."""
    at_s: float
    """Where the jump lies [s]."""
    before: float
    """Level before it."""
    after: float
    """Level after it."""

    def passed(self, time_s: FloatArray, *, late_s: float = 0.0) -> FloatArray:
        """Return the share of the jump that each sample has, shape (samples,).

        The sample in which the jump lies gets the share that keeps the jump's area: for small signals it lies where it
        was, to a small share of a sample.
        """
        step_s = float(time_s[1] - time_s[0])
        return np.clip((time_s - self.at_s - late_s) / step_s + 0.5, 0.0, 1.0)


def jumps_in(time_s: FloatArray, drive: FloatArray, campaign: Campaign) -> tuple[Jump, ...]:
    """Return the jumps of a set point that the staircases of a campaign make.

    ``time_s``, ``drive``: times [s] and the set point, shape (samples,).
    """
    near = (_jump_near(time_s, drive, near_s) for near_s in _jumps(campaign, float(time_s[0]), float(time_s[-1])))
    return tuple(jump for jump in near if jump is not None)


def with_jumps(time_s: FloatArray, drive: FloatArray, jumps: Sequence[Jump]) -> FloatArray:
    """Return a set point whose jumps are within one sample, on the grid that it has."""
    drive = drive.copy()
    for jump in jumps:
        drive[jump.inside] = jump.before + (jump.after - jump.before) * jump.passed(time_s[jump.inside])
    return drive


def _jumps(campaign: Campaign, begin_s: float, end_s: float) -> Iterator[float]:
    """Yield the times of all jumps of staircases far enough inside a stretch, to and from the offset too."""
    reach = RINGING_S + LEVEL_S + NEAR_S
    for stair in campaign.staircases:
        for number in range(len(stair.levels_v) + 1):
            time_s = stair.start_s + number * stair.dwell_s
            if begin_s + reach <= time_s <= end_s - reach:
                yield time_s


def _jump_near(time_s: FloatArray, drive: FloatArray, near_s: float) -> Jump | None:
    """Return the jump near a time; None where there is hardly one."""
    around = np.flatnonzero(np.abs(time_s - near_s) <= NEAR_S)
    largest = around[0] + int(np.argmax(np.abs(np.diff(drive[around]))))
    before, after = (
        float(np.mean(drive[np.abs(time_s - time_s[largest] - side * (RINGING_S + 0.5 * LEVEL_S)) <= 0.5 * LEVEL_S]))
        for side in (-1.0, 1.0)
    )
    if abs(after - before) < LEAST_JUMP:
        return None
    inside = np.abs(time_s - time_s[largest]) <= RINGING_S
    # where the share of the way that is left adds up to is where the jump lies
    remaining = (after - drive[inside]) / (after - before)
    step_s = time_s[1] - time_s[0]
    at_s = float(time_s[inside][0] - 0.5 * step_s + step_s * np.sum(remaining))
    return Jump(inside, at_s, before, after)


def _restored(time_s: FloatArray, drive: FloatArray, near_s: float) -> FloatArray:
    """Return a drive in which the jump near a time is within a sample; the levels beside it are those measured."""
    jump = _jump_near(time_s, drive, near_s)
    if jump is None:
        return drive
    restored = drive.copy()
    half_s = 0.5 * float(time_s[1] - time_s[0])
    restored[jump.inside] = np.where(time_s[jump.inside] <= jump.at_s + half_s, jump.before, jump.after)
    return restored
