"""Fit a structure to a long record through its Fourier transform: a chirp, or anything else that excites many lines."""

from dataclasses import dataclass, replace

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.errors import IdentificationError
from shaftprint.identify import (
    Cluster,
    Draw,
    Identification,
    MaximumLikelihood,
    Settings,
    identify,
    identify_jointly,
    load_factors,
)
from shaftprint.models import Integrator, Structure, free_responses
from shaftprint.time_domain._nodes import Nodes
from shaftprint.time_domain._record import Record
from shaftprint.time_domain._spectrum import Spectrum, spectrum_of
from shaftprint.time_domain._spectrum_term import SpectrumTerm, weights_of

# Optima of the search in bands that are followed at all lines, where their cost is not far above the lowest.
FOLLOWED, COST_FACTOR, COST_ABOVE = 4, 2.0, 50.0
# Bands and iterations of the search from many starts: enough to tell the optima apart.
SEARCHED, SEARCH_ITERATIONS = 64, 40


@dataclass(frozen=True, slots=True, eq=False)
class Given(Draw):
    """Start values that are known already."""

    theta: FloatArray
    """Start values, shape (count, parameters)."""

    def starts(self, lower: FloatArray, upper: FloatArray, count: int, rng: np.random.Generator) -> FloatArray:
        """Return them, within the bounds."""
        return np.clip(self.theta, lower, upper)


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
    best = coarse.clusters[0].cost
    near = [c for c in coarse.clusters if c.cost <= COST_FACTOR * best + COST_ABOVE][:FOLLOWED]
    theta = np.stack([cluster.values[list(coarse.objective.free)] for cluster in near])
    found = identify_jointly([term], rng=rng, settings=replace(settings, draw=Given(theta), starts=len(theta)))
    return replace(found, settings=settings, clusters=_counted(found, coarse, near))


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
    sensor = {"T_average": record.averaging_s, "T_hold": record.hold_s, "t_pickup": record.pick_up_delay_s}
    held = {p.name: sensor[p.name] for p in structure.parameters if p.held and p.name in sensor}
    used = structure.held_at(**held) if held else structure
    loaded = {name: float(f[0]) for name, f in load_factors(spectrum.response(structure.input)).items()}
    used = used.scaled(**{name: factor for name, factor in loaded.items() if name in used.named(used.vector({}))})
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


def _counted(found: Identification, coarse: Identification, near: list[Cluster]) -> tuple[Cluster, ...]:
    """Return the optima at all lines with the number of starts that reached them in bands."""
    free = list(coarse.objective.free)
    width = coarse.objective.upper - coarse.objective.lower
    counts = [0] * len(found.clusters)
    for cluster in near:
        apart = [np.max(np.abs((c.values - cluster.values)[free]) / width) for c in found.clusters]
        counts[int(np.argmin(apart))] += cluster.starts
    return tuple(replace(cluster, starts=max(count, 1)) for cluster, count in zip(found.clusters, counts, strict=True))
