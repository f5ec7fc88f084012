"""The set point of the speed: what is put out to the governor, as it was recorded."""

from itertools import pairwise
from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from shaftprint.arrays import FloatArray
from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings
from shaftprint.vessel._latency import LatencySeconds
from shaftprint.vessel._plain_unit import PLAIN_UNIT, in_kept_unit
from shaftprint.vessel._usual import BEND_OF_DEMAND_STD, BEND_STD

# What a channel can show in a unit; in rpm, by how much more or less than the speed of the working point.
_REACH = {"mA": (0.0, 22.0), "V": (-30.0, 30.0), "%": (-10.0, 110.0)}
_AROUND_SPEED = 4.0
# The slope of a table at a reading is taken over this share of its range to either side.
_BESIDE = 0.02


SetPointUnit: TypeAlias = Annotated[Literal["V", "mA", "%", "rpm", "counts"], PLAIN_UNIT]


class SetPointSensor(Settings):
    """What asks the governor for a speed: a voltage, a current, a percentage, counts, or the demand itself in rpm.

    Campaigns are in volts: ``U = v_per_unit * reading + v_at_zero``.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: SetPointUnit
    """Unit of the channel; mV is read as V, A and uA as mA."""
    v_per_unit: Number | None = None
    """Volts of the campaign for one unit of the channel [V per unit]; 1 where it is not given for a channel in V."""
    v_at_zero: Number | None = None
    """Volts of the campaign where the channel shows 0 [V]; 0 where not given."""
    table_rpm: Annotated[tuple[tuple[Number, Number], ...], Field(min_length=2)] | None = None
    """Readings in the unit of the channel, each with the speed that it asks for [rpm], where that is no straight line;
    shape (pairs, 2)."""
    noise_v: NotNegativeNumber | None = None
    """Standard deviation of the logger's noise [V]."""
    latency_s: LatencySeconds | None = None
    """Time from the voltage to the demanded speed that the engine's control unit has [s]; None where not measured."""
    latency_std_s: PositiveNumber | None = None
    """Standard deviation of that time [s]."""
    bend_std: PositiveNumber | None = None
    """Standard deviation of the share by which the line is steeper at twice the speed of the working point; see
    ``line_bend_std`` where it is not stated."""
    message_latency_s: LatencySeconds = 0.0
    """Time by which messages are late behind what they show [s]; 0 for samples of a voltage."""
    is_obeyed: bool = False
    """Whether messages are the demand itself, each of which the governor holds until the next, not a report of it."""

    @model_validator(mode="before")
    @classmethod
    def _in_kept_unit(cls, content: Any) -> Any:
        return in_kept_unit(content, per_unit="v_per_unit", readings=("table_rpm",))

    @model_validator(mode="after")
    def _can_be_volts(self) -> Self:
        errors = []
        if self.unit != "V" and self.v_per_unit is None:
            errors.append(
                f"expected v_per_unit for a channel in {self.unit}, the volts of the campaign for one {self.unit}, "
                "found none."
            )
        if self.v_per_unit == 0.0:
            errors.append("expected v_per_unit other than 0, found 0.")
        pairs = self.table_rpm or ()
        if any(later[0] <= earlier[0] for earlier, later in pairwise(pairs)):
            errors.append("expected readings in table_rpm that rise from pair to pair, found others.")
        rising = [later[1] > earlier[1] for earlier, later in pairwise(pairs)]
        level = any(later[1] == earlier[1] for earlier, later in pairwise(pairs))
        if level or len(set(rising)) > 1:
            errors.append("expected speeds in table_rpm that all rise or all fall, found others.")
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def slope_v(self) -> float:
        """Volts of the campaign for one unit of the channel [V per unit]."""
        return 1.0 if self.v_per_unit is None else self.v_per_unit

    @property
    def line_bend_std(self) -> float:
        """Standard deviation of the share by which the line is steeper at twice the speed of the working point."""
        return self.bend_std or (BEND_OF_DEMAND_STD if self.unit == "rpm" else BEND_STD)

    def volts(self, reading: ArrayLike) -> FloatArray:
        """Return the set point in volts of the campaign [V] for readings in the channel's unit, of any shape."""
        values = np.asarray(reading, dtype=np.float64)
        if self.unit == "V" and self.v_per_unit is None and self.v_at_zero is None:
            return values
        return self.slope_v * values + (self.v_at_zero or 0.0)

    def reading(self, volts: ArrayLike) -> FloatArray:
        """Return what the channel shows, in its unit, for volts of the campaign, of any shape."""
        return (np.asarray(volts, dtype=np.float64) - (self.v_at_zero or 0.0)) / self.slope_v

    def straightened(self, volts: FloatArray, *, about_v: float) -> FloatArray:
        """Return volts that ask for speeds on a straight line, which touches the table at one voltage.

        ``volts``: set point [V], of any shape. ``about_v``: voltage at which nothing changes, neither value nor slope
        [V].
        """
        asked_rpm, rpm_per_v = self.asked_rpm(about_v), self.slope_rpm_per_v(about_v)
        if self.table_rpm is None or asked_rpm is None or rpm_per_v is None:
            return volts
        shown, rpm = np.array(self.table_rpm).T
        straight: FloatArray = about_v + (_along(self.reading(volts), shown, rpm) - asked_rpm) / rpm_per_v
        return straight

    def covers(self, volts: float) -> bool:
        """Return whether a set point [V] lies within the table, where there is one."""
        pairs = self.table_rpm
        return pairs is None or pairs[0][0] <= float(self.reading(volts)) <= pairs[-1][0]

    def slope_rpm_per_v(self, volts: float) -> float | None:
        """Return the engine speed that one volt more asks for at a set point [rpm/V], where table or unit say it."""
        if self.table_rpm is None:
            return 1.0 / self.slope_v if self.unit == "rpm" else None
        shown, rpm = np.array(self.table_rpm).T
        about, beside = float(self.reading(volts)), _BESIDE * float(np.ptp(shown))
        lower, upper = _along(np.array([about - beside, about + beside]), shown, rpm)
        return float(upper - lower) / (2.0 * beside) / self.slope_v

    def volts_for(self, speed_rpm: float) -> float | None:
        """Return the set point that asks for an engine speed [V], where table or unit say it."""
        if self.table_rpm is None:
            return float(self.volts(speed_rpm)) if self.unit == "rpm" else None
        shown, rpm = np.array(sorted(self.table_rpm, key=lambda pair: pair[1])).T
        return float(self.volts(_along(np.array(speed_rpm), rpm, shown)))

    def asked_rpm(self, volts: float) -> float | None:
        """Return the engine speed that a set point [V] asks for [rpm], where table or unit say it."""
        reading = self.reading(volts)
        if self.table_rpm is not None:
            return float(_along(reading, *np.array(self.table_rpm).T))
        return float(reading) if self.unit == "rpm" else None

    def unit_that_fits(self, reading: float, speed_rpm: float) -> str | None:
        """Return the unit that a reading looks like; None if it can be one in the unit that is stated.

        ``reading``: what the channel shows, in its unit. ``speed_rpm``: engine speed of the working point [rpm].
        """
        if self.unit == "counts":
            return None
        # of volts with a v_per_unit those of the campaign are told, such as of mV that a logger calls V
        reading = float(self.volts(reading)) if self.unit == "V" else reading
        reach = _REACH | {"rpm": (speed_rpm / _AROUND_SPEED, speed_rpm * _AROUND_SPEED)}
        fitting = [unit for unit, (lowest, highest) in reach.items() if lowest <= reading <= highest]
        return None if self.unit in fitting or not fitting else fitting[0]


def _along(reading: FloatArray, shown: FloatArray, rpm: FloatArray) -> FloatArray:
    """Return the speeds of a table [rpm], its first and last pieces extended."""
    first, last = ((rpm[k + 1] - rpm[k]) / (shown[k + 1] - shown[k]) for k in (0, -2))
    inside = np.interp(reading, shown, rpm)
    below, above = np.minimum(reading - shown[0], 0.0), np.maximum(reading - shown[-1], 0.0)
    along: FloatArray = inside + first * below + last * above
    return along
