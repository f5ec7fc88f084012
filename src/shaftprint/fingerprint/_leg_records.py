"""At which speeds a test was made, and the noise there, as a fingerprint keeps them."""

from collections.abc import Mapping
from typing import TYPE_CHECKING, Self

import numpy as np
from pydantic import Field, FiniteFloat, NonNegativeFloat, PositiveFloat, PositiveInt, model_validator

from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.records import Record
from shaftprint.units import rpm_from_rev_s

if TYPE_CHECKING:
    from shaftprint.signals._working_points import LegState, WorkingPoint


class LegRecord(Record):
    """One leg of the test: whole periods of several lines about a speed of its own."""

    name: str
    """Name of the leg."""
    engine_speed_rpm: PositiveFloat
    """Mean engine speed ``n_0`` of its whole periods [rpm]."""
    shaft_torque_nm: float
    """Shaft torque ``M_0`` of its propeller at that speed [N m]."""
    set_point_v: float
    """Mean set-point voltage [V]."""
    load: NonNegativeFloat
    """``M_0 / n_0^2`` over that of the working point of the fingerprint [-]."""
    periods: PositiveInt
    """Whole periods that were measured."""
    period_s: PositiveFloat
    """Length of one [s]."""
    p_value: float | None = Field(default=None, ge=0.0, le=1.0)
    """Probability of a misfit that large or larger of this leg if the model holds; None where it was not fitted with
    others."""


class NoiseSpectrum(Record):
    """Power spectral densities of the outputs' noise at one engine speed, one-sided, over the values there."""

    engine_speed_rpm: PositiveFloat
    """Mean engine speed [rpm]."""
    set_point_per_v: PositiveFloat
    """Change of the set point over that speed for one volt [1/V]."""
    outputs: tuple[str, ...]
    """Names of the outputs, such as ``n`` and ``M_s``."""
    frequency_hz: tuple[FiniteFloat, ...]
    """Frequencies of the lines under which it was measured [Hz], ascending."""
    density_real: tuple[tuple[tuple[FiniteFloat, ...], ...], ...]
    """Real part of the density matrix [1/Hz], shape (frequencies, outputs, outputs)."""
    density_imaginary: tuple[tuple[tuple[FiniteFloat, ...], ...], ...]
    """Imaginary part of it [1/Hz], the same shape."""
    orders_hz: tuple[PositiveFloat, ...] = ()
    """Where orders of the shaft line stand at that speed [Hz]; they were taken out of the torque."""

    @model_validator(mode="after")
    def _is_a_spectrum(self) -> Self:
        shape = (len(self.frequency_hz), len(self.outputs), len(self.outputs))
        for part in (self.density_real, self.density_imaginary):
            rows = [len(row) for matrix in part for row in matrix]
            sizes = {len(matrix) for matrix in part}
            if len(part) != shape[0] or not sizes <= {shape[1]} or not set(rows) <= {shape[2]}:
                raise ValueError(f"expected densities of shape {shape}")
        # it checks the numbers, and says what is wrong with them
        self.levels()
        return self

    def levels(self) -> NoiseLevels:
        """Return it as planning and prediction take it."""
        density = np.array(self.density_real) + 1j * np.array(self.density_imaginary)
        return NoiseLevels(
            frequency_hz=np.array(self.frequency_hz),
            density=density,
            outputs=self.outputs,
            set_point_per_v=self.set_point_per_v,
            orders_hz=self.orders_hz,
        )


def leg_record(leg: "LegState", *, main: "WorkingPoint", p_value: float | None) -> LegRecord:
    """Return what is kept of a leg.

    ``main``: the working point of the fingerprint. ``p_value``: that of the leg in a fit to all legs; None without one.
    """
    point = leg.working_point
    load = point.shaft_torque_nm / point.engine_speed_rev_s**2
    return LegRecord(
        name=leg.name,
        engine_speed_rpm=rpm_from_rev_s(point.engine_speed_rev_s),
        shaft_torque_nm=point.shaft_torque_nm,
        set_point_v=point.set_point_v,
        load=load / (main.shaft_torque_nm / main.engine_speed_rev_s**2),
        periods=leg.periods,
        period_s=leg.period_s,
        p_value=p_value,
    )


def noise_spectra(levels: Mapping[float, NoiseLevels]) -> tuple[NoiseSpectrum, ...]:
    """Return what is kept of the noise at each engine speed [rpm]."""
    return tuple(
        NoiseSpectrum(
            engine_speed_rpm=speed_rpm,
            set_point_per_v=one.set_point_per_v,
            outputs=one.outputs,
            frequency_hz=tuple(one.frequency_hz.tolist()),
            density_real=one.density.real.tolist(),
            density_imaginary=one.density.imag.tolist(),
            orders_hz=one.orders_hz,
        )
        for speed_rpm, one in levels.items()
    )
