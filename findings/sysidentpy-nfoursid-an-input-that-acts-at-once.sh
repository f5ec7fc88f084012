#!/usr/bin/env bash
# About: sysidentpy 0.9.0 (FROLS, lags of the input up to 4) and nfoursid 1.0.2 on two records of one lag, of which the first acts in the sample of its input, the second one sample later
# Guess: both packages find pole and gain of both, with a gain at once in the first.
# What happens: lags of sysidentpy begin at one sample. Where the input acts at once it drops out of the model: the speed alone is left, with a pole 0.9 that looks right, and the
#   model explains nothing. nfoursid finds the gain at once (D 0.2). The first rows of sysidentpy's prediction, as many as lags, are the measured ones.
. "$(dirname "$0")/_setup.sh"
packages sysidentpy==0.9.0 nfoursid==1.0.2 pandas==3.1.1 matplotlib==3.11.2
run <<'PY'
import contextlib
import io

import numpy as np
import pandas as pd
from find import seen
from nfoursid.nfoursid import NFourSID
from sysidentpy.basis_function import Polynomial
from sysidentpy.model_structure_selection import FROLS
from sysidentpy.parameter_estimation import LeastSquares

rng = np.random.default_rng(1)


def record(late):
    u, y = np.sign(rng.standard_normal(2000)), np.zeros(2000)
    for k in range(1, 2000):
        y[k] = 0.9 * y[k - 1] + 0.2 * u[k - late]
    return u, y + 0.001 * rng.standard_normal(2000)


def by_sysidentpy(u, y):
    u, y = u.reshape(-1, 1), y.reshape(-1, 1)
    model = FROLS(
        order_selection=True, n_info_values=3, ylag=1, xlag=4, basis_function=Polynomial(degree=1), estimator=LeastSquares()
    )
    with contextlib.redirect_stdout(io.StringIO()):
        model.fit(X=u, y=y)
        run = model.predict(X=u, y=y)
    return len(model.final_model), np.ravel(model.theta), np.std(run - y) / np.std(y), np.array_equal(run[:1], y[:1])


def by_nfoursid(u, y):
    method = NFourSID(pd.DataFrame({"u": u, "y": y}), output_columns=["y"], input_columns=["u"], num_block_rows=10)
    method.subspace_identification()
    found, _ = method.system_identification(rank=1)
    return found.a.item(), found.d.item()


for late, terms in ((1, 2), (0, 1)):
    u, y = record(late)
    count, theta, left, copied = by_sysidentpy(u, y)
    pole, at_once = by_nfoursid(u, y)
    line = f"{late} late: sysidentpy {count} terms {theta.round(3)}, {100 * left:.1f} % left; nfoursid pole {pole:.3f}, D {at_once:.3f}"
    as_stated = count == terms and (left > 0.9) == (late == 0) and abs(pole - 0.9) < 0.01
    seen(line, as_stated and abs(at_once - (0.2 if late == 0 else 0.0)) < 0.01)
seen(f"the first row of the prediction is the measured one: {copied}", copied)
PY
