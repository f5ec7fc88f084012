"""What is known of one test line so far, from whole periods alone."""

from dataclasses import dataclass

from shaftprint.arrays import ComplexArray, FloatArray


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LineJudgement:
    """Response of the outputs to the set point at one frequency, from the whole periods that have come."""

    line: str
    """Name of the line, such as ``S1`` or ``M1/7``."""
    frequency_hz: float
    """Its frequency [Hz]."""
    periods: int
    """Whole periods that were used."""
    outputs: tuple[str, ...]
    """Channels whose response it is."""
    response: ComplexArray
    """Output over set point [unit of the output per unit of the set point's channel], shape (outputs,)."""
    std: FloatArray
    """Standard deviation of each, from the scatter of the periods, of real and imaginary part alike; not a number from
    one period alone, shape (outputs,)."""

    @property
    def signal_to_noise(self) -> FloatArray:
        """Size of the response over its standard deviation, shape (outputs,)."""
        ratio: FloatArray = abs(self.response) / self.std
        return ratio
