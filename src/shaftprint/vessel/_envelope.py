"""What must not be passed while a program plays a test: what the owner allows, in the vessel file."""

from typing import Self

from pydantic import model_validator

from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings


class ChannelBound(Settings):
    """Lowest and highest value of a channel, such as a temperature, while a program plays a test."""

    channel: Name
    """Name of the channel."""
    lowest: Number | None = None
    """Lowest value, in the unit of the channel; none where not given."""
    highest: Number | None = None
    """Highest value, in the unit of the channel; none where not given."""
    persistence_s: PositiveNumber = 0.5
    """How long it may be beyond before the test is aborted [s]."""

    @model_validator(mode="after")
    def _bounds_something(self) -> Self:
        if self.lowest is None and self.highest is None:
            raise ValueError("expected lowest or highest, found neither.")
        if self.lowest is not None and self.highest is not None and self.lowest >= self.highest:
            raise ValueError(f"expected lowest below highest = {self.highest:g}, found {self.lowest:g}.")
        return self


class StatedEnvelope(Settings):
    """What the owner allows a program that plays a test.

    Speeds that are not given are those of ``limits``, else idle and rated speed; barred ranges are those of ``limits``.
    """

    lowest_speed_rpm: PositiveNumber | None = None
    """Lowest engine speed [rpm]."""
    highest_speed_rpm: PositiveNumber | None = None
    """Highest engine speed [rpm]."""
    lowest_shaft_torque_nm: Number = 0.0
    """Lowest mean shaft torque, driving the propeller the way it turns [N m]."""
    highest_shaft_torque_nm: PositiveNumber
    """Highest mean shaft torque over a turn of the shaft [N m]."""
    highest_torque_amplitude_nm: PositiveNumber | None = None
    """Largest amplitude of the shaft torque that a test line may be predicted to make [N m]; none where not given."""
    lowest_set_point_v: Number | None = None
    """Lowest set point that may be put out [V of the campaign]."""
    highest_set_point_v: Number | None = None
    """Highest set point that may be put out [V of the campaign]."""
    highest_slew_v_per_s: PositiveNumber | None = None
    """Fastest change of the set point [V/s]; a jump is refused where it is given."""
    barred_margin_rpm: NotNegativeNumber = 25.0
    """How far the speed stays from barred ranges [rpm]."""
    longest_s: PositiveNumber
    """Longest time for which the program may rule the set point [s]."""
    persistence_s: PositiveNumber = 0.5
    """How long speed or torque may be beyond before the test is aborted [s]."""
    channels: tuple[ChannelBound, ...] = ()
    """Bounds of further channels: temperatures, rack, boost."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        errors = []
        for low, high in (
            ("lowest_speed_rpm", "highest_speed_rpm"),
            ("lowest_shaft_torque_nm", "highest_shaft_torque_nm"),
            ("lowest_set_point_v", "highest_set_point_v"),
        ):
            lower, higher = getattr(self, low), getattr(self, high)
            if lower is not None and higher is not None and lower >= higher:
                errors.append(f"expected {low} below {high} = {higher:g}, found {lower:g}.")
        if errors:
            raise ValueError(" ".join(errors))
        return self
