#!/usr/bin/env bash
# About: IMCtermite 2.1.18 (built on installation: needs a C++ compiler), an imc file of two signals whose samples stand in turn, of 1024 Hz, in ampere, triggered at 12.75 s; and a word of 16 bits
# Guess: two channels of 5 samples each; times of 1/1024 s; 1.5e-10 A as they are; the trigger at 12.75 s; the channel of bit 2 is 0 or 1.
# What happens: each channel has all 10 samples, its own and the other's in turn; times are printed with four decimals (0.0010, 0.0020, 0.0029 s), values with nine (0); the trigger is at
#   12 s; bit 2 is the whole word. Nothing is said of any of it.
. "$(dirname "$0")/_setup.sh"
packages "imctermite==2.1.18" "numpy"
run <<'PY'
import numpy as np
from find import seen
import imctermite


def block(key, *parameters):
    content = ",".join(str(one) for one in parameters)
    return f"|{key},1,{len(content)},{content};\r\n"


def write(name, kind, size, samples, channels, step=1 / 1024, digital=1):
    length = len(samples)
    parts = [
        block("CC", 1, digital)
        + block("CP", number, size, kind, 8 * size, 0, offset, 1, apart)
        + block("Cb", 1, 0, number, 1, 0, length, 0, length, 1, 0, 0, "")
        + (block("CR", 0, 1, 0, 1, 1, "A") if digital == 1 else "")
        + block("CN", 0, 0, bit, len(title), title, 0, "")
        for number, (title, offset, apart, bit) in enumerate(channels, start=1)
    ]
    head = "|CF,2,1,1;|CK,1,3,1,1;\r\n" + "".join(
        block("CG", 1, 1, 1) + block("CD", f"{step:.16E}", 1, 1, "s", 0, 0, 0) + block("NT", 5, 3, 2026, 9, 0, 12.75) + part
        for part in parts
    )
    with open(name, "wb") as file:
        file.write(head.encode() + f"|CS,1,{length + 2},1,".encode() + samples + b";")
    return {one["group"]["name"]: one for one in imctermite.imctermite(name.encode()).get_channels(True)}


both = np.column_stack([np.arange(5.0), -np.arange(5.0)])
channels = write("turn.dat", 8, 8, both.tobytes(), [("a", 0, 8, 0), ("b", 8, 8, 0)])
print(channels["a"]["ydata"], channels["a"]["xdata"])
seen(
    f"{[len(one['ydata']) for one in channels.values()]} samples of two channels of 5 each; the second: {channels['b']['ydata'][:4]}",
    [one["ydata"] for one in channels.values()] == [both.ravel().tolist()] * 2,
)
seen(f"times of 1/1024 s: {channels['a']['xdata'][1:4]}", channels["a"]["xdata"][1:4] == [0.001, 0.002, 0.0029])
seen(f"triggered at 12.75 s: {channels['a']['trigger-time']}", channels["a"]["trigger-time"].endswith(":12"))
small = write("small.dat", 8, 8, np.full(2, 1.5e-10).tobytes(), [("a", 0, 0, 0)])["a"]["ydata"]
seen(f"1.5e-10 A: {small}", small == [0.0, 0.0])
bits = write("bits.dat", 11, 2, np.array([0, 2, 7], dtype="<u2").tobytes(), [("bit 2", 0, 0, 2)], digital=2)["bit 2"]["ydata"]
seen(f"bit 2 of the words 0, 2, 7: {bits}", bits == [0.0, 2.0, 7.0])
PY
