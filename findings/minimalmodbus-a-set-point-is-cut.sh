#!/usr/bin/env bash
# About: minimalmodbus 2.1.1, write_register of values with decimals; the port is an object that keeps the bytes
# Guess: 4.35 with two decimals is written as 435.
# What happens: as 434. The product 434.99999999999994 is cut off, not rounded: 573 of the 9999 values from 0.01 to 99.99 are one count too low. Of negative ones
#   -0.29 is -28, one too high. Read back and written again, such a value falls by a count each time.
. "$(dirname "$0")/_setup.sh"
packages minimalmodbus==2.1.1
run <<'PY'
import minimalmodbus
from find import seen


class Port:
    """A slave that answers as the standard says: it repeats what it was told."""

    port, baudrate, timeout, is_open, told = "none", 19200, 0.05, True, b""

    def write(self, told):
        self.told = told

    def read(self, _):
        return self.told

    def reset_input_buffer(self):
        pass

    reset_output_buffer = open = close = reset_input_buffer


port = Port()
instrument = minimalmodbus.Instrument(port, 1)


def written(value, decimals):
    instrument.write_register(1, value, decimals, functioncode=6, signed=True)
    return int.from_bytes(port.told[4:6], "big", signed=True)


for value, decimals, counts in ((4.35, 2, 434), (0.29, 2, 28), (-0.29, 2, -28), (77.7, 1, 777)):
    found = written(value, decimals)
    seen(f"{value} with {decimals} decimals: {found}", found == counts)
low = [counts for counts in range(1, 10_000) if written(counts / 100, 2) != counts]
seen(f"of 9999 values {len(low)} are another", len(low) == 573)
value, counts = 1.16, []
for _ in range(3):
    counts.append(written(value, 2))
    value = counts[-1] / 100
seen(f"1.16 written, and what was read again: {counts}", counts == [115, 114, 113])
PY
