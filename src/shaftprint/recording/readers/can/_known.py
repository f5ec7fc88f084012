"""Messages that a ship's engine sends under SAE J1939 and NMEA 2000, for logs that come without a DBC file.

J1939: SAE J1939-71, parameter groups 61442 (ETC1), 61443 (EEC2), 61444 (EEC1), 65247 (EEC3), 65266 (LFE). NMEA 2000:
the fields as canboat's database of parameter groups (Apache 2.0) has them.
"""

from shaftprint.recording.readers.can._messages import Message, Signal

_NMEA_INSTANCE = Signal(name="Instance", start=0, bits=8)


def _spn(number: int, name: str, start: int, bits: int, unit: str, factor: float, offset: float = 0.0) -> Signal:
    return Signal(
        name=name, start=start, bits=bits, unit=unit, factor=factor, offset=offset, spn=number, comment=name.lower()
    )


def _field(name: str, start: int, bits: int, unit: str, factor: float, *, is_signed: bool = False) -> Signal:
    return Signal(name=name, start=start, bits=bits, unit=unit, factor=factor, is_signed=is_signed)


def _j1939(group: int, name: str, *signals: Signal) -> Message:
    return Message(name=name, signals=signals, identifier=group << 8, is_j1939=True, is_of_any_sender=True)


def _nmea(group: int, name: str, *signals: Signal, is_fast: bool = False, has_instance: bool = True) -> Message:
    return Message(
        name=name,
        signals=signals,
        identifier=group << 8,
        is_of_any_sender=True,
        is_fast=is_fast,
        instance=_NMEA_INSTANCE if has_instance else None,
    )


KNOWN: tuple[Message, ...] = (
    _j1939(
        61442,
        "ETC1",
        _spn(191, "Transmission output shaft speed", 8, 16, "rpm", 0.125),
        _spn(522, "Percent clutch slip", 24, 8, "%", 0.4),
        _spn(161, "Transmission input shaft speed", 40, 16, "rpm", 0.125),
    ),
    _j1939(
        61443,
        "EEC2",
        _spn(91, "Accelerator pedal position 1", 8, 8, "%", 0.4),
        _spn(92, "Engine percent load at current speed", 16, 8, "%", 1.0),
    ),
    _j1939(
        61444,
        "EEC1",
        _spn(512, "Driver's demand engine percent torque", 8, 8, "%", 1.0, -125.0),
        _spn(513, "Actual engine percent torque", 16, 8, "%", 1.0, -125.0),
        _spn(190, "Engine speed", 24, 16, "rpm", 0.125),
        _spn(2432, "Engine demand percent torque", 56, 8, "%", 1.0, -125.0),
    ),
    _j1939(
        65247,
        "EEC3",
        _spn(514, "Nominal friction percent torque", 0, 8, "%", 1.0, -125.0),
        _spn(515, "Engine's desired operating speed", 8, 16, "rpm", 0.125),
    ),
    _j1939(65266, "LFE", _spn(183, "Engine fuel rate", 0, 16, "L/h", 0.05)),
    _nmea(
        127245,
        "Rudder",
        _field("Rudder angle order", 16, 16, "rad", 1e-4, is_signed=True),
        _field("Rudder angle", 32, 16, "rad", 1e-4, is_signed=True),
    ),
    _nmea(
        127488,
        "Engine parameters, rapid update",
        _field("Engine speed", 8, 16, "rpm", 0.25),
        _field("Boost pressure", 24, 16, "Pa", 100.0),
        _field("Tilt or trim", 40, 8, "%", 1.0, is_signed=True),
    ),
    _nmea(
        127489,
        "Engine parameters, dynamic",
        _field("Engine oil pressure", 8, 16, "Pa", 100.0),
        _field("Engine oil temperature", 24, 16, "K", 0.1),
        _field("Engine temperature", 40, 16, "K", 0.01),
        _field("Alternator potential", 56, 16, "V", 0.01, is_signed=True),
        _field("Fuel rate", 72, 16, "L/h", 0.1, is_signed=True),
        _field("Total engine hours", 88, 32, "s", 1.0),
        _field("Coolant pressure", 120, 16, "Pa", 100.0),
        _field("Fuel pressure", 136, 16, "Pa", 1000.0),
        _field("Percent engine load", 192, 8, "%", 1.0, is_signed=True),
        _field("Percent engine torque", 200, 8, "%", 1.0, is_signed=True),
        is_fast=True,
    ),
    _nmea(
        127493,
        "Transmission parameters, dynamic",
        _field("Transmission gear", 8, 2, "", 1.0),
        _field("Transmission oil pressure", 16, 16, "Pa", 100.0),
        _field("Transmission oil temperature", 32, 16, "K", 0.1),
    ),
    _nmea(128259, "Speed", _field("Speed through water", 8, 16, "m/s", 0.01), has_instance=False),
    _nmea(129026, "COG and SOG, rapid update", _field("Speed over ground", 32, 16, "m/s", 0.01), has_instance=False),
)
"""What can be read of a log without a DBC file."""
