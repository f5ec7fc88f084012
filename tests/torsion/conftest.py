"""The shipped line, and lines of a few masses made by hand."""

import numpy as np
import pytest

from shaftprint.torsion import TorsionalLine, torsional_line
from shaftprint.torsion._line import LineLink
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="session")
def tug():
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def line(tug):
    return torsional_line(tug)


@pytest.fixture(scope="session")
def chain():
    """A chain of inertias [kg m2] with stiffnesses [N m/rad] between neighbours."""

    def make(inertia, stiffness, *, psi=0.0, damping=0.0, load=0.0, stiffness_std=0.0, inertia_std=0.0):
        count = len(inertia)
        names = tuple(f"mass {place}" for place in range(count))
        return TorsionalLine(
            bodies=names,
            inertia_kg_m2=np.array(inertia, dtype=float),
            links=tuple(
                LineLink(
                    between=(place, place + 1),
                    stiffness_nm_rad=value,
                    stiffness_std_nm_rad=stiffness_std * value,
                    relative_damping=psi,
                    damping_nm_s_rad=damping,
                )
                for place, value in enumerate(stiffness)
            ),
            gauge=count - 2,
            load_nm_s_rad=np.append(np.zeros(count - 1), load),
            inertia_std_kg_m2=inertia_std * np.array(inertia, dtype=float),
            body_of={name: place for place, name in enumerate(names)},
        )

    return make
