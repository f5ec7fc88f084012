"""Synthetic measurements with known truth: the sixteen sines of the thesis with the noise of its table 3.7."""

from dataclasses import dataclass

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.catalogue import structure
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

# Thesis table 3.5, selected frequencies.
FREQUENCY_HZ = np.concatenate(
    [
        [0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11],
        [0.1778, 0.3728, 0.7814, 1.637, 3.433, 7.19, 15.01, 31.644],
    ]
)
# Thesis table 3.7, local signal-to-noise ratios of n_e and M_s.
SNR_N_DB = np.array([40.6, 40.4, 44.9, 45.3, 45.7, 25.6, 38.0, 41.3, 38.5, 35.9, 31.9, 17.0, 7.8, -11.6, -18.3, -22.4])
SNR_M_S_DB = np.array([18.4, 25.3, 20.7, 22.7, 23.5, 24.2, 23.6, 27.2, 34.9, 34.3, 31.9, 17.2, 9.0, 4.6, -23.9, -23.0])
TRUTH = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.0, "zeta": 1.2}
FAMILY = ("OL1", "OL2", "OL3", "OL4", "OL5", "CL1", "CL3", "CL4")


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Case:
    """A structure and data to fit it to."""

    structure: Structure
    """The structure."""
    truth: ComplexArray
    """Response without noise, shape (outputs, lines)."""
    std: FloatArray
    """Standard deviation of the noise of real and of imaginary part, shape (outputs, lines)."""

    def draw(self, rng: np.random.Generator) -> ComplexArray:
        """Return a noisy response, shape (outputs, lines)."""
        real, imaginary = rng.standard_normal((2, *self.std.shape)) * self.std
        return self.truth + real + 1j * imaginary

    def measured(self, response: ComplexArray) -> FrequencyResponse:
        """Return the response as shaftprint's noun, with the covariance from which it was drawn."""
        variance = np.concatenate([self.std, self.std]).T ** 2
        return FrequencyResponse(
            frequency_hz=FREQUENCY_HZ,
            response=response[:, None, :],
            covariance=variance[:, :, None] * np.eye(variance.shape[1]),
            inputs=(self.structure.input,),
            outputs=tuple(self.structure.outputs),
        )


def case(name: str) -> Case:
    """Return the case of one structure: truth from CL4's parameters, noise to first order from table 3.7."""
    closed = structure("CL4")
    n, m_s = closed.response(closed.vector(TRUTH), 2j * np.pi * FREQUENCY_HZ)
    n_std, m_s_std = np.abs(n) * 10.0 ** (-SNR_N_DB / 20.0), np.abs(m_s) * 10.0 ** (-SNR_M_S_DB / 20.0)
    if name.startswith("CL"):
        truth, std = np.stack([n, m_s]), np.stack([n_std, m_s_std])
    elif name == "OL1":
        truth = (n / m_s)[None]
        std = np.abs(truth) * np.hypot(n_std / np.abs(n), m_s_std / np.abs(m_s))
    else:
        truth = (m_s / (1.0 - n))[None]
        std = np.abs(truth) * np.hypot(n_std / np.abs(1.0 - n), m_s_std / np.abs(m_s))
    # A complex variance is shared by the real and the imaginary part.
    return Case(structure=structure(name), truth=truth, std=std / np.sqrt(2.0))
