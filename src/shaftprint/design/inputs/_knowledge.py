"""The noun ``Knowledge``: all that is known of a ship before its test is planned."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING

from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.notebook._shown import Shown

if TYPE_CHECKING:
    from shaftprint.identify.likelihood._prior import Prior
    from shaftprint.identify.prediction._noise_levels import NoiseLevels


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Knowledge(Shown):
    """What is known of a ship before its test is planned."""

    vessel: str
    """Name of the vessel and shaft line."""
    ship: AssumedShip
    """What is assumed of it."""
    limits: Limits
    """What ship and engine allow."""
    line: SetPointLine
    """From volts to engine speed."""
    noise: "Mapping[float, NoiseLevels]"
    """Noise at each planned speed, by its share of the working point; their order is that of the legs."""
    noise_spread: float = 0.0
    """Standard deviation of the logarithm of the noise's amplitude: how far it may be from that level; 0 where it was
    measured well."""
    noise_is_assumed: bool = False
    """Whether nobody recorded it: on each possible ship it is then what goes through that ship's loop."""
    possible: AssumedShip | None = None
    """The ships on which the test may be sailed, for what is promised of it; ``ship`` where not given."""
    noise_source: str
    """Where it comes from, in words."""
    priors: "Mapping[str, Prior]"
    """What the fit will know besides, by parameter."""
    remarks: tuple[str, ...] = ()
    """What the plan leaves alone, in sentences."""
