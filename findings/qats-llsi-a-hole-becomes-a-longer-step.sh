#!/usr/bin/env bash
# About: qats 5.5.0 (TimeSeries.filter) and llsi 0.5.0 (SysIdData.equidistant) on a record of 70 samples at 10 Hz with a hole from 5 to 8 s; qats' get(resample=0.25) of 100 s
# Guess: samples stay 0.1 s apart, and the hole is kept, refused or filled with 30 samples; resampled, they come every 0.25 s.
# What happens: the number of samples is kept, and their step is made even: 0.1435 s throughout, with a straight line over the hole. A filter of qats works on that. Resampled to 0.25 s, samples come every 0.24975 s. Neither says so.
. "$(dirname "$0")/_setup.sh"
# qats comes without its windows
packages --no-deps "qats==5.5.0" "llsi==0.5.0" numpy scipy pandas matplotlib h5py nptdms pymatreader xmltodict packaging pillow cycler \
	kiwisolver contourpy fonttools pyparsing python-dateutil six scikit-learn joblib threadpoolctl tqdm numba llvmlite
run <<'PY'
import llsi
import numpy as np
from find import seen
from qats import TimeSeries

times = np.r_[np.arange(0, 5, 0.1), np.arange(8, 10, 0.1)]
speed = np.where(times < 5.0, 1000.0, 1300.0)
filtered, _ = TimeSeries("n", times, speed).filter("lp", 2.0)
step = float(np.diff(filtered).mean())
seen(f"qats: {filtered.size} samples, step {step:.4f} s", filtered.size == 70 and abs(step - 9.9 / 69) < 1e-9)
even, _ = TimeSeries("n", np.arange(0, 100, 0.1), np.zeros(1000)).get(resample=0.25)
seen(f"qats, resample=0.25: every {even[1] - even[0]:.5f} s", abs(even[1] - even[0] - 99.9 / 400) < 1e-9)
record = llsi.SysIdData(y=speed, t=times)
record.equidistant()
between = int(np.count_nonzero((record["y"] > 1000.0) & (record["y"] < 1300.0)))
seen(f"llsi: {record['y'].size} samples, step {record.Ts:.4f} s, {between} of them on a line over the hole", record["y"].size == 70 and abs(record.Ts - 9.9 / 69) < 1e-9 and between > 15)
PY
