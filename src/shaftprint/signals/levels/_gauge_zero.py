"""The zero of the torque gauge at the quay, where the torque of the propeller goes with the square of the speed.

What the gauge shows too much it shows at every speed alike, so that its zero follows from two speeds, or from the slope
of the load about one. A constant friction behind the gauge looks the same, and is a hundredth of the torque.
"""

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

from shaftprint.digits import in_nm, stated
from shaftprint.reasons import Reason
from shaftprint.signals._working_points import WorkingPoint

if TYPE_CHECKING:
    from shaftprint.vessel._vessel import Vessel

# Standard deviation of what a constant friction may be, over the torque.
_FRICTION = 0.01
# So many standard deviations of all that a zero may be by chance speak against it; fewer where a gauge that bends looks
# alike, which makes inertia and torque coefficient wrong by as much.
_FAR, _FAR_BY_SLOPE = 3.0, 2.0
# The squares of two speeds that tell a zero are this much apart.
_APART = 0.8


def zero_between(points: Sequence[WorkingPoint]) -> tuple[float, float] | None:
    """Return the zero [N m] that the torque of two speeds tells, and its deviation; None where they are too near.

    ``points``: working points of one propeller at a fixed pitch, at the quay.
    """
    low, high = (end(points, key=lambda point: point.engine_speed_rev_s) for end in (min, max))
    square = (low.engine_speed_rev_s / high.engine_speed_rev_s) ** 2
    if square > _APART:
        return None
    zero_nm = (low.shaft_torque_nm - square * high.shaft_torque_nm) / (1.0 - square)
    return zero_nm, math.hypot(low.shaft_torque_std_nm, square * high.shaft_torque_std_nm) / (1.0 - square)


def zero_of_share(share: float, std: float, torque_nm: float) -> tuple[float, float]:
    """Return the zero [N m] that is a share of the torque without it, where the gauge shows some, and its deviation."""
    return torque_nm * share / (1.0 + share), torque_nm * std / (1.0 + share) ** 2


def zero_reason(
    zero_nm: float, std_nm: float, torque_nm: float, vessel: "Vessel", *, by_slope: bool = False
) -> Reason | None:
    """Return why the level of the torque is in doubt; None where its zero is as near as the vessel file says.

    ``zero_nm``, ``std_nm``: zero that was found, and its standard deviation [N m]. ``torque_nm``: torque of the test.
    ``by_slope``: whether the slope of the load about one speed tells it, where a gauge that bends looks alike.
    Underway the torque goes with the speed of the ship as well, and nothing tells the two apart.
    """
    sensor = vessel.sensors.shaft_torque
    usual = math.hypot(std_nm, sensor.zero_std, _FRICTION * torque_nm)
    if vessel.is_underway or not abs(zero_nm) > (_FAR_BY_SLOPE if by_slope else _FAR) * usual:
        return None
    # the torque of a shaft that turns astern is counted the other way round
    right = sensor.zero_nm + (-zero_nm if vessel.working_point.is_astern else zero_nm)
    bent = "; at one speed a gauge whose line bends looks alike, a test at two tells them apart" if by_slope else ""
    return Reason(
        kind="gauge line" if by_slope else "gauge zero",
        where=sensor.channel,
        sentence=(
            "The zero of the torque gauge is in doubt: the torque follows the square of the speed where "
            f"{stated(zero_nm, std_nm, 'N m')} are taken off, and the vessel file allows {in_nm(sensor.zero_std)}; "
            f"take the zero with the shaft standing free, or state zero_nm = {right:.0f}, and identify once more{bent}."
        ),
    )
