#!/usr/bin/env bash
# About: openTorsion 0.3.2, Shaft(0, 1, k=..., I=1.0), I documented as the moment of inertia of the shaft in kg m2
# Guess: a shaft of 1 kg m2 between two discs of 10 makes 21 kg m2.
# What happens: 26: I is put as it is into the element's mass matrix [[2, 1], [1, 2]], whose entries add to 6. Of a shaft by length and diameter the sixth is taken, and
#   the sum is right. With k and I from a maker's list, give I / 6.
. "$(dirname "$0")/_setup.sh"
packages opentorsion==0.3.2
run <<'PY'
import numpy as np
import opentorsion
from find import seen

line = opentorsion.Assembly(
    [opentorsion.Shaft(0, 1, k=1e5, I=1.0)], disk_elements=[opentorsion.Disk(0, 10.0), opentorsion.Disk(1, 10.0)]
)
seen(f"two discs of 10, a shaft of 1 kg m2: {line.M.sum():.1f} kg m2", np.isclose(line.M.sum(), 26))
bare = opentorsion.Assembly([opentorsion.Shaft(0, 1, L=1000, odl=100)], disk_elements=[opentorsion.Disk(0, 0.0)])
inertia = 8000 * np.pi * 0.1**4 / 32
seen(f"1 m of 100 mm steel: {bare.M.sum():.4f} kg m2 (by hand {inertia:.4f})", np.isclose(bare.M.sum(), inertia))
PY
