"""The verb ``play_on_board``: a test played through a counterpart that is reached by its address."""

import asyncio
import signal
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from shaftprint.errors import LiveError
from shaftprint.escape import printable
from shaftprint.live._block import Event
from shaftprint.live._counterpart import Counterpart
from shaftprint.live._engine import LiveTest
from shaftprint.live._outcome import Operator, Outcome
from shaftprint.live._page import LivePages, watched
from shaftprint.live._record import Left
from shaftprint.live._recorded import recorded
from shaftprint.live._stop_rule import advice_by
from shaftprint.live.counterparts._can_bus import CanCounterpart
from shaftprint.live.counterparts._modbus import ModbusCounterpart
from shaftprint.live.counterparts._mqtt import PORTS as MQTT_PORTS
from shaftprint.live.counterparts._mqtt import MqttCounterpart
from shaftprint.live.counterparts._opcua import OpcUaCounterpart

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.design.planned_test._planned_test import PlannedTest
    from shaftprint.live._envelope import Envelope
    from shaftprint.live.counterparts._access import Access
    from shaftprint.vessel._vessel import Vessel

_SCHEMES = ("opc.tcp", *MQTT_PORTS, "modbus", "can")


def counterpart_at(url: str, access: "Access", places: Path | None = None) -> Counterpart:
    """Return the counterpart of an address.

    ``places``: the file that says which registers or messages hold what. Raises LiveError if no protocol has that
    address, or such a file is missing or in excess; SettingsError if it cannot be used.
    """
    scheme = url.partition("://")[0]
    if (places is not None) != (scheme in ("modbus", "can")) and scheme in _SCHEMES:
        wanted = "a file" if places is None else "no file"
        raise LiveError(f"{scheme}: expected {wanted} that says which registers or messages hold what (--places).")
    if scheme == "opc.tcp":
        return OpcUaCounterpart(url, access=access)
    if scheme in MQTT_PORTS:
        return MqttCounterpart(url, access)
    if scheme == "modbus" and places is not None:
        return ModbusCounterpart(url, places, access)
    if scheme == "can" and places is not None:
        return CanCounterpart(url, places, access)
    raise LiveError(f"expected an address that begins with {', '.join(_SCHEMES)}, found {printable(scheme)}.")


def play_on_board(
    url: str,
    vessel: "Vessel",
    campaign: "Campaign",
    envelope: "Envelope",
    path: Path,
    *,
    access: "Access",
    confirm: Callable[[str], bool],
    operator: Operator | None = None,
    places: Path | None = None,
    dry: bool = False,
    planned: "PlannedTest | None" = None,
    proves: "Callable[[Campaign], Sequence[str]] | None" = None,
    most_s: float | None = None,
    slope_rpm_per_v: float | None = None,
    told: Callable[[Event], None] = lambda event: None,
    pages: LivePages | None = None,
) -> tuple[Outcome, Left]:
    """Play a test through the counterpart of an address, and write what it leaves.

    An interrupt of the program aborts the test.

    Parameters
    ----------
    url
        Address of the counterpart, such as ``opc.tcp://host:4840`` or ``mqtts://host/prefix``.
    vessel, campaign, envelope
        What is on board, what is played, and what the owner allows.
    path
        The recording to write.
    access
        User or certificate of the link.
    confirm
        Asks on the bridge, and returns whether yes was said; it may take its time.
    operator
        Who may hold it, skip and repeat legs, and stop it.
    places
        Of Modbus and CAN, the file that says which registers or messages hold what.
    dry
        Whether nothing is written to the counterpart.
    planned
        The plan by whose wishes legs end early, go on and come again; all is played as it stands without it.
    proves
        Says why a changed campaign may not be played; nothing is changed without it but that it is held.
    most_s
        Longest time that is played by what is known [s]; that of the campaign where not given.
    slope_rpm_per_v
        What one volt asks for [rpm/V], as the proof takes it; the speed is not held against the set point without it.
    told
        Is told each event.
    pages
        Show the test in a browser of this computer.

    Raises
    ------
    LiveError
        If the counterpart is not reached.
    RecordingError
        If the recording is there already or cannot be written.
    """
    counterpart, operator = counterpart_at(url, access, places), operator or Operator()

    async def asked(question: str) -> bool:
        return await asyncio.to_thread(confirm, question)

    operator.confirm = asked
    test = partial(
        LiveTest,
        vessel=vessel,
        campaign=campaign,
        envelope=envelope,
        operator=operator,
        slope_rpm_per_v=slope_rpm_per_v,
        **watched(told, pages),
        dry=dry,
        advises=None if planned is None else advice_by(planned),
        proves=proves,
        most_s=most_s,
    )
    before = signal.signal(signal.SIGINT, lambda number, frame: setattr(operator, "stops", "interrupted"))
    try:
        _, outcome, left = asyncio.run(recorded(counterpart, path, test))
    finally:
        signal.signal(signal.SIGINT, before)
    return outcome, left
