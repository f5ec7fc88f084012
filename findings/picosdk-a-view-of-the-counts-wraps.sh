#!/usr/bin/env bash
# About: picosdk 1.1 (PicoScope), adc2mV of counts from -32767 to 32767 at 5 V full scale, from the buffer that the driver fills and from a NumPy view of it
# Guess: both give 4883 mV for 32000 counts.
# What happens: the buffer does. From the view each count stays a number of 16 bits, and its product with 5000 wraps: 0.81 mV for 4883, -0.74 mV for 15.26; NumPy warns of an overflow, where warnings are shown.
. "$(dirname "$0")/_setup.sh"
packages "picosdk==1.1" "numpy==2.3.5"
run <<'PY'
import ctypes

import numpy as np
from find import seen
from picosdk.functions import adc2mV

five_volts, most = 8, ctypes.c_int16(32767)
buffer = (ctypes.c_int16 * 3)(32000, -32000, 100)
plain = [float(one) for one in adc2mV(buffer, five_volts, most)]
view = [float(one) for one in adc2mV(np.ctypeslib.as_array(buffer), five_volts, most)]
seen(f"from the buffer: {plain[0]:.2f}, {plain[1]:.2f}, {plain[2]:.2f} mV", np.allclose(plain, [4882.96, -4882.96, 15.259], atol=0.01))
seen(f"from a NumPy view of it: {view[0]:.2f}, {view[1]:.2f}, {view[2]:.2f} mV", np.allclose(view, [0.8125, -0.8125, -0.7412], atol=1e-3))
PY
