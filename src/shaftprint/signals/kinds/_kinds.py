"""Every kind of channel, in one table: a new sensor is a file with its kind, and a line here."""

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from shaftprint.signals._channel_signals import ChannelRole
from shaftprint.signals._channels import MissingChannel
from shaftprint.signals.kinds._machine_torque import MachineTorque
from shaftprint.signals.kinds._pick_up import Speed
from shaftprint.signals.kinds._pitch import Pitch, PitchSetPoint
from shaftprint.signals.kinds._rack import Rack
from shaftprint.signals.kinds._set_point import SetPoint
from shaftprint.signals.kinds._ship_speed import ShipSpeed
from shaftprint.signals.kinds._torque import ShaftTorque

if TYPE_CHECKING:
    from shaftprint.recording._recording import Recording
    from shaftprint.signals.kinds._kind import ChannelKind, Source
    from shaftprint.vessel._vessel import Vessel

KINDS: "Mapping[str, ChannelKind[Any]]" = MappingProxyType(
    {
        kind.name: kind
        for kind in (
            SetPoint(),
            PitchSetPoint(),
            MachineTorque(),
            Speed(),
            ShipSpeed(),
            Pitch(),
            ShaftTorque(),
            Rack(),
        )
    }
)
"""Kinds by symbol, in the order in which their signals stand."""


def find_sources(
    recording: "Recording", vessel: "Vessel", *, partly: bool = False
) -> "tuple[tuple[Source[Any], ...], tuple[str, ...]]":
    """Return the channels that the vessel file names, and why others are missing.

    ``recording``, ``vessel``: where to look, and what is expected. ``partly``: whether a speed alone will do, as in a
    trial of a pick-up; else every channel has to be there. Raises SignalError if one is missing, empty or in another
    unit.
    """
    # what every ship answers with is missed first
    kinds = sorted(KINDS.values(), key=lambda kind: kind.role is not ChannelRole.RESPONSE)
    sources: dict[str, tuple[Source[Any], ...]] = {}
    missing = []
    for kind in kinds:
        try:
            sources[kind.name] = kind.sources(recording, vessel)
        except MissingChannel as error:
            if not partly or isinstance(kind, Speed):
                raise
            missing.append(str(error))
    return tuple(source for name in KINDS for source in sources.get(name, ())), tuple(missing)
