"""Rows of a drive file: signals, known and searched parameters, the start, stretches of a recording."""

from typing import Annotated, Self

from pydantic import Field, model_validator

from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings, names_twice

Text = Annotated[str, Field(strict=True)]


class Signal(Settings):
    """An input or an output of the drive, and the channel that holds it."""

    name: Name
    """What the structure calls it, such as ``omega``."""
    channel: Name | None = None
    """Name of the channel in the recording; not needed where the files hold frequency responses."""
    unit: Name
    """Unit of the channel."""
    meaning: Text = ""
    """What it is, in words."""
    zero_std: PositiveNumber | None = None
    """Of an output: standard deviation of the sensor's zero, in the unit. If not given, a tenth of the level is the
    most of what has a zero at rest, and the zero of an angle, a way or a temperature is anywhere."""
    reversed: bool = False
    """Of an output: whether the channel counts the other way round than the structure does."""
    latency_s: NotNegativeNumber | None = None
    """Of an output: time by which the sensor shows it late [s]; 0 if not given."""
    latency_std_s: PositiveNumber | None = None
    """Standard deviation of that time [s]: with it the latency is found with the other numbers."""
    lag_s: PositiveNumber | None = None
    """Of an output: time constant of a filter of first order in sensor or logger [s]; none if not given."""
    lag_std_s: PositiveNumber | None = None
    """Standard deviation of that time constant [s]: with it the lag is found with the other numbers."""
    lowest: Number | None = None
    """Lowest value that a planned test may ask for or lead to, in the unit."""
    highest: Number | None = None
    """Highest value that a planned test may ask for or lead to."""
    fastest: PositiveNumber | None = None
    """Of an input: largest change in a second that a planned test may ask for, in the unit."""

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if self.lowest is not None and self.highest is not None and not self.lowest < self.highest:
            raise ValueError(f"expected lowest below highest, found {self.lowest:g} and {self.highest:g}.")
        if self.lag_std_s is not None and self.lag_s is None:
            raise ValueError("expected lag_s beside lag_std_s, found none: state what it is about.")
        return self


class KnownParameter(Settings):
    """A parameter of which something is known before the test."""

    name: Name
    """Name of the parameter."""
    value: Number
    """Its value, in the unit of the parameter."""
    std: NotNegativeNumber = 0.0
    """Standard deviation of the value; the parameter is held where it is 0 or not given."""
    unit: Name | None = None
    """Unit of the value, to be checked; that of the parameter where not given."""


class SearchedParameter(Settings):
    """Bounds between which a parameter is searched, instead of those of the structure."""

    name: Name
    """Name of the parameter."""
    lower: Number
    """Lower bound, in the unit of the parameter."""
    upper: Number
    """Upper bound."""

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if not self.lower < self.upper:
            raise ValueError(f"expected lower below upper, found {self.lower:g} and {self.upper:g}.")
        return self


class PerRecord(Settings):
    """A parameter that has a value of its own in each record, such as the inertia of what was mounted."""

    name: Name
    """Name of the parameter."""
    values: dict[Name, Number] = Field(default_factory=dict)
    """Its value in records where it is known, by record or group, in the unit of the parameter."""
    groups: dict[Name, tuple[Name, ...]] = Field(default_factory=dict)
    """Records that share a value, by the name of the group; a file's name without its ending stands for all of it."""

    def label(self, record: str) -> str:
        """Return what the value of a record is called by: its group, or the record itself."""
        groups = (name for name, members in self.groups.items() if any(_is_of(record, member) for member in members))
        return next(groups, record)

    @model_validator(mode="after")
    def _each_record_once(self) -> Self:
        members = [one for group in self.groups.values() for one in group]
        twice = names_twice(members)
        if twice:
            raise ValueError(f"expected each record in one group, found {', '.join(twice)} in several.")
        inside = [one for one in self.values if one in members]
        if inside:
            raise ValueError(f"expected the value of the group that {inside[0]} is in, found one of its own.")
        return self


def _is_of(record: str, member: str) -> bool:
    return record == member or record.startswith(f"{member}, ")


class StartState(Settings):
    """The value of a state of the equations at the start of every record."""

    name: Name
    """What the equations call the state, such as ``theta``."""
    value: Annotated[str | Number, Field(union_mode="left_to_right")]
    """Its value, in the units of the structure, or the name of the parameter that it is."""


class Stretch(Settings):
    """A part of a recording that is a record of its own."""

    name: Name
    """What was done, such as ``coast down``."""
    from_s: Number
    """Its first second, in seconds of the recording."""
    to_s: Number
    """Its last second."""

    @model_validator(mode="after")
    def _in_order(self) -> Self:
        if not self.from_s < self.to_s:
            raise ValueError(f"expected from_s before to_s, found {self.from_s:g} and {self.to_s:g}.")
        return self
