#!/usr/bin/env bash
# About: pymodbus 3.16.1 and pyModbusTCP, a status register of an engine whose lowest bit is set (0x0001)
# Guess: bit 0 is the first of the list, as in both for a single coil.
# What happens: pymodbus puts the high byte first: the lowest bit is entry 8, the bit of 0x0100 entry 0. pyModbusTCP gives entry 0. An alarm list that
#   is indexed by bit names another alarm.
. "$(dirname "$0")/_setup.sh"
packages pymodbus==3.16.1 pyModbusTCP
run <<'PY'
from find import seen
from pyModbusTCP.utils import get_bits_from_int
from pymodbus.client.mixin import ModbusClientMixin as Client


def place(bits):
    return [number for number, bit in enumerate(bits) if bit]


for register, one, other in ((0x0001, 8, 0), (0x0100, 0, 8), (0x8000, 7, 15)):
    found = place(Client.convert_from_registers([register], Client.DATATYPE.BITS)), place(get_bits_from_int(register, 16))
    seen(f"{register:#06x}: pymodbus entry {found[0]}, pyModbusTCP entry {found[1]}", found == ([one], [other]))
PY
