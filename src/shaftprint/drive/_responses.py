"""Frequency responses of a drive: columns of files of another instrument, and how records are turned into them."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from shaftprint.settings import Name, NotNegativeNumber, PositiveNumber, Settings


class EstimatedResponse(Settings):
    """How the frequency responses that are fitted are made of records in time."""

    excitation: Literal["any", "periodic", "sine"] = "any"
    """How the inputs were moved: in any way, as by a sweep or noise, from which smooth responses follow; in periods
    that repeat; by one sine a record."""
    period_s: PositiveNumber | None = None
    """Period of what repeats [s]."""
    settling_s: NotNegativeNumber | None = None
    """Time at the beginning of each record that is left out [s]; one period, or a quarter of a record of a sine."""
    lowest_hz: NotNegativeNumber = 0.0
    """Lowest frequency [Hz]."""
    highest_hz: PositiveNumber | None = None
    """Highest frequency [Hz]; half of the sample rate, or a twentieth where inputs hold from sample to sample."""

    @model_validator(mode="after")
    def _of_one_kind(self) -> Self:
        if (self.excitation == "periodic") != (self.period_s is not None):
            raise ValueError('expected excitation = "periodic" and period_s together, found one of them alone.')
        if self.excitation == "any" and self.settling_s is not None:
            raise ValueError('expected no settling_s of excitation = "any", which finds how a record begins.')
        if self.highest_hz is not None and not self.lowest_hz < self.highest_hz:
            raise ValueError(f"expected lowest_hz below highest_hz, found {self.lowest_hz:g}, {self.highest_hz:g}.")
        return self


class ResponseColumns(Settings):
    """The response from one input to one output, in columns of a text table."""

    output: Name
    """Name of the output."""
    input: Name | None = None
    """Name of the input; the only one where not given."""
    frequency: Name = "frequency"
    """Column of the frequency."""
    frequency_unit: Literal["Hz", "rad/s"] = "Hz"
    """Its unit."""
    magnitude: Name | None = None
    """Column of the magnitude, with ``phase``."""
    magnitude_unit: Literal["ratio", "dB"] = "ratio"
    """``ratio``: unit of the output over that of the input; ``dB``: 20 times its common logarithm."""
    phase: Name | None = None
    """Column of the phase; a lag is negative."""
    phase_unit: Literal["deg", "rad"] = "deg"
    """Its unit."""
    real: Name | None = None
    """Column of the real part, with ``imaginary``, in place of magnitude and phase."""
    imaginary: Name | None = None
    """Column of the imaginary part."""
    std: Name | None = None
    """Column of the standard deviation of the complex response, a ratio as the magnitude."""
    coherence: Name | None = None
    """Column of the coherence with the one input, with ``averages``, in place of ``std``."""
    averages: Annotated[PositiveNumber, Field(ge=3.0)] | None = None
    """Independent averages behind the coherence."""
    relative_std: PositiveNumber | None = None
    """Standard deviation of the complex response over its magnitude, where no column tells it."""

    @model_validator(mode="after")
    def _told_once(self) -> Self:
        polar, plain = (self.magnitude, self.phase), (self.real, self.imaginary)
        if not (all(polar) and not any(plain)) and not (all(plain) and not any(polar)):
            raise ValueError("expected magnitude and phase, or real and imaginary, found neither pair alone.")
        stated = [name for name in ("std", "coherence", "relative_std") if getattr(self, name) is not None]
        if len(stated) != 1:
            raise ValueError(
                f"expected one of std, coherence, relative_std, which say how well the response is known, found "
                f"{' and '.join(stated) or 'none'}."
            )
        if (self.coherence is None) != (self.averages is None):
            raise ValueError("expected coherence and averages together, found one of them alone.")
        return self

    @property
    def columns(self) -> tuple[str, ...]:
        """Names of all columns that are read."""
        names = (self.frequency, self.magnitude, self.phase, self.real, self.imaginary, self.std, self.coherence)
        return tuple(name for name in names if name is not None)
