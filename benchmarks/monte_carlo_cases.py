"""The cases of the Monte Carlo test: a structure, its truth, what is known of it, and the noise of its response."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from benchmarks.thesis_case import FREQUENCY_HZ, SNR_M_S_DB, SNR_N_DB
from shaftprint.arrays import ComplexArray, FloatArray, IntArray
from shaftprint.catalogue import structure
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse

# Signal-to-noise ratio of a fuel rack that is logged in steps of a percent [dB].
RACK_DB = 35.0

# What the thesis' campaign gives: windows of 4 periods at S1, of many at S14.
SAMPLES = np.array([6, 6, 10, 12, 14, 14, 13, 12, 12, 12, 12, 12, 12, 12])


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Noise:
    """Lines of a campaign, and how far the noise of each channel is below its signal."""

    frequency_hz: FloatArray
    """Frequency of each line [Hz], shape (lines,)."""
    speed_db: FloatArray
    """Signal-to-noise ratio of ``n`` [dB], shape (lines,); those of ``e`` and ``E_n`` too."""
    torque_db: FloatArray
    """Signal-to-noise ratio of ``M_s`` [dB], shape (lines,)."""
    coherence: ComplexArray
    """Correlation of the noise of ``n`` with that of ``M_s``, both over their signals, shape (lines,)."""
    complex_samples: IntArray
    """Complex samples from which a recording knows the noise of each line, shape (lines,)."""

    def relative(self, first: str, second: str) -> ComplexArray:
        """Return ``E[x y*]`` of the noise of two channels, each over its own signal, shape (lines,)."""
        product = self._level(first) * self._level(second)
        if first == second:
            return product.astype(np.complex128)
        pair = {("n", "M_s"): self.coherence, ("M_s", "n"): np.conj(self.coherence)}
        return np.asarray(product * pair.get((first, second), 0.0), dtype=np.complex128)

    def _level(self, channel: str) -> FloatArray:
        if channel == "n_set":
            return np.zeros(self.frequency_hz.size)
        speed, rack = self.speed_db, np.full(self.frequency_hz.size, RACK_DB)
        torque = self.torque_db
        decibel = {"n": speed, "E_n": speed, "e": torque, "M_s": torque, "X": rack}[channel]
        return np.asarray(10.0 ** (-decibel / 20.0))


# Lines S1 to S13 of the thesis, 0.0044 to 3.43 Hz, with the signal-to-noise ratios of its table 3.7, which says nothing
# of their correlation: a load that brakes the shaft shows as more torque and less speed.
THESIS = Noise(
    frequency_hz=FREQUENCY_HZ[:13],
    speed_db=SNR_N_DB[:13],
    torque_db=SNR_M_S_DB[:13],
    coherence=np.full(13, -0.6),
    complex_samples=SAMPLES[:13],
)
# Lines S1 to S14 of the simulated tug in the thesis' campaign, means of three voyages. Near the peak of the closed loop
# what disturbs the speed disturbs the torque alike.
TUG = Noise(
    frequency_hz=FREQUENCY_HZ[:14],
    speed_db=np.array([61.0, 57.9, 55.9, 58.5, 58.9, 54.6, 54.5, 52.6, 52.2, 51.7, 49.5, 38.3, 30.7, 15.8]),
    torque_db=np.array([31.1, 34.9, 37.7, 40.5, 44.4, 44.4, 46.3, 48.0, 51.1, 51.0, 50.0, 38.1, 30.6, 23.8]),
    coherence=np.concatenate(
        [
            [0.20 - 0.34j, -0.02 - 0.48j, -0.04 - 0.55j, 0.07 - 0.50j, 0.04 - 0.33j, 0.03 - 0.53j, -0.10 - 0.36j],
            [0.34 - 0.10j, 0.81 + 0.06j, 0.90 - 0.04j, 0.97 + 0.01j, 0.995, 0.91 + 0.01j, -0.03 - 0.10j],
        ]
    ),
    complex_samples=SAMPLES,
)

TRUTH = {"tau_n": 0.39, "K_p": 1.8, "K_i": 4.3, "t_d": 0.12, "omega_n": 9.5, "zeta": 0.6}
PID = {"K_p": 3.0, "K_i": 4.3, "K_d": 0.3}
FIVE = {"tau_n": 0.4, "K_p": 4.0, "K_i": 5.0, "g": -0.5}
GAUGE = {
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.0703,
    "omega_n": 10.3,
    "zeta": 0.47,
    "tau_dn": 0.32,
    "tau_up": 1.016,
    "k_q": 2.0,
    "g": -0.1,
    "t_sp": 0.0518,
    "c_set": 1.0,
    "t_gauge": 0.0,
}
# What is known of a line before a test: the TVC to 2 %, a flat engine to a tenth, the telemetry's latency to 2 ms.
KNOWN = {"tau_up": 0.021, "g": 0.1, "t_gauge": 0.002}
WELL_KNOWN = KNOWN | {"g": 0.03}
WELL, LITTLE = "g known to 0.03", "g known to 0.1"


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Case:
    """A structure, its truth and what a test tells of it."""

    name: str
    """Name of the structure, with what is special."""
    structure: Structure
    """The structure."""
    truth: Mapping[str, float]
    """True value of each parameter that is not at the structure's default."""
    noise: Noise
    """Lines and their noise."""
    known: Mapping[str, float] = field(default_factory=dict)
    """Standard deviation with which a parameter is known beforehand."""

    @property
    def values(self) -> FloatArray:
        """True values of all parameters, shape (parameters,)."""
        return self.structure.vector(self.truth)

    @property
    def exact(self) -> ComplexArray:
        """Response without noise, shape (outputs, lines)."""
        return self.structure.response(self.values, 2j * np.pi * self.noise.frequency_hz)

    def numbers(self) -> dict[str, float]:
        """Return the true value of every free parameter and combination by name."""
        named = self.structure.named(self.values)
        found = {p.name: float(named[p.name]) for p in self.structure.free}
        return found | {c.name: float(c.of(named)) for c in self.structure.combinations}

    def complex_covariance(self) -> ComplexArray:
        """Return ``E[z z^H]`` of the noise of the outputs at each line, shape (lines, outputs, outputs).

        A ratio carries the noise of its output less that of its input, each over its own signal.
        """
        cause, outputs, relative = self.structure.input, tuple(self.structure.outputs), self.noise.relative
        shape = (self.noise.frequency_hz.size, len(outputs), len(outputs))
        covariance = np.empty(shape, dtype=np.complex128)
        for i, first in enumerate(outputs):
            for j, second in enumerate(outputs):
                spread = relative(first, second) - relative(first, cause) - relative(cause, second)
                covariance[:, i, j] = self.exact[i] * (spread + relative(cause, cause)) * self.exact[j].conj()
        return covariance

    def measured(
        self, response: ComplexArray, covariance: FloatArray, degrees_of_freedom: FloatArray | None = None
    ) -> FrequencyResponse:
        """Return a drawn response as shaftprint's noun."""
        return FrequencyResponse(
            frequency_hz=self.noise.frequency_hz,
            response=response[:, None, :],
            covariance=covariance,
            inputs=(self.structure.input,),
            outputs=tuple(self.structure.outputs),
            degrees_of_freedom=np.empty(0) if degrees_of_freedom is None else degrees_of_freedom,
        )


def cases() -> dict[str, Case]:
    """Return all cases by name."""
    found = [_case(name, TRUTH, TUG) for name in ("OL1", "OL2", "OL3", "OL4", "OL5")]
    # The filter of the derivative is at 80 rad/s, the last line at 45 rad/s: half of its range fits every draw.
    found.append(_case("OL-PID", PID, TUG, held={"T_f": 0.0125}))
    found += [_case(name, TRUTH, TUG) for name in ("CL1", "CL3", "CL4")]
    # Without the fuel rack only v K_p and v K_i are seen (thesis eq. 2.34).
    found += [_case(name, FIVE, TUG, held={"v": 1.0}) for name in ("INITIAL", "BENCHMARK")]
    found.append(_case("GAUGE-CORE", GAUGE, TUG, known=KNOWN))
    found += [_case(name, GAUGE, TUG, known=WELL_KNOWN, label=WELL) for name in ("GAUGE-CLOSED", "GAUGE-INFLOW")]
    found.append(_case("GAUGE-ECU", GAUGE, TUG, known=KNOWN))
    # Without the set point only the difference of t_d and t_rack is seen.
    found.append(_case("ENGINE", GAUGE, TUG, known=KNOWN, held={"t_rack": 0.0}))
    return {case.name: case for case in found}


def hard_cases() -> dict[str, Case]:
    """Return cases whose data leave so much open that the structure is far from linear over it."""
    found = [_case(name, TRUTH, THESIS, label="noise of the thesis") for name in ("OL4", "OL5", "CL4")]
    found += [_case(name, GAUGE, TUG, known=KNOWN, label=LITTLE) for name in ("GAUGE-CLOSED", "GAUGE-INFLOW")]
    return {case.name: case for case in found}


def _case(
    name: str,
    truth: Mapping[str, float],
    noise: Noise,
    *,
    known: Mapping[str, float] | None = None,
    held: Mapping[str, float] | None = None,
    label: str = "",
) -> Case:
    """Return the case of a structure, with those of the true values and known ones that it has."""
    made_of = structure(name).held_at(**(held or {}))
    free = {p.name for p in made_of.free}
    special = ", ".join([*(f"{parameter} held" for parameter in held or {}), *([label] if label else [])])
    return Case(
        name=f"{name} ({special})" if special else name,
        structure=made_of,
        noise=noise,
        truth={parameter: value for parameter, value in truth.items() if parameter in free},
        known={parameter: std for parameter, std in (known or {}).items() if parameter in free},
    )
