"""Raw frames of an engine's control unit, written by another library as CAN loggers write them, and their DBC file."""

from collections.abc import Iterable

import numpy as np
from asammdf import MDF, Signal, Source
from asammdf.blocks import v4_constants

# SAE J1939-71: EEC1 is PGN 61444, EEC2 61443; priority 3, source address 0 is the engine.
EEC1, EEC2 = 0x0CF00400, 0x0CF00300

DBC = """VERSION ""
NS_ :
BS_:
BU_: ECU
BO_ 2364540158 EEC1: 8 ECU
 SG_ DriversDemandPercentTorque : 8|8@1+ (1,-125) [-125|125] "%" ECU
 SG_ ActualEnginePercentTorque : 16|8@1+ (1,-125) [-125|125] "%" ECU
 SG_ EngineSpeed : 24|16@1+ (0.125,0) [0|8031.875] "rpm" ECU
BO_ 2364539902 EEC2: 8 ECU
 SG_ AcceleratorPedalPosition1 : 8|8@1+ (0.4,0) [0|100] "%" ECU
 SG_ EnginePercentLoadAtCurrentSpeed : 16|8@1+ (1,0) [0|250] "%" ECU
CM_ SG_ 2364540158 EngineSpeed "actual speed of the crankshaft";
BA_DEF_ SG_ "SPN" INT 0 524287;
BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","ExtendedCAN","reserved","J1939PG";
BA_DEF_ "ProtocolType" STRING ;
BA_DEF_DEF_ "SPN" 0;
BA_DEF_DEF_ "VFrameFormat" "J1939PG";
BA_DEF_DEF_ "ProtocolType" "";
BA_ "ProtocolType" "J1939";
BA_ "VFrameFormat" BO_ 2364540158 3;
BA_ "VFrameFormat" BO_ 2364539902 3;
BA_ "SPN" SG_ 2364540158 DriversDemandPercentTorque 512;
BA_ "SPN" SG_ 2364540158 ActualEnginePercentTorque 513;
BA_ "SPN" SG_ 2364540158 EngineSpeed 190;
BA_ "SPN" SG_ 2364539902 AcceleratorPedalPosition1 91;
BA_ "SPN" SG_ 2364539902 EnginePercentLoadAtCurrentSpeed 92;
"""

_FRAME = np.dtype(
    [
        ("CAN_DataFrame.BusChannel", "<u1"),
        ("CAN_DataFrame.ID", "<u4"),
        ("CAN_DataFrame.IDE", "<u1"),
        ("CAN_DataFrame.DLC", "<u1"),
        ("CAN_DataFrame.DataLength", "<u1"),
        ("CAN_DataFrame.DataBytes", "(8,)u1"),
    ]
)


def eec1(percent, rpm):
    """Bytes of EEC1, shape (messages, 8): torque 1 % a bit from -125 % on, speed 1/8 rpm a bit."""
    content = np.full((len(percent), 8), 0xFF, dtype=np.uint8)
    content[:, 1] = content[:, 2] = np.rint(np.asarray(percent) + 125.0)
    content[:, 3:5] = np.rint(8.0 * np.asarray(rpm)).astype("<u2").view(np.uint8).reshape(-1, 2)
    return content


def eec2(pedal_percent, load_percent):
    """Bytes of EEC2, shape (messages, 8): pedal 0.4 % a bit, load 1 % a bit."""
    content = np.full((len(pedal_percent), 8), 0xFF, dtype=np.uint8)
    content[:, 1] = np.rint(np.asarray(pedal_percent) / 0.4)
    content[:, 2] = np.rint(load_percent)
    return content


def raw_log(path, frames, analog: Iterable[Signal] = ()):
    """Write frames, each a time, an identifier and eight bytes, into MDF 4.10 beside analog signals on one clock."""
    time_s = np.concatenate([times for times, _, _ in frames])
    order = np.argsort(time_s, kind="stable")
    records = np.zeros(time_s.size, dtype=_FRAME)
    records["CAN_DataFrame.BusChannel"] = records["CAN_DataFrame.IDE"] = 1
    records["CAN_DataFrame.DLC"] = records["CAN_DataFrame.DataLength"] = 8
    records["CAN_DataFrame.ID"] = np.concatenate([np.full(times.size, number) for times, number, _ in frames])
    records["CAN_DataFrame.DataBytes"] = np.concatenate([content for _, _, content in frames])
    file = MDF(version="4.10")
    signals = list(analog)
    if signals:
        file.append(signals)
    bus = Source("CAN", "CAN", "bus logging", v4_constants.SOURCE_BUS, v4_constants.BUS_TYPE_CAN)
    file.append(Signal(records[order], time_s[order], name="CAN_DataFrame", source=bus), comment="CAN logging")
    group = file.groups[-1].channel_group
    group.flags |= v4_constants.FLAG_CG_BUS_EVENT | v4_constants.FLAG_CG_PLAIN_BUS_EVENT
    file.save(path, overwrite=True)
    file.close()
    return path
