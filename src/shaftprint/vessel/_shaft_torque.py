"""The torque gauge: strain gauges on the propeller shaft, from the unit of their channel to a torque."""

import math
from collections.abc import Mapping
from typing import Annotated, Any, Literal, Self, TypeAlias

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, ValidationError, model_validator

from shaftprint.arrays import FloatArray
from shaftprint.settings import Name, NotNegativeNumber, Number, PositiveNumber, Settings
from shaftprint.units import MILLI, NM_PER_UNIT
from shaftprint.vessel._current_loop import ALIVE_MA
from shaftprint.vessel._latency import LatencySeconds
from shaftprint.vessel._plain_unit import PLAIN_UNIT, as_plain_unit, in_kept_unit
from shaftprint.vessel._usual import GAUGE_SCALE_STD, GAUGE_ZERO_SHARE, LATENCY_STD_S

# A gauge whose channel is in kN m has a scale of about 1000 N m a unit; this much less is a forgotten factor.
_SMALLEST_OF_KILO = 100.0
_PASCAL_PER_GPA = 1e9
# Of a torque that is off by a power of a thousand, within such a factor of what is expected, the unit is wrong.
_NEAR_THOUSAND = 3.0
_POWERS = {
    1e3: "1000 times too small",
    1e-3: "1000 times too large",
    1e6: "a million times too small",
    1e-6: "a million times too large",
}
# What a channel can show in a unit: a current loop that is alive, what amplifiers of 10 V give, and a
# share that is no voltage, since one with ten times the scale would look like it.
_REACH = {"mA": ALIVE_MA, "V": (-10.5, 10.5), "%": (10.5, 110.0)}
# A torque this factor around the expected one is the load of another day.
_NEAR = 1.3
# A telemetry passes on a little more, or some times as much, as is expected.
_FITS = (1.0, 20.0)
# Written with fewer digits and read again, a scale is still that of its shaft.
_SAME_SCALE = 1e-6


TorqueUnit: TypeAlias = Annotated[Literal["V", "mA", "%", "mV/V", "N m", "kN m"], PLAIN_UNIT]


class GaugedShaft(Settings):
    """The round shaft under strain gauges at 45 degrees to its axis, from which the torque for 1 mV/V is calculated.

    On the surface of a shaft in torsion the shear strain is ``gamma = M D / (2 G J)`` with ``J = pi (D^4 - d^4) / 32``,
    and at 45 degrees to the axis the strain is ``gamma / 2``, of either sign. A bridge with ``B`` active arms gives
    ``V / U = k B / 4 * gamma / 2``, so that ``M = (V / U) pi G (D^4 - d^4) / (2 k B D)``. Both sides of the formula are
    in K. Hoffmann, An Introduction to Measurements using Strain Gages, HBM 1989, on torsion; imc, CAEMAX Dx manual,
    chapter 12, has it with numbers for steel.
    """

    outer_diameter_m: PositiveNumber
    """Outer diameter where the gauges are [m]."""
    inner_diameter_m: NotNegativeNumber = 0.0
    """Diameter of the bore there [m]; 0 for a solid shaft."""
    shear_modulus_gpa: Annotated[float, Field(strict=True, ge=1.0, le=500.0)]
    """Shear modulus of the shaft [GPa], 79 to 82 for steel."""
    gauge_factor: PositiveNumber
    """Relative change of a gauge's resistance for its strain, about 2."""
    bridge_factor: Annotated[float, Field(strict=True, gt=0.0, le=4.0)] = 4.0
    """Active arms of the bridge: 4 for a full bridge, 2 for a half."""
    reversed: bool = False
    """Whether the bridge shows a torque that drives the propeller ahead as negative."""

    @model_validator(mode="after")
    def _bore_fits(self) -> Self:
        if self.inner_diameter_m >= self.outer_diameter_m:
            raise ValueError(
                f"expected inner_diameter_m below outer_diameter_m = {self.outer_diameter_m:g}, found "
                f"{self.inner_diameter_m:g}."
            )
        return self

    @property
    def scale_nm_per_unit(self) -> float:
        """Torque for 1 mV/V [N m], negative where the bridge is reversed."""
        section_m4 = self.outer_diameter_m**4 - self.inner_diameter_m**4
        stiffness = math.pi * self.shear_modulus_gpa * _PASCAL_PER_GPA * section_m4
        scale = stiffness / (2.0 * self.gauge_factor * self.bridge_factor * self.outer_diameter_m) / MILLI
        return -scale if self.reversed else scale


class ShaftTorqueSensor(Settings):
    """Strain gauges with telemetry on the propeller shaft.

    ``M_s = scale_nm_per_unit * (reading - reading_at_zero) - zero_nm``, positive where the propeller is driven ahead:
    of a shaft that turns astern the gauge shows it negative.
    """

    channel: Name
    """Name of the channel in the recording."""
    unit: TorqueUnit
    """Unit of the channel; Nm and kNm are read as N m and kN m, MN m as kN m, mV as V, A and uA as mA."""
    scale_nm_per_unit: Number
    """Torque for one unit of the channel [N m per unit]; negative where the gauge is mounted reversed. Where it is not
    given: 1 and 1000 for a channel in N m and kN m, and that of ``shaft``."""
    shaft: GaugedShaft | None = None
    """The shaft under the gauges, of a channel in mV/V without a scale."""
    reading_at_zero: Number | None = None
    """What the telemetry gives at no torque by its data sheet, in the unit of the channel, such as 12 where 4 and 20 mA
    are full scale of either sign; 0 where not given."""
    scale_std_fraction: NotNegativeNumber | None = None
    """Relative standard deviation of the scale; see ``scale_std`` where it is not stated."""
    zero_nm: Number
    """Torque that the scaled channel shows when there is none [N m]; it is subtracted."""
    zero_std_nm: NotNegativeNumber | None = None
    """Standard deviation of the zero [N m]; see ``zero_std`` where it is not stated."""
    latency_s: LatencySeconds
    """Time by which the telemetry is late [s]."""
    latency_std_s: LatencySeconds | None = None
    """Standard deviation of the latency [s]; see ``latency_std`` where it is not stated."""
    full_scale_nm: PositiveNumber
    """Largest torque that the telemetry can pass on [N m], either sign."""
    resolution_nm: PositiveNumber | None = None
    """Smallest step of the telemetry [N m]."""

    @model_validator(mode="before")
    @classmethod
    def _scale_that_follows(cls, content: Any) -> Any:
        """Fill in the scale where unit or shaft tell it."""
        content = in_kept_unit(content, per_unit="scale_nm_per_unit", readings=("reading_at_zero",))
        if not isinstance(content, Mapping):
            return content
        of_unit = NM_PER_UNIT.get(as_plain_unit(content.get("unit")))
        of_shaft = _scale_of_shaft(content.get("shaft"))
        follows = of_unit if of_shaft is None else of_shaft
        if follows is None or "scale_nm_per_unit" in content:
            return content
        return {**content, "scale_nm_per_unit": follows}

    @model_validator(mode="after")
    def _scale_is_usable(self) -> Self:
        scale = self.scale_nm_per_unit
        if scale == 0.0:
            raise ValueError("expected scale_nm_per_unit other than 0, found 0.")
        if self.unit == "kN m" and abs(scale) < _SMALLEST_OF_KILO:
            raise ValueError(
                "expected scale_nm_per_unit near 1000 for a channel in kN m, as torque is in N m here, found "
                f"{scale:g}."
            )
        if self.shaft is None:
            return self
        if self.unit != "mV/V":
            raise ValueError(f'expected shaft left out for a channel in "{self.unit}", found one; it is for mV/V.')
        if not math.isclose(scale, self.shaft.scale_nm_per_unit, rel_tol=_SAME_SCALE):
            raise ValueError(
                f"expected scale_nm_per_unit left out beside shaft, which gives {self.shaft.scale_nm_per_unit:.6g}, "
                f"found {scale:g}; leave out shaft where the scale was calibrated."
            )
        return self

    @property
    def scale_std(self) -> float:
        """Relative standard deviation of the scale, as stated or as usual."""
        return GAUGE_SCALE_STD if self.scale_std_fraction is None else self.scale_std_fraction

    @property
    def zero_std(self) -> float:
        """Standard deviation of the zero [N m], as stated or as usual."""
        return GAUGE_ZERO_SHARE * self.full_scale_nm if self.zero_std_nm is None else self.zero_std_nm

    @property
    def latency_std(self) -> float:
        """Standard deviation of the latency [s], as stated or as usual."""
        return LATENCY_STD_S if self.latency_std_s is None else self.latency_std_s

    @property
    def live_zero(self) -> float:
        """What the telemetry gives at no torque by its data sheet [unit of the channel]."""
        return self.reading_at_zero or 0.0

    @property
    def sign_words(self) -> str:
        """What turns the sign of the torque, in words."""
        if self.shaft is not None:
            return f"set reversed = {str(not self.shaft.reversed).lower()} in sensors.shaft_torque.shaft"
        return "turn the sign of scale_nm_per_unit"

    def full_scale_words(self, torque_nm: float) -> str:
        """Return, in words, that a full scale below a torque is right in kN m; empty where it is not [N m]."""
        in_kilo = 1000.0 * self.full_scale_nm
        return (
            f", which in kN m would be right: {in_kilo:g} N m" if _FITS[0] < in_kilo / abs(torque_nm) < _FITS[1] else ""
        )

    def torque_nm(self, reading: ArrayLike) -> FloatArray:
        """Return the shaft torque [N m] for readings in the channel's unit, of any shape."""
        beyond = np.asarray(reading, dtype=np.float64) - self.live_zero
        return self.scale_nm_per_unit * beyond - self.zero_nm

    def scale_that_fits(self, torque_nm: float, expected_nm: float) -> str | None:
        """Return what, in words, would give the torque that is expected if the unit of the recording were wrong.

        None if nothing would. Telemetries give full scale as 10 V, 100 %, or 20 mA from 4 or from 12 mA on. A recording
        says itself what unit a channel has: one that says a torque is not called a share of full scale, which some of
        all torques would fit.

        ``torque_nm``: the torque that was found [N m], as the gauge counts it. ``expected_nm``: the one that was
        expected [N m], below 0 of a shaft that turns astern.
        """
        if self.unit in NM_PER_UNIT:
            return self._thousands_that_fit(torque_nm + self.zero_nm, expected_nm)
        reading = (torque_nm + self.zero_nm) / self.scale_nm_per_unit + self.live_zero
        full_nm = self.full_scale_nm
        for unit, scale, zero in (
            ("N m", 1.0, 0.0),
            ("kN m", 1000.0, 0.0),
            ("mA", full_nm / 16.0, 4.0),
            ("mA", full_nm / 8.0, 12.0),
            ("V", full_nm / 10.0, 0.0),
            ("%", full_nm / 100.0, 0.0),
        ):
            lowest, highest = _REACH.get(unit, (-math.inf, math.inf))
            shown_nm = scale * (reading - zero)
            if unit == self.unit or not lowest <= reading <= highest:
                continue
            if not 1.0 / _NEAR < shown_nm / expected_nm < _NEAR:
                continue
            start = f" and reading_at_zero = {zero:g}" if zero else ""
            return (
                f"{unit} would fit, with scale_nm_per_unit = {scale:.5g}{start} in sensors.shaft_torque, unit as it is"
            )
        return None

    def _thousands_that_fit(self, scaled_nm: float, expected_nm: float) -> str | None:
        """Return which scale makes a torque that is off by a power of a thousand the one that is expected.

        What is proposed counts on the unit that the recording states, which is converted into that of the vessel file.
        ``scaled_nm``: scale times reading [N m]. ``expected_nm``: as for ``scale_that_fits``.
        """
        factor, words = next(
            (
                (factor, words)
                for factor, words in _POWERS.items()
                if 1.0 / _NEAR_THOUSAND < (factor * scaled_nm - self.zero_nm) / expected_nm < _NEAR_THOUSAND
            ),
            (1.0, ""),
        )
        if not words:
            return None
        scale, usual = factor * self.scale_nm_per_unit, NM_PER_UNIT[self.unit]
        if 1.0 / _NEAR_THOUSAND < scale / usual < _NEAR_THOUSAND:
            return (
                f"that is about {words}: a torque is converted from the unit of the recording into the unit of the "
                f"vessel file before its scale is taken; write scale_nm_per_unit = {scale:.6g} in sensors.shaft_torque"
            )
        small, large = ("kN m", "N m") if factor > 1.0 else ("N m", "kN m")
        # of a channel in kN m no scale near 1 is taken
        unit, more = (self.unit, 1.0) if self.unit == "N m" else ("N m", 1000.0)
        start = f" and reading_at_zero = {more * self.live_zero:g}" if self.live_zero else ""
        return (
            f"that is about {words}: values in {small} that are called {large}? State them as {small} in the recording "
            f'or what describes it, or unit = "{unit}" with scale_nm_per_unit = {scale / more:.6g}{start} in '
            "sensors.shaft_torque"
        )


def _scale_of_shaft(shaft: Any) -> float | None:
    """Return the torque for 1 mV/V [N m] of a shaft as it stands in a file; None of none and of a wrong one."""
    if shaft is None:
        return None
    try:
        return GaugedShaft.model_validate(shaft).scale_nm_per_unit
    except ValidationError:
        # told with its field where the shaft is read
        return 1.0
