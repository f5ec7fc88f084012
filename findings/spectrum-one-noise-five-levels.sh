#!/usr/bin/env bash
# About: spectrum 0.10.0, white noise of variance 1 through five of its estimators with sampling=100
# Guess: each gives a density, whose area over its frequencies is the variance, 1.
# What happens: the areas are 1 for Burg's, 19 for the periodogram, 93 for multitaper, 257 for Yule-Walker, 25,600 for the correlogram: one package, each method
#   with a scale of its own. Shapes may be compared, levels not.
. "$(dirname "$0")/_setup.sh"
packages spectrum==0.10.0
run <<'PY'
import numpy as np
import spectrum
from find import seen

noise = np.random.default_rng(0).normal(size=4096)
methods = {
    "Burg": (spectrum.pburg(noise, 10, sampling=100.0), 0.9, 1.1),
    "periodogram": (spectrum.Periodogram(noise, sampling=100.0), 10, 30),
    "multitaper": (spectrum.MultiTapering(noise, sampling=100.0, NW=2.5), 50, 150),
    "Yule-Walker": (spectrum.pyule(noise, 10, sampling=100.0), 200, 300),
    "correlogram": (spectrum.pcorrelogram(noise, lag=50, sampling=100.0), 20000, 30000),
}
for name, (estimate, low, high) in methods.items():
    estimate.run()
    density = np.ravel(estimate.psd)
    frequencies = np.array(estimate.frequencies())[: len(density)]
    area = float(np.sum((density[1:] + density[:-1]) / 2 * np.diff(frequencies)))
    seen(f"{name:12} area {area:9.2f}, variance {noise.var():.2f}", low < area < high)
PY
