#!/usr/bin/env bash
# About: ruptures 1.1.10, a noise-free level that changes after 137 and after 201 of 300 samples
# Guess: every method finds 137 and 201.
# What happens: Pelt, Binseg, BottomUp, Dynp and Window look at every fifth sample alone (jump=5) and say 135 and 200, whatever the noise: of a log with a value a
#   minute an event is up to five minutes off. KernelCPD of the same library says 137 and 201, and so does Pelt with jump=1.
. "$(dirname "$0")/_setup.sh"
packages ruptures==1.1.10
run <<'PY'
import numpy as np
import ruptures as rpt
from find import seen

level = np.repeat([0.0, 1.0, 3.0], [137, 64, 99])
for search in (rpt.Binseg(model="l2"), rpt.BottomUp(model="l2"), rpt.Dynp(model="l2"), rpt.Window(width=40, model="l2")):
    changes = [int(one) for one in search.fit(level).predict(n_bkps=2)]
    seen(f"{type(search).__name__:8} {changes}", changes == [135, 200, 300])
changes = rpt.Pelt(model="l2").fit(level).predict(pen=1)
seen(f"Pelt     {changes}", changes == [135, 200, 300])
changes = rpt.Pelt(model="l2", jump=1).fit(level).predict(pen=1)
seen(f"Pelt, jump=1 {changes}", changes == [137, 201, 300])
changes = [int(one) for one in rpt.KernelCPD(kernel="linear").fit(level).predict(n_bkps=2)]
seen(f"KernelCPD {changes}", changes == [137, 201, 300])
PY
