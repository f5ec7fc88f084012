#!/usr/bin/env bash
# About: pyedflib 0.1.42, EDF+ (biosignals, also written by portable loggers)
# Guess: 2.5 s of torque come back as 2.5 s; a value beyond the range, or missing, is refused; 99.99 Hz stays.
# What happens: 3.0 s come back, the last half second about 0 N m. 5000 N m are the largest, a missing value is the lowest: -4000 N m. At 99.99 Hz 1000 samples are 1818 at
#   99.99010 Hz.
. "$(dirname "$0")/_setup.sh"
packages pyedflib==0.1.42
run <<'PY'
import numpy as np
import pyedflib
from find import seen


def again(torque_nm, rate_hz):
    head = {"label": "torque", "dimension": "Nm", "sample_frequency": rate_hz, "transducer": "", "prefilter": ""}
    head |= {"physical_max": 4000, "physical_min": -4000, "digital_max": 32767, "digital_min": -32768}
    with pyedflib.EdfWriter("torque.edf", 1, file_type=pyedflib.FILETYPE_EDFPLUS) as file:
        file.setSignalHeaders([head])
        file.writeSamples([torque_nm])
    with pyedflib.EdfReader("torque.edf") as file:
        return file.readSignal(0), float(file.getSampleFrequency(0))


written = np.full(250, 1500.0)
written[10], written[20] = 5000.0, np.nan
found, _ = again(written, 100)
seen(f"250 samples at 100 Hz: {found.size}, the last {found[-1]:.2f} N m", found.size == 300 and abs(found[250:]).max() < 0.1)
seen(f"5000 and missing: {found[10]:.0f} and {found[20]:.0f} N m", (round(found[10]), round(found[20])) == (4000, -4000))
found, rate_hz = again(np.full(1000, 1500.0), 99.99)
seen(f"1000 samples at 99.99 Hz: {found.size} at {rate_hz:.5f} Hz", found.size == 1818 and round(rate_hz, 5) == 99.9901)
PY
