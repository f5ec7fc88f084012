"""Monte Carlo at the level of responses: noise is drawn, the structure fitted and profiled, the truth looked for."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from functools import cache

import numpy as np

from benchmarks.monte_carlo_cases import Case, cases, hard_cases
from benchmarks.monte_carlo_outcome import Outcome, row_of
from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.distributions import NORMAL_95
from shaftprint.identify import Draw, Identification, Prior, Settings, identify, profile
from shaftprint.identify.likelihood._weighting import Weighting
from shaftprint.models import Structure
from shaftprint.spectra import FrequencyResponse
from shaftprint.spectra._response_covariance import real_covariance, weight_factor

SEED = 20
# A rise of the cost this near to that at the end of an interval is on neither side: ends are good to half a percent.
UNDECIDED = 0.03

Formula = Callable[..., FloatArray]
# How each combination is held at a value: the parameter that follows from the others, and its formula.
HELD: Mapping[str, tuple[str, Callable[[float], Formula]]] = {
    "t_d + t_sp": ("t_sp", lambda c: lambda t_d: c - t_d),
    "K_p / K_i": ("K_i", lambda c: lambda K_p: K_p / c),
    "v K_p": ("K_p", lambda c: lambda v: c / v),
    "v K_i": ("K_i", lambda c: lambda v: c / v),
    "v K_i / (k_q - g)": ("K_i", lambda c: lambda v, k_q, g: c * (k_q - g) / v),
    "v K_p / (tau_up + tau_dn)": ("K_p", lambda c: lambda v, tau_up, tau_dn: c * (tau_up + tau_dn) / v),
    "v / (tau_up + tau_dn)": ("v", lambda c: lambda tau_up, tau_dn: c * (tau_up + tau_dn)),
}


@dataclass(frozen=True, slots=True)
class AtPoint(Draw):
    """One start at a given point, moved inside the bounds."""

    point: tuple[float, ...]
    """The free parameters."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return the point."""
        return np.clip(np.array([self.point]), lower, upper)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Drawn:
    """One simulated test."""

    response: FrequencyResponse
    """The noisy response with its covariance."""
    priors: Mapping[str, Prior]
    """What is known beforehand: its mean is drawn about the truth, as that of a measurement would be."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Linear:
    """The problem linearised at the truth, with the true covariance."""

    case: Case
    """The problem."""
    gain: FloatArray
    """Change of every number for a change of [Re, Im] of each line, shape (numbers, lines, 2 outputs)."""
    gain_of_known: FloatArray
    """The same for what is known beforehand, shape (numbers, known)."""
    std: FloatArray
    """Cramer-Rao bound of every number, as a standard deviation, shape (numbers,)."""

    @property
    def bounds(self) -> dict[str, float]:
        """Cramer-Rao bound of every number by name, as a standard deviation."""
        return dict(zip(self.case.numbers(), self.std.tolist(), strict=True))

    def errors(self, drawn: Drawn) -> dict[str, float]:
        """Return the error of the best linear estimate of every number."""
        noise = (drawn.response.response[:, 0] - self.case.exact).T
        parts = np.concatenate([noise.real, noise.imag], axis=1)
        known = np.array([drawn.priors[name].mean - self.case.truth[name] for name in self.case.known])
        errors = np.einsum("nlp,lp->n", self.gain, parts) + self.gain_of_known @ known
        return dict(zip(self.case.numbers(), errors.tolist(), strict=True))


def simulate(number: int, *, name: str, estimated: bool, weighting: Weighting, asked: int) -> Outcome:
    """Draw, fit and profile one test of a structure.

    Parameters
    ----------
    number
        Number of the test; with the name of the case it is the seed.
    name
        Name of the case.
    estimated
        Whether the fit knows the covariance only from as many samples as a recording gives.
    weighting
        How the fit weighs.
    asked
        Tests up to this number are fitted again with each number held at its truth.
    """
    case = named_cases()[name]
    drawn = draw(case, number, estimated=estimated)
    fit = fitted(case.structure, case, drawn, weighting)
    intervals, linear = profile(fit).intervals, linearised(name).errors(drawn)
    estimates = {estimate.name: estimate for estimate in (*fit.parameters, *fit.combinations)}
    rows = {n: row_of(estimates[n], intervals[n], truth, linear[n]) for n, truth in case.numbers().items()}
    agrees = None
    if number < asked:
        rises = {n: held_cost(case, n, drawn, weighting) - fit.cost for n in rows}
        limit = 0.5 * NORMAL_95**2
        agrees = all(
            abs(rise / limit - 1.0) < UNDECIDED or (rise < limit) == rows[n].inside for n, rise in rises.items()
        )
    return Outcome(rows=rows, p_value=float(fit.fit_test.p_value or np.nan), agrees=agrees)


def draw(case: Case, number: int, *, estimated: bool) -> Drawn:
    """Return the simulated test of a number."""
    rng = np.random.default_rng([SEED, *case.name.encode(), number])
    true = case.complex_covariance()
    root = np.linalg.cholesky(true)
    response = case.exact + _circular(root, 1, rng)[:, 0].T
    priors = {name: Prior(rng.normal(case.truth[name], std), std) for name, std in case.known.items()}
    if not estimated:
        return Drawn(response=case.measured(response, real_covariance(true)), priors=priors)
    samples, outputs = case.noise.complex_samples, response.shape[0]
    covariance = np.empty_like(true)
    for line, count in enumerate(samples):
        beside = _circular(root[line : line + 1], int(count), rng)[0]
        covariance[line] = beside.T @ beside.conj() / count * weight_factor(float(count), outputs)
    return Drawn(response=case.measured(response, real_covariance(covariance), 2.0 * samples), priors=priors)


def _circular(root: ComplexArray, count: int, rng: np.random.Generator) -> ComplexArray:
    """Return circular complex noise of covariance ``root root^H``, shape (lines, count, outputs)."""
    lines, outputs, _ = root.shape
    real, imaginary = rng.standard_normal((2, lines, count, outputs)) / np.sqrt(2.0)
    return np.asarray((real + 1j * imaginary) @ root.swapaxes(1, 2))


def fitted(structure: Structure, case: Case, drawn: Drawn, weighting: Weighting) -> Identification:
    """Fit a structure to a simulated test, from the truth."""
    free = {p.name for p in structure.free}
    truth = case.structure.named(case.values)
    settings = Settings(
        priors={name: prior for name, prior in drawn.priors.items() if name in free},
        weighting=weighting,
        starts=1,
        draw=AtPoint(tuple(float(truth[p.name]) for p in structure.free)),
        stability="ignored",
    )
    return identify(structure, drawn.response, rng=np.random.default_rng(0), settings=settings)


def held_cost(case: Case, name: str, drawn: Drawn, weighting: Weighting) -> float:
    """Return the lowest cost of a simulated test with one number held at its truth."""
    truth, structure = case.numbers()[name], case.structure
    if name in HELD:
        follows, formula = HELD[name]
        if name == "t_d + t_sp":
            structure = structure.free_between(t_d=(0.0, truth))
        return fitted(structure.tied(follows, formula(truth)), case, drawn, weighting).cost
    held = structure.held_at(**{name: truth})
    if not held.free:
        r, _ = fitted(structure, case, drawn, weighting).objective.residuals(np.array([[truth]]))
        return 0.5 * float(r[0] @ r[0])
    cost = fitted(held, case, drawn, weighting).cost
    if name in drawn.priors:
        # What is known of a held number is no row of the fit; it costs the same whatever the others are.
        cost += 0.5 * ((truth - drawn.priors[name].mean) / drawn.priors[name].std) ** 2
    return cost


@cache
def linearised(name: str) -> Linear:
    """Return the linearised problem of a case: its covariance is the Cramer-Rao bound."""
    case = named_cases()[name]
    structure = case.structure
    _, slopes = structure.gradient(case.values, 2j * np.pi * case.noise.frequency_hz)
    parts = np.concatenate([slopes.real, slopes.imag], axis=1).transpose(2, 1, 0)
    weighted = np.linalg.solve(real_covariance(case.complex_covariance()), parts)
    information = np.einsum("lpa,lpb->ab", parts, weighted)
    free = [p.name for p in structure.free]
    places = [free.index(parameter) for parameter in case.known]
    precision = np.array([std**-2.0 for std in case.known.values()])
    information[places, places] += precision
    numbers = _slopes_of_numbers(case) @ np.linalg.inv(information)
    return Linear(
        case=case,
        gain=np.einsum("na,lpa->nlp", numbers, weighted),
        gain_of_known=numbers[:, places] * precision,
        std=np.sqrt(np.einsum("na,ab,nb->n", numbers, information, numbers)),
    )


def _slopes_of_numbers(case: Case) -> FloatArray:
    """Return the derivatives of every number to the free parameters at the truth, shape (numbers, free)."""
    structure, values = case.structure, case.values
    places = [structure.names.index(p.name) for p in structure.free]
    step = 1e-6 * np.eye(values.size)[places]
    ahead, behind = structure.named(values + step), structure.named(values - step)
    of_combinations = [(c.of(ahead) - c.of(behind)) / 2e-6 for c in structure.combinations]
    return np.vstack([np.eye(len(places)), *of_combinations])


@cache
def named_cases() -> dict[str, Case]:
    """Return all cases by name, made once a process."""
    return cases() | hard_cases()
