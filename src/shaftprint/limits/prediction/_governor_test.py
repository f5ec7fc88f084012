"""What the limited governor is driven by and compared with: set point, speed and engine torque of a whole test."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float, in_blocks
from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._limited_governor import AHEAD_S
from shaftprint.errors import SignalError
from shaftprint.identify.prediction._planned_legs import first_leg
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.normalisation import Normalisation
from shaftprint.signals._signals import Signals
from shaftprint.signals.levels._working_point import deviation
from shaftprint.time_domain._decimator import Decimator
from shaftprint.time_domain.nonlinear._drive import Jump, jumps_in, with_jumps
from shaftprint.vessel._vessel import Vessel

# Samples of the record and of its drive a second [Hz]. Above 6 Hz a governor hardly acts, and what a pick-up of one
# pulse a revolution adds to the speed is in the acceleration too: the fit takes it for an answer of the governor.
RATE_HZ, DRIVE_HZ = 12.5, 200.0
# The line stands at the working point for so long before the first test [s], ...
BEFORE_S = 5.0
# ... and its mean over that time, less the last part [s], is where the simulation begins.
LAST_S = 1.0
AFTER_S = 3.0
LEAST_SPEED = 0.1
# Below this deviation of the speed pulses are too rare for the acceleration between them, and for this long beside [s].
SLOW, BESIDE_S = -0.45, 1.0
# After a stretch that is not known the integrator of the governor is not either, until the observer leads it back [s].
SETTLED_S = 25.0
# Means over this time [s] show the offset of the set point where it moves by no more than this deviation [-].
BLOCK_S, STILL = 2.0, 0.02
# Levels of legs that differ by less are one [V].
_SAME_LEVEL_V = 0.01


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class GovernorTest:
    """Signals of a test on one grid, as deviations from the working point."""

    name: str
    """Name of the recording."""
    time_s: FloatArray
    """Time of the recording [s], shape (samples,)."""
    without_jumps: FloatArray
    """``n_set`` [-] less its jumps, shape (samples,)."""
    jumps: tuple[Jump, ...]
    """Jumps of the set point, where they were recorded."""
    late_s: FloatArray
    """By how much each jump comes later than it was recorded [s], shape (jumps,)."""
    speed: FloatArray
    """``n`` [-], shape (samples,)."""
    shaft_torque: FloatArray
    """``M_s`` [-], shape (samples,)."""
    upstream_s: float
    """``tau_up`` of the vessel file [s]."""
    lost: BoolArray
    """Where a channel is not finite, shape (samples,)."""
    begin_s: float
    """Where the record begins [s]."""
    end_s: float
    """Where it ends [s]."""
    curve_speed: FloatArray
    """Speeds of the full-load curve as deviations [-], shape (points,)."""
    curve_shape: FloatArray
    """Full-load torque over that at the working-point speed [-], shape (points,)."""

    @property
    def step_s(self) -> float:
        """Time from one sample to the next [s]."""
        return float(self.time_s[1] - self.time_s[0])

    def engine_torque(self) -> FloatArray:
        """Return ``M_b = M_s + tau_up dn/dt`` [-], shape (samples,)."""
        return self.shaft_torque + self.upstream_s * np.gradient(self.speed, self.time_s)

    def settled_offset(self) -> float:
        """Return by how much the speed lies above the set point where that hardly moves [-].

        The median of short means: of a line that reaches a limit in steps and fast sines alone it is the offset of the
        set point, while the mean of all is pulled down by them.
        """
        count = round(BLOCK_S / self.step_s)
        set_point = self.without_jumps + sum_of_jumps(self.time_s, self.jumps, self.late_s)
        known = ~self.lost & (self.time_s >= self.begin_s) & (self.time_s <= self.end_s)
        asked, turned = in_blocks(set_point, count), in_blocks(self.speed, count)
        still = in_blocks(known, count).all(axis=1) & (asked.std(axis=1) < STILL)
        if not still.any():
            return 0.0
        return float(np.median((turned - asked)[still].mean(axis=1)))

    def with_inertia(self, factor: float) -> "GovernorTest":
        """Return the test as if the inertia upstream of the gauge were larger by a factor."""
        return replace(self, upstream_s=factor * self.upstream_s)

    def with_torque(self, factor: float) -> "GovernorTest":
        """Return the test as if the torque of the working point were larger by a factor."""
        torque = (1.0 + self.shaft_torque) / factor - 1.0
        return replace(self, shaft_torque=frozen_float(torque), upstream_s=self.upstream_s / factor)

    def without(self, stretches: Sequence[tuple[float, float]]) -> "GovernorTest":
        """Return the test as if some stretches of it, each from a time to another [s], had not been measured."""
        apart = [(self.time_s >= begin_s) & (self.time_s < end_s) for begin_s, end_s in stretches]
        return replace(self, lost=frozen_bool(np.any([self.lost, *apart], axis=0)))

    def held(self, cycle_s: float, late_s: FloatArray) -> "GovernorTest":
        """Return the test as if the set point were held between messages.

        ``cycle_s``: time between two messages [s]: what does not jump is the mean over it, at its middle. ``late_s``:
        by how much each jump comes later than it was recorded [s], shape (jumps,).
        """
        sums = np.concatenate([[0.0], np.cumsum(self.without_jumps)]) * self.step_s
        edges = np.append(self.time_s, self.time_s[-1] + self.step_s) - 0.5 * self.step_s
        ends = [np.clip(self.time_s + side * 0.5 * cycle_s, edges[0], edges[-1]) for side in (-1.0, 1.0)]
        area = np.interp(ends[1], edges, sums) - np.interp(ends[0], edges, sums)
        return replace(self, without_jumps=frozen_float(area / (ends[1] - ends[0])), late_s=frozen_float(late_s))

    def record(self, *, rate_hz: float = RATE_HZ, drive_hz: float = DRIVE_HZ) -> GovernorRecord:
        """Return the record of a fit: the torque of the engine over the load, driven by set point, speed and torque."""
        every = round(drive_hz / rate_hz)
        decimator = Decimator(every=every)
        count = int((self.end_s - self.begin_s) * rate_hz)
        time = self.begin_s + (np.arange((count - 1) * every + 1 + 2 * decimator.half) - decimator.half) / drive_hz
        torque = self.engine_torque()
        load = np.maximum(1.0 + self.speed, LEAST_SPEED) ** 2
        drive = {
            "n_set": self._from(self.without_jumps, time) + self._jumped(time),
            "n": self._from(self.speed, time + AHEAD_S),
            "M_b": self._from(torque, time + AHEAD_S),
            "c": self._from(np.interp(self.speed, self.curve_speed, self.curve_shape) - 1.0, time + AHEAD_S),
        }
        lost = np.interp(time, self.time_s, self.lost.astype(np.float64)) > 0.0
        used = decimator.filtered(lost.astype(np.float64)) < 1e-3
        corner_time, corner_value = self._corners(time[0], time[-1])
        return GovernorRecord(
            name=self.name,
            rate_hz=rate_hz,
            start_s=self.begin_s,
            inputs={name: frozen_float(decimator.filtered(values)) for name, values in drive.items()},
            outputs={"y": frozen_float(decimator.filtered(np.interp(time, self.time_s, (1.0 + torque) / load - 1.0)))},
            used=frozen_bool(used),
            drive={name: frozen_float(values) for name, values in drive.items()},
            every=every,
            corner_time_s=frozen_float(corner_time),
            corner_value=frozen_float(corner_value),
        )

    def _corners(self, begin_s: float, end_s: float) -> tuple[FloatArray, FloatArray]:
        """Return times [s] and values [-] of the corners of the set point, jumps as late as they are."""
        inside = (self.time_s > begin_s) & (self.time_s < end_s)
        at = np.array([jump.at_s for jump in self.jumps]) + self.late_s
        time = np.concatenate([[begin_s], self.time_s[inside], np.repeat(at, 2), [end_s]])
        # at a jump the corner before it comes first
        passed = np.concatenate([np.zeros(1 + np.count_nonzero(inside)), np.tile([0.0, 1.0], at.size), [0.0]])
        order = np.lexsort([passed, time])
        time, value = time[order], self._from(self.without_jumps, time[order])
        for jump, jump_s in zip(self.jumps, at.tolist(), strict=True):
            value += (jump.after - jump.before) * ((time > jump_s) | ((time == jump_s) & (passed[order] > 0.0)))
        return time, value

    def _jumped(self, time_s: FloatArray) -> FloatArray:
        """Return the sum of all jumps that have passed [-], shape (samples,)."""
        return sum_of_jumps(time_s, self.jumps, self.late_s)

    def _from(self, values: FloatArray, time_s: FloatArray) -> FloatArray:
        """Return a signal at some times, steady before the first test."""
        interpolated = np.interp(time_s, self.time_s, values)
        stands = time_s < self.begin_s + BEFORE_S - LAST_S
        return np.where(stands, interpolated[stands].mean() if stands.any() else interpolated, interpolated)


def governor_test(signals: Signals, campaign: Campaign, vessel: Vessel) -> GovernorTest:
    """Cut the tests out of prepared signals.

    Raises SignalError if the signals do not hold the tests of the campaign.
    """
    tests = campaign.excitations
    if campaign.legs and not (campaign.sines or campaign.staircases or campaign.chirps):
        raise SignalError(
            f"campaign {campaign.name}: expected sines or steps about one working point, in which limits are told "
            f"apart, found legs alone ({', '.join(leg.name for leg in campaign.legs)}): a limit that acts in a leg "
            "makes the fit of `shaftprint identify` fail; end the next test with a staircase, as `shaftprint plan` "
            "does."
        )
    time = signals.start_s + np.arange(signals.samples) / signals.rate_hz
    begin = max(tests[0].start_s - BEFORE_S, float(time[0]) + 1.0)
    end = min(max(test.stop_s for test in tests) + AFTER_S, float(time[-1]) - 1.0)
    if begin > tests[0].start_s - 2.0 * LAST_S or end - begin < 2.0 * BEFORE_S:
        raise SignalError(
            f"{signals.recording_name}: expected {2.0 * LAST_S:g} s before the first test of campaign {campaign.name}, "
            f"which begins at {tests[0].start_s:g} s, and tests after it; found signals from {time[0]:g} to "
            f"{time[-1]:g} s. Check that both belong together."
        )
    point = signals.working_point
    speed = deviation(signals.engine_speed.speed_rev_s, point.engine_speed_rev_s)
    torque = deviation(signals.shaft_torque_nm, point.shaft_torque_nm)
    set_point = deviation(signals.set_point_rev_s, point.engine_speed_rev_s)
    lost = ~(np.isfinite(speed) & np.isfinite(torque) & np.isfinite(set_point))
    margin, settled = round(BESIDE_S * signals.rate_hz), round(SETTLED_S * signals.rate_hz)
    lost = _within(lost | _within(speed < SLOW, margin, margin), 0, settled)
    lost |= _at_another_speed(time, campaign)
    curve = np.array(vessel.machine.full_load_shape(point.engine_speed_rev_s))
    set_point = _filled(time, set_point)
    jumps = jumps_in(time, set_point, campaign)
    on_time = np.zeros(len(jumps))
    normalisation = Normalisation(
        engine_speed_rev_s=point.engine_speed_rev_s,
        gear_ratio=vessel.gearbox.ratio,
        shaft_torque_nm=point.shaft_torque_nm,
    )
    return GovernorTest(
        name=signals.recording_name,
        time_s=frozen_float(time),
        without_jumps=frozen_float(with_jumps(time, set_point, jumps) - sum_of_jumps(time, jumps, on_time)),
        jumps=jumps,
        late_s=frozen_float(on_time),
        speed=frozen_float(_filled(time, speed)),
        shaft_torque=frozen_float(_filled(time, torque)),
        upstream_s=normalisation.inertia_time_s(vessel.inertia_upstream_kg_m2),
        lost=frozen_bool(lost),
        begin_s=begin,
        end_s=end,
        curve_speed=curve[:, 0],
        curve_shape=curve[:, 1],
    )


def sum_of_jumps(time_s: FloatArray, jumps: Sequence[Jump], late_s: FloatArray) -> FloatArray:
    """Return the sum of all jumps of a set point that have passed [-], on any grid, shape (samples,).

    ``late_s``: by how much each comes later than it was recorded [s], shape (jumps,).
    """
    passed = np.zeros(time_s.size)
    for jump, late in zip(jumps, late_s.tolist(), strict=True):
        passed += (jump.after - jump.before) * jump.passed(time_s, late_s=late)
    return passed


def _at_another_speed(time_s: FloatArray, campaign: Campaign) -> BoolArray:
    """Return where a test is about another speed than its working point, with the ramps there and back.

    The governor is followed through it, since speed and set point are known; but its gains may be others there.
    """
    elsewhere = np.zeros(time_s.shape, dtype=np.bool_)
    legs, tests = campaign.legs, campaign.of_input().excitations
    if not legs:
        return elsewhere
    about_v = campaign.offset_v if campaign.sines else first_leg(campaign).level_v
    ends = [0.0, *(test.stop_s for test in tests), np.inf]
    starts = [*(test.start_s for test in tests), np.inf]
    for place, test in enumerate(tests):
        if test in legs and abs(test.level_v - about_v) > _SAME_LEVEL_V:
            elsewhere |= (time_s >= ends[place]) & (time_s < starts[place + 1])
    return elsewhere


def _within(where: BoolArray, before: int, after: int) -> BoolArray:
    """Return where a mark is, so many samples before it and after it."""
    sums = np.concatenate([np.zeros(after + 1), np.cumsum(where), np.full(before, np.count_nonzero(where))])
    return np.asarray(sums[before + after + 1 :] > sums[: -before - after - 1])


def _filled(time_s: FloatArray, values: FloatArray) -> FloatArray:
    """Return a signal whose gaps are straight lines."""
    good = np.isfinite(values)
    return np.asarray(values) if good.all() else np.interp(time_s, time_s[good], values[good])
