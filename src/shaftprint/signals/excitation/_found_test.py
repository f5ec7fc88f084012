"""One test of a campaign as the recorded set point shows it, and what is other than planned."""

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from shaftprint.campaign._excitation import Excitation
from shaftprint.campaign._excitations import Sine

# A begin is known to this, and a phase to that [s, deg]; what differs by more is named.
_SAME_BEGIN_S, _SAME_PHASE_DEG = 0.3, 20.0
_SAME_AMPLITUDE = 0.1
_FEWEST_ALIKE, _ALIKE_SHARE = 3, 0.75
# One course or two on a clock of their own are shifted too, but by less, or not by the same [s].
_LEAST_SHIFT_S, _SAME_SHIFT_S = 1.0, 0.1


@dataclass(frozen=True, kw_only=True, slots=True)
class FoundTest:
    """One test of the campaign as the recorded set point shows it."""

    planned: Excitation
    """What the campaign says."""
    is_found: bool
    """Whether the set point shows such a test there at all; the numbers below say nothing where it does not."""
    begin_s: float
    """When it begins [s]."""
    end_s: float
    """When it ends [s]."""
    rising_s: float
    """When a sine rises through its middle, the time nearest to its begin [s]; the begin of another test."""
    frequency_hz: float
    """Frequency of a sine [Hz]; not a number for another test."""
    amplitude_v: float
    """Amplitude of a sine [V]; not a number for another test."""
    is_inverted: bool
    """Whether a staircase or chirp goes down where the campaign goes up."""

    @property
    def later_s(self) -> float:
        """How much later it begins than the campaign says [s]."""
        return self.begin_s - self.planned.start_s

    @property
    def phase_deg(self) -> float:
        """Phase of a sine at its begin [deg], from -180 to 180; 0 for another test."""
        if not isinstance(self.planned, Sine) or not self.is_found:
            return 0.0
        turns = (self.begin_s - self.rising_s) * self.frequency_hz
        return 360.0 * (turns - round(turns))

    @property
    def is_same(self) -> bool:
        """Whether it is found, and but for its begin and phase as planned."""
        if not self.is_found or self.is_inverted:
            return False
        if not isinstance(self.planned, Sine):
            return True
        is_as_large = abs(self.amplitude_v / self.planned.amplitude_v - 1.0) <= _SAME_AMPLITUDE
        return self.frequency_hz == self.planned.frequency_hz and is_as_large

    @property
    def differences(self) -> tuple[str, ...]:
        """What is other than in the campaign, each with the value that fits; empty where nothing is."""
        if not self.is_found:
            return ("is not in the set point near its place",)
        planned = self.planned
        sentences = []
        if abs(self.later_s) > self._begin_tolerance_s:
            sentences.append(f"begins at {self.begin_s:.2f} s where the campaign says {planned.start_s:g} s")
        if self.is_inverted:
            sentences.append("is upside down")
        if not isinstance(planned, Sine):
            return tuple(sentences)
        if self.frequency_hz != planned.frequency_hz:
            sentences.append(f"has {self.frequency_hz:.4g} Hz where the campaign says {planned.frequency_hz:g} Hz")
        elif not sentences and not self._has_planned_phase:
            sentences.append(self._phase_words(planned))
        if abs(self.amplitude_v / planned.amplitude_v - 1.0) > _SAME_AMPLITUDE:
            sentences.append(f"has {self.amplitude_v:.3g} V where the campaign says {planned.amplitude_v:g} V")
        if self.end_s < planned.window_stop_s - _SAME_BEGIN_S:
            sentences.append(f"ends at {self.end_s:.2f} s, before its window does at {planned.window_stop_s:.2f} s")
        return tuple(sentences)

    def _phase_words(self, planned: Sine) -> str:
        """Return with which phase a sine begins, and what fits."""
        if planned.phase_rad == 0.0:
            return f"begins at a phase of {self.phase_error_deg:.0f} degrees: start_s = {self.rising_s:.3f} fits"
        phase_rad = math.remainder(planned.phase_rad + math.radians(self.phase_error_deg), 2.0 * math.pi)
        planned_rad = math.remainder(planned.phase_rad, 2.0 * math.pi)
        return (
            f"begins at a phase of {round(math.degrees(phase_rad))} degrees where the campaign says "
            f"{round(math.degrees(planned_rad))}: phase_rad = {round(phase_rad, 3) + 0.0:g} fits"
        )

    @property
    def _has_planned_phase(self) -> bool:
        """Whether a sine has the phase at its start that the campaign states."""
        error_s = self.phase_error_deg / 360.0 / self.frequency_hz
        return abs(self.phase_error_deg) <= _SAME_PHASE_DEG and abs(error_s) <= _SAME_BEGIN_S

    @property
    def _begin_tolerance_s(self) -> float:
        """How far its begin may be from the stated one [s].

        A campaign may state when a sine rises through its middle, not when it begins: one that begins at another phase
        begins up to half a period from there, but before its window.
        """
        planned = self.planned
        if not isinstance(planned, Sine) or not self._has_planned_phase:
            return _SAME_BEGIN_S
        settling_s = max(planned.settled_s - planned.start_s, 0.0)
        return _SAME_BEGIN_S + min(0.5 / planned.frequency_hz, settling_s)

    @property
    def phase_error_deg(self) -> float:
        """Phase of a sine beyond that which the campaign states at its start [deg], -180 to 180; 0 for another test."""
        if not isinstance(self.planned, Sine) or not self.is_found:
            return 0.0
        turns = (self.planned.start_s - self.rising_s) * self.frequency_hz - self.planned.phase_rad / (2.0 * math.pi)
        return 360.0 * (turns - round(turns))


def common_shift_s(found: Sequence[FoundTest]) -> float:
    """Return by how much later than the campaign nearly all tests begin [s]; 0 where they do not, or do not agree."""
    there = [test for test in found if test.is_found]
    later = np.array([test.later_s for test in there])
    if later.size < _FEWEST_ALIKE and not _are_courses_shifted(found):
        return 0.0
    alike = np.abs(later - np.median(later)) < _SAME_BEGIN_S
    if alike.mean() < _ALIKE_SHARE or abs(float(np.median(later))) < _SAME_BEGIN_S:
        return 0.0
    # the phase of a slow sine knows it better than its begin does
    exact = [test.rising_s - test.planned.start_s for test, same in zip(there, alike.tolist(), strict=True) if same]
    return float(np.median(exact))


def _are_courses_shifted(found: Sequence[FoundTest]) -> bool:
    """Return whether all of few tests are courses, each of which stands at one place alone, and begin as much later."""
    if not found or any(isinstance(test.planned, Sine) or not test.is_same for test in found):
        return False
    later = [test.later_s for test in found]
    return min(map(abs, later)) > _LEAST_SHIFT_S and max(later) - min(later) < _SAME_SHIFT_S
