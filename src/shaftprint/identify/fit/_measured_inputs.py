"""Structures of several inputs, fitted to one test in which all inputs but the first were measured.

A governor moves the rack by ``X = H_1 n_set + H_2 n``. One test moves set point and speed together, so that neither
response is seen alone; what is seen are ``X / n_set`` and ``n / n_set``, and along this test

``X / n_set = H_1 + H_2 (n / n_set)``.

The measured ``n / n_set`` takes the place of a model of all that lies behind the rack. Its noise comes through ``H_2``
into the residual; eliminating the true ``n / n_set`` of each line from the likelihood leaves the residual weighted by
the covariance that it then has (W. A. Fuller, Measurement Error Models, 1987, section 3.2). ``H_2`` is taken from the
fit before, until it stays.

A delay or a scale of the set point is a parameter of ``H_1`` like any other. The error ``e = n_set - n`` is not formed:
it is a small difference, which a latency that nobody told turns by more than the noise.
"""

from dataclasses import replace

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.models._expression import Expression
from shaftprint.models._structure import Structure
from shaftprint.models._tabulated import Tabulated
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._measured_inputs import with_measured_inputs

SPEED = "n"


def has_measured_inputs(structure: Structure, response: FrequencyResponse) -> bool:
    """Return whether a response has a structure's first input, and all others among its outputs.

    ``structure``, ``response``: what is to be fitted, and to what.
    """
    # what is neither is refused, in words, where it is fitted
    if not (isinstance(structure, Structure) and isinstance(response, FrequencyResponse)):
        return False
    needed = {*structure.inputs[1:], *structure.outputs}
    return len(structure.inputs) > 1 and response.inputs == structure.inputs[:1] and needed <= set(response.outputs)


def along_the_test(
    structure: Structure, response: FrequencyResponse, values: FloatArray
) -> tuple[Structure, FrequencyResponse]:
    """Return a structure of the first input alone, with what was measured of the others in it, and its data.

    ``structure``, ``response``: what is to be fitted, and to what, for which ``has_measured_inputs`` holds. ``values``:
    parameters at which the noise of the measured inputs is carried through, shape (parameters,).
    """
    first, *others = structure.inputs
    moved = {name: Tabulated(response.omega_rad_s, _true(response, name)) for name in others}
    paths = dict(zip(structure.channels, structure.paths, strict=True))
    outputs: dict[str, Expression] = {}
    for output in structure.outputs:
        outputs[output] = paths[output, first]
        for other in others:
            outputs[output] = outputs[output] + paths[output, other] * moved[other]
    gains = structure.response(values, 1j * response.omega_rad_s).reshape(len(outputs), 1 + len(others), -1)[:, 1:]
    pick_up = np.stack([_pick_up(response, name) for name in others])
    data = with_measured_inputs(response, outputs=tuple(outputs), measured=others, gains=gains / pick_up)
    return replace(structure, inputs=(first,), input=first, outputs=outputs), data


def _true(response: FrequencyResponse, name: str) -> ComplexArray:
    """Return a measured input without what its pick-up does to it, shape (lines,)."""
    return np.asarray(response.response[response.outputs.index(name), 0] / _pick_up(response, name))


def _pick_up(response: FrequencyResponse, name: str) -> ComplexArray:
    """Return what the pick-up of the speed makes of it, 1 for any other signal, shape (lines,); see ``SpeedSensor``."""
    if name != SPEED:
        return np.ones(len(response.lines), dtype=np.complex128)
    frequency = response.frequency_hz
    means = np.sinc(frequency * response.averaging_s) * np.sinc(frequency * response.hold_s)
    return np.asarray(means * np.exp(-1j * response.omega_rad_s * response.pick_up_delay_s))
