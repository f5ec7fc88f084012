"""What may change on a ship, and which numbers of its fingerprint move with it.

A cause moves numbers together: a weaker injection takes the same share of both governor actions, a longer delay nothing
but the delay. So it is a direction in the space of the numbers, and how far two tests are apart along it is known much
better than each number. The directions follow from the roles of the numbers. That of the torque gauge is read off the
fingerprint: which numbers its scale moves depends on what was known beforehand (``JointNumbers.loadings``).
"""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Final, Literal

from shaftprint.catalogue._roles import ShipRole
from shaftprint.models._role import Role

PERCENT, MILLISECONDS = 100.0, 1000.0
_LARGEST_LOGARITHM = 10.0
GAUGE_SCALE: Final = "gauge scale"
"""Source of the budget that is a cause too."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Cause:
    """One thing that may have changed."""

    name: str
    """Part of the ship, as it stands in tables."""
    less: str
    """What is said when it has become less."""
    more: str
    """What is said when it has become more."""
    told_by: str
    """What shows whether it is this one."""
    roles: tuple[tuple[Role, ...], ...]
    """Roles of the numbers that it moves, all by the same share or by the same time; what stands for the same in
    different structures, such as the inertias, stands together."""
    is_share: bool = True
    """Whether its size is a share of the numbers; else it is a time [s]."""
    machine: Literal["engine", "motor"] | None = None
    """What drives the lines in which it may happen; None: either."""
    wears: Literal[-1, 0, 1] = 0
    """Which way it goes by itself over the years: less, neither, more."""
    taken_off_by: str = ""
    """What takes such wear off, as a docking does fouling; then it is expected, and no fault. Empty for others."""
    tolerance: float = 0.0
    """Standard deviation between sister ships as they are built, in the unit of the size; see docs/watching.md."""

    @property
    def unit(self) -> str:
        """Unit in which its size is stated."""
        return "%" if self.is_share else "ms"

    def in_unit(self, size: float) -> float:
        """Return a size, a share or a time [s], in the unit in which it is stated."""
        return self._per_unit * size

    def from_unit(self, number: float) -> float:
        """Return the size, a share or a time [s], of a number in the unit in which it is stated."""
        return number / self._per_unit

    @property
    def _per_unit(self) -> float:
        return PERCENT if self.is_share else MILLISECONDS

    def stated(self, size: float, std: float) -> tuple[float, float]:
        """Return a size and its deviation as they are stated: shares of logarithms, times as they are."""
        if not self.is_share:
            return size, std
        # a cause that has nothing to do with a large change may ask for any size
        factor = math.exp(min(size, _LARGEST_LOGARITHM))
        return factor - 1.0, factor * std


CAUSES: tuple[Cause, ...] = (
    Cause(
        name="injection or turbocharger",
        less="less torque for the same rack: injection or turbocharger",
        more="more torque for the same rack: injection or turbocharger",
        told_by="log the fuel rack in the next test",
        machine="engine",
        roles=((ShipRole.PROPORTIONAL_GAIN,), (ShipRole.INTEGRAL_GAIN,)),
        wears=-1,
        tolerance=0.01,
    ),
    Cause(
        name="proportional gain of the governor",
        less="a lower proportional gain of the governor",
        more="a higher proportional gain of the governor",
        told_by="read the gains in the control unit",
        machine="engine",
        roles=((ShipRole.PROPORTIONAL_GAIN,),),
        tolerance=0.005,
    ),
    Cause(
        name="integral gain of the governor",
        less="a lower integral gain of the governor",
        more="a higher integral gain of the governor",
        told_by="read the gains in the control unit",
        machine="engine",
        roles=((ShipRole.INTEGRAL_GAIN,),),
        tolerance=0.005,
    ),
    Cause(
        name="delay of governor and fuel",
        less="a shorter delay of governor and fuel",
        more="a longer delay of governor and fuel",
        told_by="test at two speeds, which tell the delay from the latency of the set point",
        machine="engine",
        roles=((ShipRole.LOOP_DELAY,),),
        is_share=False,
        wears=1,
        tolerance=1e-3,
    ),
    Cause(
        name="latency of the set point",
        less="a set point that acts earlier",
        more="a set point that acts later",
        told_by="test at two speeds, which tell the delay from the latency of the set point",
        roles=((ShipRole.SET_POINT_LATENCY,),),
        is_share=False,
        tolerance=1e-3,
    ),
    Cause(
        name="fuel actuator",
        less="a slower fuel actuator",
        more="a faster fuel actuator",
        told_by="log the fuel rack in the next test",
        machine="engine",
        roles=((ShipRole.ACTUATOR_FREQUENCY,),),
        tolerance=0.01,
    ),
    Cause(
        name="converter or magnets",
        less="less torque for the same demand: converter or magnets",
        more="more torque for the same demand: converter or magnets",
        told_by="log the torque that the converter states",
        machine="motor",
        roles=((ShipRole.PROPORTIONAL_GAIN,), (ShipRole.INTEGRAL_GAIN,)),
        wears=-1,
        tolerance=0.01,
    ),
    Cause(
        name="proportional gain of the speed controller",
        less="a lower proportional gain of the speed controller",
        more="a higher proportional gain of the speed controller",
        told_by="read the gains in the converter",
        machine="motor",
        roles=((ShipRole.PROPORTIONAL_GAIN,),),
        tolerance=0.005,
    ),
    Cause(
        name="integral gain of the speed controller",
        less="a lower integral gain of the speed controller",
        more="a higher integral gain of the speed controller",
        told_by="read the gains in the converter",
        machine="motor",
        roles=((ShipRole.INTEGRAL_GAIN,),),
        tolerance=0.005,
    ),
    Cause(
        name="dead time of the converter",
        less="a shorter dead time of controller and converter",
        more="a longer dead time of controller and converter",
        told_by="test at two speeds, or log the torque that the converter states",
        machine="motor",
        roles=((ShipRole.LOOP_DELAY,),),
        is_share=False,
        tolerance=1e-3,
    ),
    Cause(
        name="torque of the motor",
        less="a torque that follows sooner",
        more="a torque that follows later",
        told_by="log the torque that the converter states",
        machine="motor",
        roles=((ShipRole.TORQUE_TIME,),),
        is_share=False,
        tolerance=1e-3,
    ),
    Cause(
        name="propeller",
        less="less propeller torque at the same speed: cleaned, damaged, or less draught",
        more="more propeller torque at the same speed: fouled, damaged, or more draught",
        told_by="look at the propeller, and note draught and water of each test",
        roles=((ShipRole.TORQUE,),),
        wears=1,
        taken_off_by="cleaning the propeller",
        tolerance=0.025,
    ),
    Cause(
        name="inertia behind the gauge",
        less="less inertia behind the torque gauge",
        more="more inertia behind the torque gauge",
        told_by="look at the propeller",
        roles=((ShipRole.INERTIA_DOWNSTREAM, ShipRole.INERTIA),),
        tolerance=0.005,
    ),
    Cause(
        name="stiffness of the coupling",
        less="a softer coupling: aged or torn rubber",
        more="a stiffer coupling: hardened rubber, or another element",
        told_by="look at the elements of the coupling",
        roles=((ShipRole.COUPLING_STIFFNESS,),),
        tolerance=0.02,
    ),
)
"""What moves numbers by their roles."""

GAUGE = Cause(
    name="scale of the torque gauge",
    less="a torque gauge that shows less than before",
    more="a torque gauge that shows more than before",
    told_by="calibrate the torque gauge",
    roles=(),
)
"""What moves the numbers as the fingerprint states of its gauge."""

ALL_CAUSES: tuple[Cause, ...] = (*CAUSES, GAUGE)
"""Every cause, in the order of tables."""


def of_number(name: str, unit: str) -> Cause:
    """Return the change of a number that has no role, as those of a drive: each may have changed by itself."""
    told_by = f"a test that tells {name} better, see `shaftprint predict`"
    return Cause(
        name=name, less=f"a lower {name}", more=f"a higher {name}", told_by=told_by, roles=(), is_share=unit != "s"
    )


def by_role(cause: Cause, roles: Mapping[str, Role | None]) -> tuple[str, ...]:
    """Return the numbers that a cause moves by their roles; none where one that it should move is not there.

    ``roles``: role of each number.
    """
    if not may_happen(cause, roles.values()):
        return ()
    moved = [tuple(name for name, role in roles.items() if role in alike) for alike in cause.roles]
    return tuple(name for names in moved for name in names) if all(moved) else ()


def may_happen(cause: Cause, roles: Iterable[Role | None]) -> bool:
    """Return whether a cause may happen in a line whose numbers have these roles: a motor's has a torque time."""
    return cause.machine in (None, "motor" if ShipRole.TORQUE_TIME in roles else "engine")
