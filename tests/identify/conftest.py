"""Responses of known truth with known noise."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.spectra import FrequencyResponse

# The lines of the thesis up to S13 (table 3.5): what is below the Nyquist frequency of a pulse a revolution.
FREQUENCY_HZ = np.array(
    [0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11, 0.1778, 0.3728, 0.7814, 1.637, 3.433]
)
NAMES = tuple(f"S{i}" for i in range(1, 14))

TRUTHS = {
    "OL1": {"tau_n": 0.3897},
    "OL2": {"K_p": 1.003, "K_i": 4.2725},
    "OL3": {"K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022},
    "OL5": {"K_p": 4.36, "K_i": 4.2664, "t_d": 0.1023, "omega_n": 8.202, "zeta": 0.88},
    "CL1": {"tau_n": 0.3897, "K_p": 1.003, "K_i": 4.2725},
    "CL4": {"tau_n": 0.329, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.5},
}


@pytest.fixture
def truths():
    return TRUTHS


@pytest.fixture
def make_response():
    """Return a maker of responses: truth of a structure, relative noise of each part, correlation of the parts."""

    def make(
        wanted, truth=None, *, noise=0.01, correlation=0.0, rng=None, frequency_hz=FREQUENCY_HZ, names=NAMES, **fields
    ):
        shipped = structure(wanted) if isinstance(wanted, str) else wanted
        values = TRUTHS[shipped.name] if truth is None else truth
        exact = shipped.response(shipped.vector(values), 2j * np.pi * frequency_hz)
        size = 2 * len(shipped.outputs)
        std = np.tile(np.abs(exact) * noise, (2, 1))
        shape = np.full((size, size), correlation) + (1.0 - correlation) * np.eye(size)
        covariance = std.T[:, :, None] * shape * std.T[:, None, :]
        drawn = exact
        if rng is not None:
            parts = np.einsum("fab,fb->af", np.linalg.cholesky(covariance), rng.normal(size=(frequency_hz.size, size)))
            drawn = exact + parts[: size // 2] + 1j * parts[size // 2 :]
        return FrequencyResponse(
            frequency_hz=frequency_hz,
            response=drawn[:, None],
            covariance=covariance,
            inputs=(shipped.input,),
            outputs=tuple(shipped.outputs),
            lines=names,
            **fields,
        )

    return make
