#!/usr/bin/env bash
# About: can-decoder 0.1.9 (with canmatrix 1.3.3) on frames of a J1939 bus, the DBC with the attributes of J1939
# Guess: FExx, the mark of an error, is no speed; frames of 11 bits that the DBC holds are decoded too; a frame cut to 5 bytes is left out, or gives the signals that it holds.
# What happens: FFxx is left out, but FEFF is 8159.875 rpm, beyond the largest that the DBC allows; frames of 11 bits are left out without a word; one short frame among them
#   takes all of its message with it, with a warning.
. "$(dirname "$0")/_setup.sh"
packages can-decoder==0.1.9 canmatrix==1.3.3 pandas==3.1.1
cat >"$scratch/ship.dbc" <<'DBC'
VERSION ""
NS_ :
BS_:
BU_: E
BO_ 2364539904 EEC1: 8 E
 SG_ EngineSpeed : 24|16@1+ (0.125,0) [0|8031.875] "rpm" E
BO_ 291 Shaft: 8 E
 SG_ Torque : 0|16@1- (0.5,0) [-16384|16383.5] "Nm" E
BA_DEF_ BO_ "VFrameFormat" ENUM "StandardCAN","ExtendedCAN","reserved","J1939PG";
BA_DEF_ "ProtocolType" STRING ;
BA_DEF_DEF_ "VFrameFormat" "StandardCAN";
BA_DEF_DEF_ "ProtocolType" "";
BA_ "ProtocolType" "J1939";
BA_ "VFrameFormat" BO_ 2364539904 3;
DBC
run <<'PY'
import can_decoder
import pandas as pd
from find import seen

decoder = can_decoder.DataFrameDecoder(can_decoder.load_dbc("ship.dbc"))
engine, shaft = (0x0CF00400, True), (0x123, False)
frames = [(engine, "ffffffe02effffff"), (engine, "ffffffffffffffff"), (engine, "fffffffffeffffff"), (shaft, "b80b000000000000")]


def decoded(frames):
    rows = [
        {"TimeStamp": pd.Timestamp("2026-11-30T12:00:00Z") + pd.Timedelta(milliseconds=10 * number), "ID": head[0], "IDE": head[1], "DataBytes": list(bytes.fromhex(data)),
         "DLC": len(data) // 2, "DataLength": len(data) // 2}
        for number, (head, data) in enumerate(frames)
    ]
    table = decoder.decode_frame(pd.DataFrame(rows).set_index("TimeStamp"))
    return [] if table.empty else list(zip(table["Signal"], table["Physical Value"], strict=True))


seen(f"1500 rpm, not available, error, 1500 N m: {decoded(frames)}", decoded(frames) == [("EngineSpeed", 1500.0), ("EngineSpeed", 8159.875)])
short = [*frames, (engine, "ffffffe02e")]
seen(f"and 1500 rpm in a frame of 5 bytes:       {decoded(short)}", decoded(short) == [])
PY
