#!/usr/bin/env bash
# About: lmfit 1.3.4, odrpack 0.7.0 and iminuit 2.33.0: one straight line through one record whose noise is stated as 1
# Guess: who states the noise gets standard deviations that follow from it, the same in all three.
# What happens: lmfit and odrpack scale with what is left over (reduced chi-square, here 9.9) though the noise was stated, iminuit
#   does not: the slope is known to 0.227 or to 0.072. Each is right under an assumption of its own; neither is printed beside the number.
. "$(dirname "$0")/_setup.sh"
packages lmfit==1.3.4 odrpack==0.7.0 iminuit==2.33.0
run <<'PY'
import iminuit
import lmfit
import numpy as np
import odrpack
from find import seen
from iminuit.cost import LeastSquares

x = np.linspace(0, 10, 21)
y = 2 * x + 1 + 2.5 * np.random.default_rng(3).normal(size=21)
stated = np.sqrt(np.linalg.inv(np.c_[x, np.ones(21)].T @ np.c_[x, np.ones(21)])[0, 0])
left = y - np.polyval(np.polyfit(x, y, 1), x)
scaled = stated * np.sqrt(left @ left / 19)

fit = lmfit.models.LinearModel().fit(y, x=x, weights=np.ones(21), slope=1, intercept=0)
by_lmfit = fit.params["slope"].stderr
by_odrpack = odrpack.odr_fit(lambda x, b: b[0] * x + b[1], x, y, np.array([1.0, 0.0]), weight_y=1.0, task="OLS").sd_beta[0]
minuit = iminuit.Minuit(LeastSquares(x, y, 1.0, lambda x, a, b: a * x + b), a=1, b=0)
minuit.migrad()
by_iminuit = minuit.errors["a"]
seen(f"from the stated noise {stated:.4f}, from what is left over {scaled:.4f}", scaled > 3 * stated)
seen(f"lmfit   {by_lmfit:.4f}", abs(by_lmfit / scaled - 1) < 1e-2)
seen(f"odrpack {by_odrpack:.4f}", abs(by_odrpack / scaled - 1) < 1e-2)
seen(f"iminuit {by_iminuit:.4f}", abs(by_iminuit / stated - 1) < 1e-2)
PY
