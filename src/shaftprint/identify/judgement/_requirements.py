"""What a fit must satisfy before its numbers may be used."""

import math
from dataclasses import dataclass, fields

from shaftprint.errors import IdentificationError


@dataclass(frozen=True, kw_only=True, slots=True)
class Requirements:
    """What a fit must satisfy; every number can be changed, and the defaults say where they come from."""

    largest_line_std: float = 0.3
    """A line is good where some channel of it is known better than this share of its size: a third, 10 dB."""
    lowest_line_snr_db: float = 0.0
    """A line is poor where the set point, or every other channel, has a lower local signal-to-noise ratio than this
    [dB]: at 0 noise and signal have the same variance (thesis table 3.7)."""
    data_per_parameter: float = 2.0
    """Least number of good data, two a complex value, for each parameter that the data must find."""
    largest_spacing: float = 5.0
    """Largest ratio of the frequencies of neighbouring good lines between which the loop gain passes 1 or -1; the lines
    of the thesis are a factor 2 apart."""
    lowest_p_value: float = 0.01
    """Probability below which a fit is rejected, and a line where it is that of the worst of all lines."""
    largest_contradiction: float = 0.05
    """Largest root mean square, over that of the motion, by which small and large motions of a record, up and down, a
    number early and late, other data or a flexible model may differ from the structure: half of what a FitPercent of
    90 % leaves."""
    visible_share: float = 0.25
    """Least size of such a difference over that of the noise: noise that is no autoregression, such as a shaft order,
    gives differences of a tenth of it that look significant."""
    largest_excess: float = math.inf
    """Largest mean square over that of the noise, in the directions of such a difference, that is no contradiction
    whatever its size: where it is 4, standard deviations that know of noise alone are half of what they should be. A
    linear structure of a ship leaves the second harmonic of the propeller law, and is judged by the size alone."""
    gain_margin: float = 2.0
    """Least gain margin of a well-tuned loop: 2 to 5 (Astrom and Murray, Feedback systems, section 9.3)."""
    phase_margin_deg: float = 30.0
    """Least phase margin of a well-tuned loop [deg]: 30 to 60 (same section)."""
    delay_margin_share: float = 1.0
    """Least delay margin over the delay in the loop. Injection and combustion take part of a turn of the engine, so
    that the delay doubles when the speed is halved: a loop that would then hunt has little to spare."""
    largest_std: float = 0.1
    """A number is trusted where its standard deviation is at most this share of its value, or of the width between its
    bounds where it may have either sign."""
    largest_prior_share: float = 0.7
    """A number with a larger share of the standard deviation that it had before the test is mostly its prior: at 0.7
    half of what is known of it, counted in reciprocal variances, is from before."""

    def __post_init__(self) -> None:
        """Check the limits.

        Raises IdentificationError if one of them, but that in dB, is not positive.
        """
        for field in fields(self):
            value = getattr(self, field.name)
            if not field.name.endswith("_db") and not value > 0.0:
                raise IdentificationError(f"requirement {field.name}: expected a positive number, found {value}.")
