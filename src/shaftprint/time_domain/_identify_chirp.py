"""Fit a structure to a long record through its Fourier transform: a chirp, or anything else that excites many lines."""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.fit._identification import Cluster, Identification
from shaftprint.identify.fit._identify import identify, identify_jointly
from shaftprint.identify.fit._sensor import with_sensor
from shaftprint.identify.likelihood._load_factors import with_load
from shaftprint.identify.likelihood._weighting import MaximumLikelihood
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._blocks import Integrator
from shaftprint.models._free_response import free_responses
from shaftprint.models._structure import Structure
from shaftprint.time_domain._nodes import Nodes
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._spectrum import Spectrum, spectrum_of
from shaftprint.time_domain._spectrum_term import SpectrumTerm, weights_of

# Optima of the search in bands that are followed at all lines: not far above the lowest, for the same data say nearly
# the same in bands and line by line.
FOLLOWED, COST_FACTOR, COST_ABOVE = 4, 1.1, 25.0
# Bands and iterations of the search from many starts: enough to tell the optima apart.
SEARCHED, SEARCH_ITERATIONS = 40, 30
# Steps from there at all lines, before the search's own; damping that only keeps them finite.
STEPS, TINY_DAMPING = 4, 1e-9
# Share of the cost that a step must promise.
WORTH_A_STEP = 1e-13


def identify_chirp(
    structure: Structure,
    record: Record,
    *,
    rng: np.random.Generator,
    settings: Settings | None = None,
    band_hz: tuple[float, float] | None = None,
    transients: bool = True,
    drift: bool = False,
) -> Identification:
    """Fit a linear structure to a long record from many starts, with exact delays, through one Fourier transform.

    The search from many starts looks at the response in bands of lines, the fit at all excited lines. The noise of the
    outputs is what smooth responses leave in bands of lines: of any colour, correlated between outputs, and without
    what the structure cannot follow, so that the test of fit stays one.

    Parameters
    ----------
    structure
        Structure with one input of the record and outputs of it. Held parameters of a speed sensor take the record's
        values, and the slopes of the propeller torque its load.
    record
        Uniform samples, without longer gaps. It may begin and end in motion.
    rng
        Source of the start values.
    settings
        How to search; the weights are those of maximum likelihood.
    band_hz
        Lowest and highest frequency to use [Hz]; where the input is strong for its frequency if not given.
    transients
        Whether to allow for different states at begin and end; a record from rest to rest needs none.
    drift
        Whether to allow for a straight line in every output.

    Raises
    ------
    SignalError
        If the record lacks a channel, has long gaps, or excites too few lines.
    IdentificationError
        If the structure has several inputs, the weighting is another, or no start reached a stable model.
    """
    settings = settings or Settings()
    if len(structure.inputs) > 1 or not isinstance(settings.weighting, MaximumLikelihood):
        raise IdentificationError(
            f"chirp: expected a structure with one input and the weighting MaximumLikelihood(), found "
            f"{structure.name} with {', '.join(structure.inputs)} and {type(settings.weighting).__name__}()."
        )
    spectrum = spectrum_of(record, structure.input, tuple(structure.outputs), band_hz=band_hz)
    coarse = identify(
        structure,
        spectrum.response(structure.input, most=SEARCHED),
        rng=rng,
        settings=replace(settings, max_iterations=min(settings.max_iterations, SEARCH_ITERATIONS)),
    )
    term = spectrum_term(structure, spectrum, transients=transients, drift=drift)
    near = _followed(coarse)
    theta = np.stack([_sharpened(coarse, term, cluster) for cluster in near])
    fit = identify_jointly([term], rng=rng, settings=replace(settings, draw=GivenStarts(theta), starts=len(theta)))
    return replace(fit, settings=settings, clusters=_counted(fit, coarse, near))


def spectrum_term(
    structure: Structure, spectrum: Spectrum, *, transients: bool = True, drift: bool = False
) -> SpectrumTerm:
    """Return the excited lines of a record as a part of a likelihood, to be fitted alone or with other data.

    Parameters
    ----------
    structure
        See ``identify_chirp``.
    transients, drift
        See ``identify_chirp``.
    """
    record = spectrum.record
    used = with_load(with_sensor(structure, record), record.load)
    shapes, channels = free_responses(used) if transients else (None, ())
    if drift:
        lines = {f"{output} drift": Integrator() for output in used.outputs}
        outputs = {**shapes.outputs, **lines} if shapes is not None else lines
        shapes, channels = replace(used, outputs=outputs, combinations=()), (*channels, *range(len(lines)))
    free = tuple(i for i, p in enumerate(used.parameters) if not p.held)
    return SpectrumTerm(
        structure=used,
        spectrum=spectrum,
        shapes=shapes,
        channels=channels,
        s=np.asarray(2j * np.pi * spectrum.frequency_hz),
        nodes=Nodes.of(spectrum.frequency_hz),
        weights=weights_of(spectrum.noise),
        held=used.vector({}),
        free=free,
        places=free,
        columns=tuple(range(len(free))),
    )


def _followed(coarse: Identification) -> list[Cluster]:
    """Return the optima to follow: the lowest, the one that won, and others that more than one start reached."""
    limit = COST_FACTOR * coarse.clusters[0].cost + COST_ABOVE
    lowest, *others = coarse.clusters
    won = [c for c in others if np.array_equal(c.values, coarse.values)]
    rivals = [c for c in others if c not in won and c.starts > 1 and c.cost <= limit]
    return [lowest, *won, *rivals][:FOLLOWED]


def _sharpened(coarse: Identification, term: SpectrumTerm, cluster: Cluster) -> FloatArray:
    """Return free parameters nearer to the optimum at all lines, from an optimum in bands, shape (free,).

    Steps of Gauss and Newton without damping, as long as they lower the cost: so near, the cautious first steps of a
    search would only take time.
    """
    before = coarse.objective
    names = [p.name for p in before.free_parameters]
    objective = replace(before, terms=(term.placed(before.names, names),))
    theta = cluster.values[list(before.free)]
    residuals, slopes = (part[0] for part in objective.residuals(theta[None]))
    for _ in range(STEPS):
        information = slopes @ slopes.T
        information[np.diag_indices_from(information)] *= 1.0 + TINY_DAMPING
        slope = slopes @ residuals
        step = np.linalg.lstsq(information, slope)[0]
        if step @ slope <= WORTH_A_STEP * (residuals @ residuals):
            break
        trial = np.clip(theta - step, objective.lower, objective.upper)
        there, slopes_there = (part[0] for part in objective.residuals(trial[None]))
        if there @ there >= residuals @ residuals:
            break
        theta, residuals, slopes = trial, there, slopes_there
    return theta


def _counted(fit: Identification, coarse: Identification, near: list[Cluster]) -> tuple[Cluster, ...]:
    """Return the optima at all lines with the number of starts that reached them in bands."""
    free = list(coarse.objective.free)
    width = coarse.objective.upper - coarse.objective.lower
    counts = [0] * len(fit.clusters)
    for cluster in near:
        apart = [np.max(np.abs((c.values - cluster.values)[free]) / width) for c in fit.clusters]
        counts[int(np.argmin(apart))] += cluster.starts
    return tuple(replace(cluster, starts=max(count, 1)) for cluster, count in zip(fit.clusters, counts, strict=True))
