#!/usr/bin/env bash
# About: derivative 0.6.3, dxdt(speed, t, kind="savitzky_golay", left=5, right=5, order=1) of a speed at 10 Hz that rises by 100 rpm within a second
# Guess: the window is five samples on either side, as in SciPy's filter of that name: a slope of about 100 rpm/s for about a second.
# What happens: left and right are in the unit of t: five seconds on either side. The slope is 14.8 rpm/s over 7 s; five samples are left=0.5, right=0.5: 100 rpm/s over 1 s.
. "$(dirname "$0")/_setup.sh"
packages "derivative==0.6.3"
run <<'PY'
import numpy as np
from derivative import dxdt
from find import seen

times = np.arange(0, 60, 0.1)
speed = 1000.0 + 100.0 * np.clip(times - 30.0, 0.0, 1.0)
for window, slope, seconds in ((5.0, 14.7, 7.0), (0.5, 98.2, 1.1)):
    found = dxdt(speed, times, kind="savitzky_golay", left=window, right=window, order=1)
    wide = 0.1 * float(np.count_nonzero(found > 0.5 * found.max()))
    seen(f"left=right={window:g}: {found.max():.1f} rpm/s, above half of it for {wide:.1f} s", abs(found.max() / slope - 1.0) < 0.03 and abs(wide - seconds) < 0.35)
PY
