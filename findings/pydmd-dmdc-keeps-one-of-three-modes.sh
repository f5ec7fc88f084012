#!/usr/bin/env bash
# About: PyDMD 2025.8.1, DMDc() on a noise-free record of three states and one input
# Guess: without noise the three eigenvalues are found to rounding, as least squares finds them.
# What happens: the rank is chosen by a threshold that is made for noise (svd_rank=0), and of 0.9 +- 0.2j and 0.5 one real
#   value of 0.9 is left: an oscillation has become a lag. svd_rank=-1 gives all three.
. "$(dirname "$0")/_setup.sh"
packages pydmd==2025.8.1
run <<'PY'
import numpy as np
from find import seen
from pydmd import DMDc

A = np.array([[0.9, 0.2, 0], [-0.2, 0.9, 0.001], [0, 0, 0.5]])
B = np.array([0.0, 1.0, 1e-3])
u = np.random.default_rng(0).normal(size=(1, 200))
x = np.zeros((3, 201))
for k in range(200):
    x[:, k + 1] = A @ x[:, k] + B * u[0, k]
plain, whole = DMDc(), DMDc(svd_rank=-1)
plain.fit(x, u)
whole.fit(x, u)
print("truth        ", np.linalg.eigvals(A).round(3))
seen(f"DMDc()        {plain.eigs.round(3)}", len(plain.eigs) < 3 and np.abs(plain.eigs.imag).max() < 1e-9)
seen(f"svd_rank=-1   {whole.eigs.round(3)}", np.allclose(np.sort_complex(whole.eigs), np.sort_complex(np.linalg.eigvals(A))))
PY
