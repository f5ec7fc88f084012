#!/usr/bin/env bash
# About: canopen 2.4.1, an EDS file with a torque of type INTEGER16 from 0x8000 to 0x7FFF whose default is 0xFFFF; numbers for its object
# Guess: as the limits are -32768 and 32767, the default is -1; a raw value of 12.7 is 13, as physical values are rounded.
# What happens: the limits are -32768 and 32767, but the default is 65535, which its own type refuses when it is written. A raw value of 12.7 is cut to 12, while the same through a factor of 1 is 13.
. "$(dirname "$0")/_setup.sh"
packages "canopen==2.4.1"
run <<'PY'
import io

import canopen
from canopen.objectdictionary import ODVariable, datatypes
from find import seen

EDS = """[FileInfo]
FileName=drive.eds
[DeviceInfo]
[MandatoryObjects]
SupportedObjects=1
1=0x1000
[1000]
ParameterName=Device type
ObjectType=0x7
DataType=0x0007
AccessType=ro
DefaultValue=0
[ManufacturerObjects]
SupportedObjects=1
1=0x2000
[2000]
ParameterName=Torque
ObjectType=0x7
DataType=0x0003
AccessType=rw
DefaultValue=0xFFFF
LowLimit=0x8000
HighLimit=0x7FFF
"""
file = io.StringIO(EDS)
file.name = "drive.eds"
torque = canopen.import_od(file, 5)["Torque"]
seen(f"limits {torque.min}, {torque.max}", (torque.min, torque.max) == (-32768, 32767))
seen(f"default {torque.default}", torque.default == 65535)
try:
    torque.encode_raw(torque.default)
    answer = "written"
except ValueError:
    answer = "ValueError"
seen(f"the default, written: {answer}", answer == "ValueError")
count = ODVariable("Torque", 0x2000)
count.data_type = datatypes.INTEGER16
count.factor = 1
raw = int.from_bytes(count.encode_raw(12.7), "little")
seen(f"12.7 as a raw value: {raw}", raw == 12)
physical = int.from_bytes(count.encode_raw(count.encode_phys(12.7)), "little")
seen(f"12.7 as a physical value: {physical}", physical == 13)
PY
