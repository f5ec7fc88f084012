"""Structures fitted to the responses of a measurement, and compared where they explain the same data."""

import copy
import math
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import replace

import numpy as np

from shaftprint.catalogue._roles import ShipRole
from shaftprint.errors import IdentificationError
from shaftprint.fingerprint._speed_age import AGE_OF_SPEED
from shaftprint.identify.comparison._compare import compare_fits
from shaftprint.identify.comparison._comparison import StructureComparison
from shaftprint.identify.fit._fit_of import fit_of
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._late_set_point import bounds_of_late
from shaftprint.identify.judgement._affected_numbers import by_weight
from shaftprint.identify.judgement._misfit import explained
from shaftprint.identify.judgement._prior_contradictions import NOMINAL
from shaftprint.identify.likelihood._known import SHARE_ROUNDING, priors_from_vessel
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.signals._working_points import WorkingPoint
from shaftprint.survey._measurement import Measurement, pairs_of
from shaftprint.survey._progress import SILENT, Progress
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._vessel import Vessel

# Deviance by which a latency below nothing is no chance: three standard deviations.
_CLEARLY = 9.0


def priors_of(
    structure: Structure, vessel: Vessel, signals: Signals, stated: Mapping[str, Prior] | None = None
) -> dict[str, Prior]:
    """Return the priors of a structure: those of the vessel file, and what the user states instead or besides."""
    known = priors_from_vessel(structure, vessel, signals.working_point, mode=signals.mode)
    measured = (
        _from_messages(known, structure, vessel, signals)
        | _from_demand(structure, vessel, signals)
        | _from_machine(structure, signals)
        | _from_levels(structure, signals)
    )
    return known | measured | dict(stated or {})


def _from_messages(
    known: Mapping[str, Prior], structure: Structure, vessel: Vessel, signals: Signals
) -> dict[str, Prior]:
    """Return the latency of the torque behind the speed where messages carry either: they do not tell its age.

    A value may be that of the instant at which it is sent, up to a period old, or a mean since the message before: even
    over a period, its latency has a standard deviation of a twelfth of its square.
    """
    gauge, speed = vessel.sensors.shaft_torque, vessel.sensors.speed[0]
    torque_s = 1.0 / signals.channels["M_s"].value_rate_hz
    is_spline = not speed.counts_turns and signals.engine_speed.pulse_rate_hz < signals.rate_hz
    speed_s = 1.0 / signals.engine_speed.pulse_rate_hz if is_spline else 0.0
    ages = {
        "age of torque messages": torque_s / math.sqrt(12.0) if gauge.latency_std_s is None else 0.0,
        AGE_OF_SPEED: speed_s / math.sqrt(12.0) if speed.latency_std_s is None else speed.latency_std_s,
    }
    sources = {name: std for name, std in ages.items() if std}
    if not sources:
        return {}
    of_torque = (one.name for one in structure.free if one.role == ShipRole.TORQUE_LATENCY and one.name in known)
    return {
        name: replace(
            known[name],
            std=math.hypot(known[name].std, *sources.values()),
            sources={**known[name].sources, **sources},
        )
        for name in of_torque
    }


def _from_demand(structure: Structure, vessel: Vessel, signals: Signals) -> dict[str, Prior]:
    """Return what the demand that was logged beside the set point says of its latency."""
    found, sensor = signals.set_point_delay, vessel.sensors.demand
    if found is None or sensor is None:
        return {}
    parts = {"demand noise": found.std_s, "demand latency": sensor.latency_std_s or 0.0}
    sources = {name: part for name, part in parts.items() if part}
    prior = Prior(mean=found.delay_s, std=math.hypot(*parts.values()), sources=sources)
    return {one.name: prior for one in structure.free if one.role == ShipRole.SET_POINT_LATENCY}


def _from_machine(structure: Structure, signals: Signals) -> dict[str, Prior]:
    """Return the share of the torque that an electric machine on the gearbox showed, in place of the vessel file's."""
    shown = [moved.share for moved in signals.excitations.values() if moved.share is not None]
    if not shown:
        return {}
    prior = Prior(mean=shown[0], std=SHARE_ROUNDING, sources={"machine share": SHARE_ROUNDING})
    return {one.name: prior for one in structure.free if one.role == ShipRole.MACHINE_SHARE}


def _from_levels(structure: Structure, signals: Signals) -> dict[str, Prior]:
    """Return what the steady levels tell of the set point's line: its bend, and its scale where that is told roughly.

    In the bend that of the vessel file is counted. Where the slope rests on two levels or more it is known well enough
    that its scale is to be found by the fit alone; a leg at one level tells it by its slow lines.
    """
    line, scale_std = signals.calibration, signals.dc_scale_std
    told = {}
    if np.isfinite(line.bend_std):
        bend = Prior(mean=line.bend, std=line.bend_std, sources={"set-point bend": line.bend_std})
        told[ShipRole.SET_POINT_BEND] = bend
    # a lever bends by as much
    if scale_std > NOMINAL[ShipRole.SET_POINT_SCALE][1]:
        told[ShipRole.SET_POINT_SCALE] = Prior(mean=1.0, std=scale_std, sources={"set-point line": scale_std})
    return {one.name: told[one.role] for one in structure.free if one.role in told}


def stated_working_point(vessel: Vessel) -> WorkingPoint:
    """Return the working point of a vessel file, for what is known before any recording."""
    return WorkingPoint(
        engine_speed_rev_s=rev_s_from_rpm(vessel.working_point.engine_speed_rpm),
        shaft_torque_nm=vessel.working_point.driving_torque_nm,
        engine_speed_std_rev_s=0.0,
        shaft_torque_std_nm=0.0,
        set_point_v=0.0,
        load_std=0.0,
    )


def fit(
    structures: Sequence[Structure],
    measurement: Measurement,
    *,
    settings: Mapping[str, Settings],
    rng: np.random.Generator,
    progress: Progress = SILENT,
) -> tuple[Identification, ...]:
    """Fit every structure to the response that it describes.

    Parameters
    ----------
    structures
        What to fit.
    measurement
        What to fit it to.
    settings
        How to search, by name of the structure.
    rng
        Draws the start values; each structure begins with its state, so that no result depends on the others.

    Raises
    ------
    StructureError
        If the recording does not give the response that a structure describes.
    IdentificationError
        If a structure cannot be fitted.
    """
    progress.begin("Fitting the structures", total=float(len(structures)))
    fits = []
    for structure in structures:
        how = settings[structure.name]
        try:
            fits.append(_fitted(structure, measurement, settings=how, rng=rng))
        except IdentificationError as error:
            responses = [response for _, response in pairs_of(structure, measurement)]
            against = by_weight([reason for response in responses for reason in response.reasons])
            if not against:
                raise
            raise IdentificationError(f"{against[0].sentence} So the fit failed: {error}") from error
        progress.advance(1.0)
    return tuple(fits)


def _fitted(
    structure: Structure, measurement: Measurement, *, settings: Settings, rng: np.random.Generator
) -> Identification:
    """Return the fit of a structure; with a set point that may be logged late where the data clearly want it.

    A latency that stops at nothing pulls the delay of the loop, and the margins with it, to where the sum of both is
    right; a set point that is late by more leaves no stable loop. A misfit of another cause is left as it is, and so is
    what chance does: values are of a line as it is built, and intervals reach below nothing all the same.
    """
    late = bounds_of_late(structure.free)
    if not late:
        return fit_of(pairs_of(structure, measurement), rng=copy.deepcopy(rng), settings=settings)
    found: Identification | IdentificationError
    try:
        found = fit_of(pairs_of(structure, measurement), rng=copy.deepcopy(rng), settings=settings)
        if all(one.value > 0.0 for one in found.parameters if one.name in late):
            return found
    except IdentificationError as error:
        found = error
    with suppress(IdentificationError):
        again = pairs_of(structure.free_between(**late), measurement)
        beyond = fit_of(again, rng=copy.deepcopy(rng), settings=settings)
        if explained(beyond) and _is_clearly_better(beyond, found):
            return beyond
    if isinstance(found, IdentificationError):
        raise found
    return found


def _is_clearly_better(late: Identification, found: Identification | IdentificationError) -> bool:
    """Return whether a set point that is logged late explains what one in time does not, or far better."""
    if isinstance(found, IdentificationError) or not explained(found):
        return True
    return 2.0 * (found.cost - late.cost) > _CLEARLY


def comparisons_of(
    fits: Sequence[Identification], *, rng: np.random.Generator, progress: Progress = SILENT
) -> tuple[StructureComparison, ...]:
    """Return a comparison for every group of two or more fits of the same channels, in the order of the fits.

    ``fits``: fits to responses of one recording, weighed alike. ``rng``: for the draws; each group begins with its
    state.
    """
    groups: dict[tuple[tuple[tuple[str, str], ...], ...], list[Identification]] = {}
    for one in fits:
        # a structure with a further input is fitted to more lines than one without
        groups.setdefault(tuple(part.structure.channels for part in one.parts), []).append(one)
    chosen = [group for group in groups.values() if len(group) > 1]
    if not chosen:
        return ()
    progress.begin("Comparing the structures", total=float(len(chosen)))
    comparisons = []
    for group in chosen:
        comparisons.append(compare_fits(group, rng=copy.deepcopy(rng)))
        progress.advance(1.0)
    return tuple(comparisons)
