"""What a fit that fails may be missing: the causes that would explain most of its misfit.

For each cause the fall of the squared misfit is computed that one more parameter of its direction would bring, beside
the free ones (score test: Rao, Large sample tests of statistical hypotheses concerning several parameters, 1948). The
best is taken along, then the next best is looked for. These are hints: causes that look alike in the lines at hand
cannot be told apart, and sizes are right to first order.
"""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._causes import Cause, causes_of
from shaftprint.identify.judgement._misfit import REJECTED, explained
from shaftprint.identify.judgement._phrases import number
from shaftprint.identify.likelihood._experiment import Experiment

MOST = 3
# A cause is worth naming where it takes away this share of the misfit beyond the noise, and chi-square with one degree
# of freedom exceeds the last number by chance once in a hundred thousand times.
LEAST_SHARE, LEAST_FALL = 0.2, 19.5
# Of causes that explain nearly as much as the best, the best founded is named.
NEARLY = 0.97
# A direction of which less than this share is left beside the free parameters is one of theirs.
OWN = 1e-4
# A cause that changes the response by more than itself is not of first order.
FIRST_ORDER = 1.0
# A misfit of so many times the noise in which no cause shows is none of a linear structure.
GROSS = 2.0
NOT_LINEAR = (
    "A hint: no delay, lag or scale of a channel would take much of the misfit away; look for what large motions do "
    "other than small ones, such as a limit of torque or rack or of their rate, play or dry friction (`shaftprint "
    "limits` looks for limits)."
)


@dataclass(frozen=True, kw_only=True, slots=True)
class Suspect:
    """A cause that would explain much of a misfit."""

    words: str
    """What may be wrong, as a clause."""
    estimate: float
    """Its size, to first order."""
    std: float
    """Standard deviation of the size."""
    unit: str
    """Unit of the size."""
    share: float
    """Share of the misfit beyond the noise that it takes away, given those named before it."""
    rough: bool
    """Whether the size is so large that a first-order estimate of it says little."""

    @property
    def sentence(self) -> str:
        """The suspicion in words, with its size where that can be told."""
        share = 100.0 * min(self.share, 1.0)
        size = "" if self.rough else f" (by about {number(self.estimate, self.unit, digits=2)})"
        return f"A hint: {share:.0f} % of the misfit would disappear if {self.words}{size}."


def suspects_of(identification: Identification, *, rejected: float = REJECTED) -> tuple[Suspect, ...]:
    """Return what would explain most of a fit's misfit, the most first; nothing for a fit that explains its data.

    What a cause does to records in time is not known: for a fit to any there are no hints.

    ``rejected``: probability below which the fit is rejected.
    """
    if explained(identification, rejected=rejected) or identification.objective.others:
        return ()
    misfit, basis = misfit_of(identification)
    spare = misfit.size - basis.shape[1]
    causes = gathered_causes(identification)
    beyond = float(misfit @ misfit) - spare
    suspects: list[Suspect] = []
    while len(suspects) < MOST and causes:
        directions = np.array([direction for _, direction in causes])
        sizes = np.linalg.norm(directions, axis=1)
        across = directions - (directions @ basis) @ basis.T
        lengths = np.linalg.norm(across, axis=1)
        lengths[lengths < OWN * sizes] = np.inf
        pulls = across @ misfit / lengths
        backward = np.array([cause.one_sided for cause, _ in causes]) & (pulls < 0.0)
        falls = np.where(backward, 0.0, pulls**2)
        if falls.max() < max(LEAST_SHARE * beyond, LEAST_FALL):
            break
        best = int(np.flatnonzero(falls >= NEARLY * falls.max())[0])
        cause, _ = causes.pop(best)
        estimate = float(pulls[best] / lengths[best])
        suspects.append(
            Suspect(
                words=cause.words,
                estimate=estimate,
                std=float(1.0 / lengths[best]),
                unit=cause.unit,
                share=float(falls[best] / beyond),
                rough=abs(estimate) * cause.share > FIRST_ORDER,
            )
        )
        along = across[best] / lengths[best]
        misfit = misfit - (along @ misfit) * along
        basis = np.column_stack([basis, along])
    return tuple(suspects)


def is_gross(identification: Identification) -> bool:
    """Return whether lines alone were fitted, and lie so far from the structure that it is no linear cause."""
    if not identification.is_likelihood or identification.objective.others:
        return False
    return identification.chi_square > GROSS * identification.degrees_of_freedom


def misfit_of(identification: Identification) -> tuple[FloatArray, FloatArray]:
    """Return what is left of the residuals beside the free parameters, and an orthonormal basis of theirs."""
    residuals, table = _linear(identification)
    scale = np.linalg.norm(table, axis=0)
    vectors, sizes, _ = np.linalg.svd(table / np.where(scale > 0.0, scale, 1.0), full_matrices=False)
    basis = vectors[:, sizes > OWN * sizes[0]]
    return residuals - basis @ (basis.T @ residuals), basis


def moved_by(identification: Identification, words: str) -> FloatArray | None:
    """Return what a cause of size 1 adds to the free parameters, to first order, shape (free,); None where none is.

    ``words``: what may be wrong, as the cause has it.
    """
    _, table = _linear(identification)
    directions = (direction for cause, direction in gathered_causes(identification) if cause.words == words)
    direction = next(directions, None)
    return None if direction is None else np.asarray(np.linalg.lstsq(table, direction)[0], dtype=np.float64)


def _linear(identification: Identification) -> tuple[FloatArray, FloatArray]:
    """Return residuals of data and priors, and what each free parameter adds to what was fitted to them."""
    objective = identification.objective
    parts, slopes = [], []
    for experiment, part in zip(objective.experiments, identification.experiments, strict=True):
        _, gradient = experiment.structure.gradient(
            experiment.structure_values(identification.values), experiment.s, factors=experiment.factors
        )
        part_slopes = np.zeros((part.whitened.size, len(objective.free)))
        part_slopes[:, list(experiment.columns)] = np.array([whitened(experiment, slope) for slope in gradient]).T
        parts.append(part.whitened.ravel())
        slopes.append(part_slopes)
    theta = identification.values[list(objective.free)]
    for column, mean, weight in objective.prior_rows:
        parts.append(np.array([(mean - theta[int(column)]) * weight]))
        slopes.append(weight * np.eye(theta.size)[[int(column)]])
    return np.concatenate(parts), np.concatenate(slopes)


def gathered_causes(identification: Identification) -> list[tuple[Cause, FloatArray]]:
    """Return the causes of all experiments, those of one wording as one, each with its whitened direction."""
    objective = identification.objective
    sizes = [part.whitened.size for part in identification.experiments]
    total = sum(sizes) + objective.prior_rows.shape[0]
    causes: dict[str, tuple[Cause, FloatArray]] = {}
    first = 0
    for experiment, size in zip(objective.experiments, sizes, strict=True):
        model = np.abs(experiment.model(identification.values))
        for one in causes_of(experiment, identification.values):
            cause = replace(one, share=float(np.max(np.abs(one.effect) / model)))
            _, direction = causes.setdefault(cause.words, (cause, np.zeros(total)))
            direction[first : first + size] = whitened(experiment, cause.effect)
        first += size
    return [(cause, direction) for cause, direction in causes.values() if direction.any()]


def whitened(experiment: Experiment, channels: ComplexArray) -> FloatArray:
    """Return ``L^-1 [Re, Im]`` of the fitted lines, one line after the other."""
    parts = np.concatenate([channels.real, channels.imag]).T
    root = np.linalg.cholesky(experiment.covariance)
    return np.asarray(np.linalg.solve(root, parts[:, :, None]).ravel())
