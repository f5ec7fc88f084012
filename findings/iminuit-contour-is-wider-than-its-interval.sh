#!/usr/bin/env bash
# About: iminuit 2.33.0, mncontour against minos on one straight line
# Guess: the 68 % contour of two parameters touches the ends of their 68 % intervals, as in the textbook figure.
# What happens: minos holds one parameter with 68 %, the contour both at once with 68 %: it reaches 1.51 times as far. An interval read off the
#   contour's edge is half as wide again; cl=0.3935 gives the contour of the figure.
. "$(dirname "$0")/_setup.sh"
packages iminuit==2.33.0 scipy==1.17.1
run <<'PY'
import numpy as np
from find import seen
from iminuit import Minuit
from iminuit.cost import LeastSquares

x = np.linspace(0, 10, 21)
y = 2 * x + 1 + np.random.default_rng(3).normal(size=21)
minuit = Minuit(LeastSquares(x, y, 1.0, lambda x, a, b: a * x + b), a=1, b=0)
minuit.migrad()
minuit.minos()
interval = (minuit.merrors["a"].upper - minuit.merrors["a"].lower) / 2


def reach(**how):
    slopes = minuit.mncontour("a", "b", size=200, **how)[:, 0]
    return (slopes.max() - slopes.min()) / 2 / interval


seen(f"minos: +-{interval:.4f}", abs(interval - 0.0721) < 1e-3)
seen(f"mncontour reaches {reach():.3f} times as far", abs(reach() - 1.51) < 0.02)
seen(f"mncontour(cl=0.3935) {reach(cl=0.3935):.3f} times", abs(reach(cl=0.3935) - 1) < 0.02)
PY
