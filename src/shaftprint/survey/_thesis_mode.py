"""What the thesis' way makes of a recording."""

from collections.abc import Mapping
from dataclasses import dataclass, field

from shaftprint.identify.fit._identification import Identification
from shaftprint.signals._signals import Signals
from shaftprint.spectra._spectra import Spectra

# Share of itself by which the set point is taken to be off, to show what that does: less than the 1.05 % by which the
# line of equation 3.2 misses the speed of the working point at -5 V (table 3.2).
SET_POINT_OFF = -0.0085


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ThesisMode:
    """What the thesis' way makes of the same recording."""

    signals: Signals
    """Signals prepared in thesis mode."""
    spectra: Spectra
    """Spectra by bin selection."""
    identifications: Mapping[str, Identification]
    """Unweighted fits by structure name, such as OL1 to OL5, CL1, CL3, CL4 and BENCHMARK; any may be missing."""
    set_point_off: Mapping[str, Identification] = field(default_factory=dict)
    """OL2 to OL5 fitted to the same responses with the set point off by ``off_share``; may be empty."""
    off_share: float = SET_POINT_OFF
    """Share of itself by which the set point is off there."""
