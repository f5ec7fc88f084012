"""What a test may move beside the set point of the speed, as the vessel file knows it before any recording."""

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

from shaftprint.campaign._campaign import Campaign
from shaftprint.signals._channel_signals import ChannelRole
from shaftprint.signals.kinds._kinds import KINDS
from shaftprint.vessel._vessel import Vessel

PITCH_SET_POINT, MACHINE_TORQUE = "pitch_set_point", "machine_torque"
EXCITATIONS: Mapping[str, str] = MappingProxyType(
    {kind.name: kind.sensor for kind in KINDS.values() if kind.role is ChannelRole.EXCITATION}
)
"""What a test may move: the input by which a campaign names it, by the symbol of structures."""


@dataclass(frozen=True, kw_only=True, slots=True)
class MovedBeside:
    """One input beside the set point of the speed."""

    symbol: str
    """Symbol by which structures name it, such as ``theta_set``."""
    input: str
    """Table of the vessel file's sensors, by which a campaign names it."""
    share_per_v: float
    """Change over the value at the working point for one volt [1/V]; of a torque over that of the shaft."""


def moved_beside(vessel: Vessel, campaign: Campaign) -> tuple[MovedBeside, ...]:
    """Return what a campaign moves beside the speed and the vessel file has a sensor of."""
    shares = {
        symbol: _share_per_v(vessel, campaign, name) for symbol, name in EXCITATIONS.items() if name in campaign.inputs
    }
    return tuple(
        MovedBeside(symbol=symbol, input=EXCITATIONS[symbol], share_per_v=abs(share))
        for symbol, share in shares.items()
        if share
    )


def _share_per_v(vessel: Vessel, campaign: Campaign, name: str) -> float:
    """Return what one volt changes over the working point; 0 of what has no sensor, and of the speed itself."""
    pitch, machine, torque = vessel.sensors.pitch_set_point, vessel.shaft_machine, vessel.sensors.machine_torque
    if name == PITCH_SET_POINT and pitch is not None:
        stands = pitch.pitch_ratio_at_zero_v + pitch.pitch_ratio_per_v * campaign.middle_v(name)
        return pitch.pitch_ratio_per_v / stands
    if name == MACHINE_TORQUE and machine is not None and torque is not None:
        return machine.shaft_nm(torque.torque_nm_per_v) / vessel.working_point.driving_torque_nm
    return 0.0
