"""Coordinates in which the valley of delay, gains and actuator is straight, so that tests share one covariance.

What a test knows least is a valley: numbers that change together and leave the responses nearly as they are. It is
curved. Estimates of an unchanged ship lie along it, a tenth of a gain apart, and each states its covariance with the
directions of its own place. A mean of these covariances is as wide as the valley is bent, and the difference of two
estimates leaves the floor where their tangents part: both hide what lies across.

The responses of the model are nearly linear where the numbers are not. With ``x`` the numbers of a test, ``r`` the mean
of all, ``h`` the logarithms of the responses at the lines and ``A`` the derivatives of ``h`` at ``r``

    x' = r + A^+ (h(x) - h(r))

is where the model, linearised at ``r`` alone, has the responses of the test: ``x`` itself to first order, with the
covariance ``T C T'``, ``T = A^+ A(x)`` (one Gauss-Newton step; D. M. Bates, D. G. Watts, "Relative curvature measures
of nonlinearity", Journal of the Royal Statistical Society B 42, 1980, on the parameter-effects curvature that this
takes away). It holds as far as tests scatter: what a change of the ship has done is taken off first, and put back.
Numbers that were told beforehand stay as they are: the responses do not tell them.
"""

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.catalogue._shipped import shipped_structure
from shaftprint.drift._single_test import SingleTest, is_share
from shaftprint.errors import StructureError
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.models._working_point import at_working_point

if TYPE_CHECKING:
    from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum
    from shaftprint.fingerprint._line_fingerprint import LineFingerprint
    from shaftprint.models._structure import Structure


def straightened(
    tests: "Sequence[LineFingerprint]",
    singles: Sequence[SingleTest],
    names: tuple[str, ...],
    moved: FloatArray | None = None,
) -> tuple[SingleTest, ...]:
    """Return tests in coordinates in which the responses of their model are linear; as they are where that is not told.

    Told it is where all tests are of one structure, a shipped one, with the frequencies of their lines, at as many
    speeds each.

    ``tests``: fingerprints. ``singles``: their numbers, see ``single_test``. ``names``: names of these numbers.
    ``moved``: what changes of the ship have done to the numbers of each test, so that it is no way along the valley;
    shape (tests, numbers), nothing when not given.
    """
    ships = [test for test in tests if isinstance(test, Fingerprint)]
    model = _model_of(ships) if len(ships) == len(tests) else None
    if model is None:
        return tuple(singles)
    structure, speeds = model
    numbers = [tests[0].quantity(name) for name in names]
    roles = [number.role for number in numbers]
    stands_for = [structure.named_as(role) if role is not None else None for role in roles]
    of_model = [at for at, parameter in enumerate(stands_for) if parameter is not None]
    told = {*tests[0].priors, *(name for test in tests for name in test.held)}
    free = [place for place, at in enumerate(of_model) if stands_for[at] not in told]
    parameters = [str(stands_for[at]) for at in of_model]
    if not free:
        return tuple(singles)
    unmoved = np.array([one.values for one in singles]) - (0.0 if moved is None else moved)
    apart = (unmoved - unmoved.mean(axis=0))[:, of_model]
    shares = np.array([is_share(roles[at], numbers[at].unit) for at in of_model], dtype=bool)
    reference = _reference(structure, ships)
    found_at = [_responses(at, reference, parameters, apart, shares, frequency_hz) for at, frequency_hz in speeds]
    responses, slopes = (np.concatenate(of_all, axis=1) for of_all in zip(*found_at, strict=True))
    if not (np.all(np.isfinite(responses)) and np.all(np.isfinite(slopes))):
        return tuple(singles)
    straight = np.linalg.pinv(slopes[-1][:, free])
    places = np.array(of_model)[free]
    found = []
    for single, response, slope, distance in zip(singles, responses, slopes, apart, strict=False):
        values, turn = single.values.copy(), np.eye(len(names))
        values[places] += straight @ (response - slopes[-1] @ distance)
        turn[np.ix_(places, np.array(of_model))] += straight @ (slope - slopes[-1])
        loadings, stated = (
            {source: turn @ change for source, change in of_sources.items()}
            for of_sources in (single.loadings, single.stated)
        )
        own = turn @ single.own @ turn.T
        found.append(replace(single, values=values, own=own, loadings=loadings, stated=stated))
    return tuple(found)


def _model_of(tests: Sequence[Fingerprint]) -> "tuple[Structure, list[tuple[Structure, FloatArray]]] | None":
    """Return the structure of all tests, and as it is at each of their speeds with the frequencies of its lines [Hz].

    None where it is not one structure, or the lines of a test are not told.
    """
    alike = {(test.structure, tuple(sorted(test.held)), tuple(sorted(test.priors))) for test in tests}
    counts = {len(test.noise) for test in tests}
    if len(alike) > 1 or len(counts) > 1 or counts == {0}:
        return None
    try:
        structure = shipped_structure(tests[0].structure, {one.name for one in tests[0].parameters})
    except StructureError:
        return None
    known = set(tests[0].values)
    if known != set(structure.names):
        return None
    frequencies = [
        np.unique(np.concatenate([noise.frequency_hz for noise in of_speed]))
        for of_speed in zip(*(sorted(test.noise, key=_speed) for test in tests), strict=True)
    ]
    if len(frequencies) == 1:
        return structure, [(structure, frequencies[0])]
    if any(len(test.legs) != len(frequencies) for test in tests):
        return None
    shares = np.mean([[_shares(leg, test) for leg in sorted(test.legs, key=_speed)] for test in tests], axis=0)
    at = [at_working_point(structure, speed_share=speed, torque_share=torque) for speed, torque in shares.tolist()]
    return structure, list(zip(at, frequencies, strict=True))


def _speed(of_one_speed: "LegRecord | NoiseSpectrum") -> float:
    return of_one_speed.engine_speed_rpm


def _shares(leg: "LegRecord", test: Fingerprint) -> tuple[float, float]:
    """Return speed and torque of a leg over those at which the parameters of its test are normalised."""
    speed_rpm, torque_nm = test.conditions.engine_speed.value, test.conditions.shaft_torque.value
    return leg.engine_speed_rpm / speed_rpm, leg.shaft_torque_nm / torque_nm


def _reference(structure: "Structure", tests: Sequence[Fingerprint]) -> FloatArray:
    """Return the mean parameters of all tests, shape (parameters,)."""
    values = [test.values for test in tests]
    mean: FloatArray = np.mean([[one[name] for name in structure.names] for one in values], axis=0)
    return mean


def _responses(
    structure: "Structure",
    reference: FloatArray,
    parameters: Sequence[str],
    apart: FloatArray,
    shares: "np.ndarray[tuple[int], np.dtype[np.bool_]]",
    frequency_hz: FloatArray,
) -> tuple[FloatArray, FloatArray]:
    """Return the logarithms of the responses over those of the reference, and their derivatives to the numbers.

    The last row is the reference itself. Shapes (tests + 1, rows) and (tests + 1, rows, numbers).
    """
    places = [structure.names.index(name) for name in parameters]
    apart = np.vstack([apart, np.zeros(len(places))])
    table = np.tile(reference, (len(apart), 1))
    table[:, places] = np.where(shares, table[:, places] * np.exp(apart), table[:, places] + apart)
    with np.errstate(all="ignore"):
        response, gradient = structure.gradient(table, 2j * np.pi * frequency_hz, parameters)
        logarithm = np.log(response / response[-1])
        # what is a share is judged by its logarithm
        slope = gradient / response[:, None] * np.where(shares, table[:, places], 1.0)[:, :, None, None]
    rows = np.concatenate([logarithm.real, logarithm.imag], axis=-1).reshape(len(apart), -1)
    columns = np.concatenate([slope.real, slope.imag], axis=-1).reshape(len(apart), len(places), -1)
    return rows, np.swapaxes(columns, 1, 2)
