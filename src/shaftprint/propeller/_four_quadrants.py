"""Thrust and torque of a propeller in all four quadrants: ship and shaft each ahead or astern."""

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import PropellerError
from shaftprint.notebook._shown import Shown
from shaftprint.propeller._coefficients import coefficients

# The speed of the blades is taken at this share of the radius.
_AT_RADIUS = 0.7
_BLADES, _AREA_RATIO, _ROUNDING = 4, 0.70, 0.005


class Bollard(NamedTuple):
    """A propeller that turns where no water comes towards it."""

    thrust: float
    """``T / (rho n^2 D^4)``, positive in the direction in which the shaft turns: astern it pushes the ship astern."""
    torque: float
    """``Q / (rho n^2 D^5)``, positive when the shaft drives the propeller, ahead and astern."""


class ThrustAndTorque(NamedTuple):
    """Forces of one propeller, of the shape of its speeds."""

    thrust_n: FloatArray
    """Thrust [N], positive ahead, shape as above."""
    torque_nm: FloatArray
    """Torque that the shaft must give [N m], positive where it would turn the propeller ahead, shape as above."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class FourQuadrantCurve(Shown):
    """``C_T*`` and ``C_Q*`` over the advance angle and the pitch ratio.

    The advance angle is ``beta = atan2(v_a, 0.7 pi n D)``: 0 ahead at bollard pull, 90 degrees with a shaft that stands
    in water from ahead, 180 degrees astern at bollard pull. With ``V^2 = v_a^2 + (0.7 pi n D)^2``::

        T = C_T* rho/2 V^2 pi/4 D^2      Q = C_Q* rho/2 V^2 pi/4 D^3

    (W.P.A. van Lammeren, J.D. van Manen and M.W.C. Oosterveld, The Wageningen B-screw series, Transactions SNAME 77,
    1969).
    """

    name: str
    """Series and type, such as ``Wageningen B4-70``."""
    pitch_ratios: FloatArray
    """Pitch ratios that were tested, ascending, shape (pitches,)."""
    coefficients: FloatArray
    """``A_T``, ``B_T``, ``A_Q`` and ``B_Q`` of each multiple of the advance angle, shape (pitches, multiples, 4)."""

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for name in ("pitch_ratios", "coefficients"):
            object.__setattr__(self, name, frozen_float(getattr(self, name)))

    def at(self, advance_angle_rad: ArrayLike, pitch_ratio: float) -> tuple[FloatArray, FloatArray]:
        """Return ``C_T*`` and ``C_Q*`` at advance angles [rad], of their shape.

        Between the pitches that were tested the polynomial through all of them holds for each coefficient.

        Raises PropellerError if the pitch lies outside what was tested.
        """
        table = self.of_pitch(pitch_ratio)
        angle = np.asarray(advance_angle_rad, dtype=np.float64)[..., None] * np.arange(table.shape[0])
        cosine, sine = np.cos(angle), np.sin(angle)
        return cosine @ table[:, 0] + sine @ table[:, 1], cosine @ table[:, 2] + sine @ table[:, 3]

    def bollard(self, pitch_ratio: float, *, astern: bool) -> Bollard:
        """Return thrust and torque coefficients where no water comes towards the propeller.

        ``pitch_ratio``: pitch over diameter. ``astern``: whether the shaft turns astern. Raises PropellerError if the
        pitch lies outside what was tested.
        """
        thrust, torque = self.at(math.pi if astern else 0.0, pitch_ratio)
        # K = C pi/8 (0.7 pi)^2
        sign, over = -1.0 if astern else 1.0, math.pi / 8.0 * (_AT_RADIUS * math.pi) ** 2
        return Bollard(thrust=sign * over * float(thrust), torque=sign * over * float(torque))

    def forces(
        self,
        shaft_speed_rev_s: ArrayLike,
        advance_m_s: ArrayLike,
        *,
        pitch_ratio: float,
        diameter_m: float,
        water_density_kg_m3: float,
    ) -> ThrustAndTorque:
        """Return thrust and torque at any speed of shaft and water; both are 0 where both stand.

        ``shaft_speed_rev_s``: speed of the shaft [rev/s], negative astern. ``advance_m_s``: speed of the propeller
        through the water [m/s], negative astern. ``pitch_ratio``, ``diameter_m``: the propeller.
        ``water_density_kg_m3``: density of the water [kg/m3]. Raises PropellerError if the pitch lies outside what was
        tested.
        """
        around = self.around_m(diameter_m) * np.asarray(shaft_speed_rev_s, dtype=np.float64)
        along = np.asarray(advance_m_s, dtype=np.float64)
        thrust, torque = self.at(np.arctan2(along, around), pitch_ratio)
        force = 0.5 * water_density_kg_m3 * (along**2 + around**2) * math.pi / 4.0 * diameter_m**2
        return ThrustAndTorque(thrust_n=force * thrust, torque_nm=force * diameter_m * torque)

    @staticmethod
    def around_m(diameter_m: float) -> float:
        """Return the way around the shaft in one turn [m] at the radius where the speed of the blades is taken."""
        return _AT_RADIUS * math.pi * diameter_m

    def of_pitch(self, pitch_ratio: float) -> FloatArray:
        """Return ``A_T``, ``B_T``, ``A_Q`` and ``B_Q`` of each multiple of the advance angle, shape (multiples, 4).

        Raises PropellerError if the pitch lies outside what was tested.
        """
        lowest, highest = float(self.pitch_ratios[0]), float(self.pitch_ratios[-1])
        if not lowest <= pitch_ratio <= highest:
            raise PropellerError(
                f"{self.name}: expected a pitch ratio P/D from {lowest:g} to {highest:g}, found {pitch_ratio:g}; its "
                "four quadrants were not tested there."
            )
        # Lagrange's weights
        apart = self.pitch_ratios[:, None] - self.pitch_ratios
        np.fill_diagonal(apart, 1.0)
        towards = np.tile(pitch_ratio - self.pitch_ratios, (self.pitch_ratios.size, 1))
        np.fill_diagonal(towards, 1.0)
        weights = np.prod(towards / apart, axis=1)
        return np.asarray(np.tensordot(weights, self.coefficients, axes=1))


def four_quadrants(*, blades: int, area_ratio: float) -> FourQuadrantCurve:
    """Return the curves of an open propeller in four quadrants; of the B series those of B4-70 are published.

    Parameters
    ----------
    blades
        Number of blades ``Z``.
    area_ratio
        Expanded blade area over disc area ``A_E/A_0``.

    Raises
    ------
    PropellerError
        If it is another propeller.
    """
    if blades != _BLADES or abs(area_ratio - _AREA_RATIO) > _ROUNDING:
        raise PropellerError(
            f"four quadrants: expected the Wageningen B4-70, four blades with an area ratio of {_AREA_RATIO:g}, found "
            f"{blades} blades with {area_ratio:g}; coefficients of no other propeller are known here."
        )
    sets = coefficients("b4-70-in-four-quadrants")["sets"]
    table = np.zeros((len(sets), max(len(one["rows"]) for one in sets), 4))
    for place, one in enumerate(sets):
        table[place, : len(one["rows"])] = one["rows"]
    return FourQuadrantCurve(
        name="Wageningen B4-70",
        pitch_ratios=np.array([one["pitch_ratio"] for one in sets]),
        coefficients=table / np.array([100.0, 100.0, -1000.0, -1000.0]),
    )
