"""Whether a coupling that twists explains what a rigid line does not: the elastic line, offered beside it."""

import copy
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.choices import CLOSED_LOOPS
from shaftprint.digits import p_value_text, plain, plain_letters, with_deviation
from shaftprint.errors import IdentificationError
from shaftprint.identify.comparison._criteria import criteria_of
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.judgement._misfit import explained
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.normalisation import Normalisation
from shaftprint.reasons import Reason
from shaftprint.survey._elastic_starts import beyond_lines, highest_hz, with_elastic_starts
from shaftprint.survey._measurement import Measurement, pairs_of
from shaftprint.survey._of_vessel import of_vessel
from shaftprint.survey._trial import Trial
from shaftprint.torsion._coupling import line_coupling
from shaftprint.vessel._vessel import Vessel

RIGID = CLOSED_LOOPS["engine"]
ON_SHAFT, ON_ENGINE = "GAUGE-ELASTIC", "GAUGE-ELASTIC-ENGINE"
"""Names of the elastic lines, by the side of the coupling on which the speed is measured."""
# A rigid line is beaten clearly by a BIC that is so much lower (Kass and Raftery, Bayes factors, 1995, section 3.2).
_CLEARLY = 10.0
# Far below its mode a line is rigid: at a third of it speed and torque differ by a tenth.
_SHOWS = 1.0 / 3.0
# A mode is one where it swings.
_SWINGS = 0.5
# Where speed and torque are measured on both sides of a coupling, a line that may not twist by chance is looked into.
_DOUBTED_P = 0.1
_WHERE = {ON_ENGINE: "ahead of", ON_SHAFT: "behind"}


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ElasticOffer:
    """A line with an elastic coupling that explains the data where the rigid one does not, or much better."""

    fit: Identification
    """The fit of the elastic line to the same responses."""
    share: float
    """Share of the misfit of the rigid line beyond the noise that it takes away."""
    reason: Reason
    """What speaks against the numbers of the rigid line, and what to do."""


def elastic_structures(rigid: Structure, vessel: Vessel) -> tuple[Structure, ...]:
    """Return the elastic lines that stand beside a rigid one, with what is held there; none for another structure.

    It is that of the side of the coupling on which the first speed sensor sits, or both, where the vessel file does not
    say.
    """
    if rigid.name != RIGID:
        return ()
    return tuple(_beside(rigid, name, vessel) for name in sides(vessel))


def sides(vessel: Vessel) -> tuple[str, ...]:
    """Return the names of the elastic lines in which the first speed sensor may sit, the likely one first.

    A sensor on the engine's shaft is ahead of the coupling and one on the propeller's behind it. Masses of its shaft
    on both sides of the coupling of the links leave it open, and a line without a gear does, which is one shaft.
    """
    shaft, coupling = vessel.sensors.speed[0].shaft, line_coupling(vessel)
    likely, other = (ON_ENGINE, ON_SHAFT) if shaft == "engine" else (ON_SHAFT, ON_ENGINE)
    one_shaft = vessel.gearbox.ratio == 1.0
    joined = () if coupling is None else coupling.between
    both_ends = len(joined) > 0 and all(row.shaft == shaft for row in vessel.inertia if row.name in joined)
    return (likely, other) if one_shaft or both_ends else (likely,)


def is_elastic(structure: Structure) -> bool:
    """Return whether a structure is one of the shipped elastic lines."""
    return structure.name in _WHERE


def _beside(rigid: Structure, name: str, vessel: Vessel) -> Structure:
    elastic = of_vessel(shipped_structure(name, rigid.names), vessel)
    free = {parameter.name for parameter in elastic.free}
    return elastic.held_at(**{p.name: p.value for p in rigid.parameters if p.held and p.name in free})


def may_twist(rigid: Identification, vessel: Vessel) -> bool:
    """Return whether it is worth asking: the rigid line is rejected, or lines come near a mode of the vessel file.

    A speed ahead of the coupling and a torque behind it differ by the twist itself, which a rigid line hides in part in
    its inertia and its latency: it is asked of such a line where it is doubtful.
    """
    if not rigid.is_likelihood or rigid.objective.others:
        return False
    doubtful = rigid.p_value is not None and rigid.p_value < _DOUBTED_P
    if not explained(rigid) or (doubtful and ON_ENGINE in sides(vessel)):
        return True
    coupling = line_coupling(vessel)
    return coupling is not None and highest_hz(rigid) > _SHOWS * coupling.frequency_hz


def elastic_offer(
    rigid: Identification,
    elastic: Sequence[Structure],
    measurement: Measurement,
    trial: Trial,
    *,
    settings: Callable[[Structure], Settings],
    rng: np.random.Generator,
) -> ElasticOffer | None:
    """Return the elastic line where it explains the data, swings near the lines, and beats the rigid one clearly.

    Of two that do it is that of the lower chi-square, and the other is named where it does nearly as well.

    ``rigid``: the fit of the rigid line. ``elastic``: from ``elastic_structures``. ``measurement``, ``trial``: what was
    measured and tested. ``settings``: gives how an elastic line is fitted. ``rng``: for the starts; its state stays as
    it is.
    """
    tried = (_offered(rigid, one, measurement, settings(one), copy.deepcopy(rng)) for one in elastic)
    fits = sorted((fit for fit in tried if fit is not None), key=lambda fit: fit.chi_square)
    if not fits:
        return None
    fit, *others = fits
    rivals = [one for one in others if one.chi_square - fit.chi_square < _CLEARLY]
    beyond = rigid.chi_square - rigid.degrees_of_freedom
    sentence = _sentence(fit, criteria_of(rigid).bic - criteria_of(fit).bic, measurement, trial.vessel)
    if rivals:
        name = rivals[0].structure.name
        sentence += f", or with {name} if channel {trial.vessel.sensors.speed[0].channel} is {_WHERE[name]} it"
    return ElasticOffer(
        fit=fit,
        share=(rigid.chi_square - fit.chi_square) / beyond if beyond > 0.0 else 1.0,
        reason=Reason(kind="elastic coupling", sentence=plain_letters(f"{sentence}.")),
    )


def _offered(
    rigid: Identification, elastic: Structure, measurement: Measurement, settings: Settings, rng: np.random.Generator
) -> Identification | None:
    try:
        fit = fit_of(pairs_of(elastic, measurement), rng=rng, settings=with_elastic_starts(settings, elastic, rigid))
    except IdentificationError:
        # no stable line with a coupling: there is none to offer
        return None
    frequency_hz, damping_ratio = _mode(fit)
    near = frequency_hz < beyond_lines(elastic) * highest_hz(rigid) and damping_ratio < _SWINGS
    clearly = criteria_of(rigid).bic - criteria_of(fit).bic >= _CLEARLY
    return fit if near and clearly and explained(fit) else None


def begun_at_rigid(elastic: Structure, measurement: Measurement, settings: Settings) -> Settings:
    """Return settings whose starts are those of the rigid line of the same data; as they are for other structures.

    Where there is no stable rigid line, they are as they are, too.
    """
    if not is_elastic(elastic):
        return settings
    rigid = shipped_structure(RIGID, elastic.names)
    held = {p.name: p.value for p in elastic.parameters if p.held and p.name in {one.name for one in rigid.free}}
    rigid = rigid.held_at(**held)
    known = {name: prior for name, prior in settings.priors.items() if name in {p.name for p in rigid.free}}
    try:
        # a stream of its own: no result depends on whether another structure is fitted beside it
        how, starts = replace(settings, priors=known), np.random.default_rng(1)
        fit = fit_of(pairs_of(rigid, measurement), rng=starts, settings=how)
    except IdentificationError:
        return settings
    return with_elastic_starts(settings, elastic, fit)


def _sentence(fit: Identification, gap: float, measurement: Measurement, vessel: Vessel) -> str:
    point = measurement.signals.working_point
    normalisation = Normalisation(
        engine_speed_rev_s=point.engine_speed_rev_s,
        gear_ratio=vessel.gearbox.ratio,
        shaft_torque_nm=point.shaft_torque_nm,
    )
    found = {one.name: one for one in (*fit.parameters, *fit.combinations)}
    stiffness = found[str(fit.structure.named_as(ShipRole.COUPLING_STIFFNESS))]
    kilo = normalisation.inertia_kg_m2 / 1000.0
    mode, name = found["f_1"], fit.structure.name
    side = f", channel {vessel.sensors.speed[0].channel} {_WHERE[name]} the coupling" if name == ON_ENGINE else ""
    twist = with_deviation(kilo * stiffness.value, kilo * stiffness.std)
    swings = with_deviation(mode.value, mode.std)
    return (
        f"The line twists: {name}, with an elastic coupling of {twist} kN m/rad at the propeller shaft and a mode "
        f"at {swings} Hz, explains the data (p = {p_value_text(fit.p_value)}) and has a BIC that is {plain(gap, 0)} "
        f"below that of {RIGID}; identify with --structure {name}{side}"
    )


def _mode(fit: Identification) -> tuple[float, float]:
    """Return frequency [Hz] and damping ratio of the two bodies on their coupling."""
    found = {one.name: one.value for one in (*fit.parameters, *fit.combinations)}
    stiffness, damping = (
        found[str(fit.structure.named_as(role))] for role in (ShipRole.COUPLING_STIFFNESS, ShipRole.COUPLING_DAMPING)
    )
    omega = 2.0 * np.pi * found["f_1"]
    # omega^2 = k (1 / J_1 + 1 / J_2) and 2 zeta omega = d (1 / J_1 + 1 / J_2)
    return found["f_1"], float(0.5 * omega * damping / stiffness)
