"""A fresh process with all eight results of row 1, by shaftprint or by its peer."""

import sys

import numpy as np

from benchmarks.thesis_case import FAMILY, case
from shaftprint.identify import identify
from shaftprint.identify.search._starts import LatinHypercube

if __name__ == "__main__":
    if sys.argv[1] == "peer":
        from benchmarks.family import scipy_fit
    for name in FAMILY:
        this = case(name)
        drawn = this.draw(np.random.default_rng(0))
        if sys.argv[1] == "peer":
            print(name, scipy_fit(this, drawn, LatinHypercube(), 0).cost)
        else:
            print(name, identify(this.structure, this.measured(drawn), rng=np.random.default_rng(0)).cost)
