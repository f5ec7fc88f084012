#!/usr/bin/env bash
# About: era-algorithm 0.1.0 and python-control 0.10.2, a model from the impulse response of a lag (0, 1, 0.9, 0.81, ...)
# Guess: both give back the response that they were given, as there is no noise.
# What happens: python-control does. era_method2 takes the second sample for the direct path and the first for C B, so that its model answers at once, then not, then as it should:
#   1, 0, 1, 0.9, 0.81; its steady gain is 11 for 10. Without the first sample, as some count, the answer has a direct path of 0.9 where there is none.
. "$(dirname "$0")/_setup.sh"
packages era-algorithm==0.1.0 control==0.10.2 scipy==1.17.1
run <<'PY'
import control
import numpy as np
from ERA.core import era_method2
from find import seen

response = np.r_[0.0, 0.9 ** np.arange(40)]
model, _ = control.eigensys_realization(response, 1, m=10, n=10)


def answers(a, b, c, d, count=5):
    out, state = [float(np.squeeze(d))], b
    for _ in range(count - 1):
        out.append(float(np.squeeze(c @ state)))
        state = a @ state
    return np.round(out, 6) + 0.0


seen(f"given                     {np.round(response[:5], 6)}", True)
right = answers(model.A, model.B, model.C, model.D)
seen(f"python-control            {right}", np.allclose(right, response[:5]))
_, *model = era_method2(response[None, :], 10, 10, 1, 1, 2)
theirs = answers(*model)
seen(f"era-algorithm             {theirs}", np.allclose(theirs, [1.0, 0.0, 1.0, 0.9, 0.81], atol=1e-6))
a, b, c, d = model
gain = float(np.squeeze(c @ np.linalg.solve(np.eye(2) - a, b) + d))
seen(f"  its steady gain         {gain:.3f} for {1.0 / (1.0 - 0.9):.3f}", abs(gain - 11.0) < 1e-6)
_, *model = era_method2(response[None, 1:], 10, 10, 1, 1, 1)
theirs = answers(*model)
seen(f"  without the first sample {theirs}", np.allclose(theirs, [0.9, 1.0, 0.9, 0.81, 0.729], atol=1e-6))
PY
