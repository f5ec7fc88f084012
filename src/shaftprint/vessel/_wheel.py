"""Toothed wheels as engineers write them: ``60``, ``60-2``, ``36-2-1``, ``12+1``."""

import math
import re
from dataclasses import dataclass
from typing import Self

# Longer than any file that names a wheel on purpose.
_TEXT = re.compile(r"(\d{1,4})((?:-\d{1,2})*)(?:\+(\d))?")
_MOST_PLACES = 1000
# From tooth to tooth there must be so many samples: of a square pulse two are then high and two are low.
SAMPLES_A_TOOTH = 4.0
# Rates that are asked for are round numbers of so many digits.
_DIGITS = 2
# What lies beside a gap must tell how far the teeth stand apart.
_TEETH_PER_GAP = 4


@dataclass(frozen=True, kw_only=True, slots=True)
class Wheel:
    """Evenly spaced places for teeth, of which some are empty, or between which further teeth stand.

    Where the gaps are is not said: recordings show it.
    """

    places: int
    """Teeth that there would be all around."""
    missing: tuple[int, ...] = ()
    """Teeth missing in each gap, in the order in which the gaps pass, shape (gaps,)."""
    extra: int = 0
    """Teeth between the places, each in a space of its own."""

    @classmethod
    def parse(cls, text: str) -> Self:
        """Return the wheel that a text names.

        Raises ValueError if it names none; the message says what was expected.
        """
        match = _TEXT.fullmatch(text.strip())
        if match is None:
            raise ValueError(
                'expected a wheel such as "60-2" (60 teeth of which 2 beside each other are missing), "36-2-1" (with a '
                f'gap of 2 and a gap of 1) or "12+1" (one tooth between the 12), found "{text}".'
            )
        gaps = tuple(int(gap) for gap in match[2].split("-")[1:])
        wheel = cls(places=int(match[1]), missing=gaps, extra=int(match[3] or 0))
        mistake = wheel._mistake()
        if mistake:
            raise ValueError(f'expected {mistake}, found wheel = "{text}".')
        return wheel

    @property
    def counted(self) -> int:
        """Teeth by which the angle is counted in a turn: those at the places; one between them marks the turn."""
        return self.places - sum(self.missing)

    @property
    def closest(self) -> int:
        """Teeth that there would be all around if they stood as close as the closest two."""
        return 2 * self.places if self.extra else self.places

    def is_shown(self, *, rate_hz: float, turns_hz: float) -> bool:
        """Return whether a logger shows each tooth at so many turns a second, both in Hz."""
        return SAMPLES_A_TOOTH * self.closest * turns_hz <= rate_hz

    def least_rate_hz(self, turns_hz: float) -> float:
        """Return the lowest sample rate at which teeth are seen [Hz], a round number.

        ``turns_hz``: turns of the wheel a second [Hz].
        """
        least_hz = SAMPLES_A_TOOTH * self.closest * turns_hz
        step = 10.0 ** (math.floor(math.log10(least_hz)) + 1 - _DIGITS)
        return math.ceil(least_hz / step) * step

    @property
    def spacings(self) -> tuple[int, ...]:
        """Distances from tooth to tooth that occur, in places, smallest first.

        A further tooth may stand beside some whose pulses are missing.
        """
        return (1, *sorted({gap + 1 for gap in self.missing} | ({2, 3} if self.extra else set())))

    @property
    def uneven_share(self) -> float:
        """Share of the intervals between pulses that are no place long."""
        return (len(self.missing) + 2 * self.extra) / (self.counted + self.extra)

    def __str__(self) -> str:
        """Return the wheel as it is written in a vessel file."""
        gaps = "".join(f"-{gap}" for gap in self.missing)
        return f"{self.places}{gaps}" + (f"+{self.extra}" if self.extra else "")

    def _mistake(self) -> str:
        """Return what was expected where this can be no wheel; nothing where it can."""
        if self.missing and self.extra:
            return "either gaps or further teeth, not both"
        if 0 in self.missing:
            return "at least one tooth missing in each gap"
        if self.places > _MOST_PLACES:
            return f"at most {_MOST_PLACES} teeth"
        marks = len(self.missing) + self.extra
        if self.counted < max(_TEETH_PER_GAP * marks, 1):
            return f"at least {_TEETH_PER_GAP} evenly spaced teeth for each gap or further tooth"
        return ""
