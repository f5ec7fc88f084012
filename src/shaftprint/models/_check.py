"""Whether the blocks of a structure agree with themselves: worth a call before a structure of one's own is fitted."""

import numpy as np

from shaftprint.arrays import ComplexArray, FloatArray
from shaftprint.errors import StructureError
from shaftprint.models._block import Block
from shaftprint.models._numerical_derivative import numerical_derivative
from shaftprint.models._structure import Structure

# Half a decade apart and off round numbers, where a user's resonance may lie.
OMEGA_RAD_S = np.geomspace(0.0123, 1230.0, 21)
# Where between their bounds parameters are tried, besides their values: each at another share, so that two with the
# same bounds do not get the same value and hide that their derivatives are swapped.
SHARES = (0.37, 0.71)
GOLDEN = 0.618034
LOWEST, HIGHEST = 0.1, 0.9
# A formula is wrong when it is off by more than this share.
WRONG = 1e-3
SAME = 1e-9


def check_structure(structure: Structure) -> None:
    """Check that responses, derivatives and coefficients of every block agree with each other.

    They are evaluated at the values of the parameters and at two sets of values between their bounds. An error that a
    block raises by itself comes through as it is.

    Raises
    ------
    StructureError
        If a block gives a response of a wrong shape or one that is not finite, cannot take several parameter sets at
        once, is not real in the time domain, or has derivatives or coefficients that are not those of its response.
    """
    columns = structure.columns(_table(structure))
    for block in structure.blocks:
        values = tuple(columns[parameter.name] for parameter in block.parameters)
        where = f"structure {structure.name}, block {type(block).__name__}"
        if block.parameters:
            where += f" of {', '.join(parameter.name for parameter in block.parameters)}"
        s = np.asarray(1j * OMEGA_RAD_S, dtype=np.complex128)
        response = _response(where, block, s, values)
        _check_sets(where, block, s, values, response)
        _check_real(where, block, s, values, response)
        _check_ratio(where, block, s, values, response)
        _check_derivatives(where, block, s, values, response)


def _table(structure: Structure) -> FloatArray:
    """Return the sets of parameters to try, shape (sets, parameters).

    Held parameters are moved as well: held at 0, as the averaging of a speed sensor is, one may hide that its
    derivative is wrong.
    """
    rows = [structure.vector({})]
    for first in SHARES:
        moved = {}
        for index, p in enumerate(structure.parameters):
            share = LOWEST + (HIGHEST - LOWEST) * ((first + GOLDEN * index) % 1.0)
            if np.isfinite(p.lower) and np.isfinite(p.upper):
                moved[p.name] = p.lower + share * (p.upper - p.lower)
        rows.append(structure.vector(moved))
    return np.array(rows)


def _response(where: str, block: Block, s: ComplexArray, values: tuple[FloatArray, ...]) -> ComplexArray:
    raw = np.asarray(block.transfer(s, *values))
    shape = np.broadcast_shapes(s.shape, *(value.shape for value in values))
    try:
        response = np.broadcast_to(raw, shape).astype(np.complex128)
    except ValueError:
        raise StructureError(
            f"{where}: expected a response of shape {shape} for {s.size} frequencies, found {raw.shape}."
        ) from None
    lost = ~np.all(np.isfinite(response), axis=-1)
    if lost.any():
        row = int(np.argmax(lost))
        at = ", ".join(f"{p.name} = {float(v[row, 0]):g}" for p, v in zip(block.parameters, values, strict=True))
        raise StructureError(f"{where}: its response is not finite within the bounds, at {at}; tighten the bounds.")
    return response


def _check_sets(
    where: str, block: Block, s: ComplexArray, values: tuple[FloatArray, ...], response: ComplexArray
) -> None:
    for row in range(response.shape[0] if values else 0):
        alone = block.transfer(s, *(value[row] for value in values))
        if not _agree(alone, response[row], SAME):
            raise StructureError(
                f"{where}: several parameter sets at once give another response than one by one: let each value keep "
                "its shape (..., 1)."
            )


def _check_real(
    where: str, block: Block, s: ComplexArray, values: tuple[FloatArray, ...], response: ComplexArray
) -> None:
    if not _agree(np.conj(block.transfer(np.conj(s), *values)), response, SAME):
        raise StructureError(
            f"{where}: its response at -s is not the conjugate of that at s, so it answers real signals with complex "
            "ones: use s itself, not its imaginary part or size."
        )


def _check_ratio(
    where: str, block: Block, s: ComplexArray, values: tuple[FloatArray, ...], response: ComplexArray
) -> None:
    for row in range(response.shape[0] if values else 1):
        ratio = block.ratio(*(float(value[row, 0]) for value in values))
        if ratio is None:
            continue
        by_ratio = np.polyval(ratio[0], s) / np.polyval(ratio[1], s)
        expected = response[row] if values else response
        if not _agree(by_ratio, expected, WRONG):
            one, other, omega = _furthest(by_ratio, expected)
            raise StructureError(
                f"{where}: ratio() gives {one:.4g} at {omega:.3g} rad/s, transfer() {other:.4g}: coefficients stand "
                "highest power first, numerator before denominator."
            )


def _check_derivatives(
    where: str, block: Block, s: ComplexArray, values: tuple[FloatArray, ...], response: ComplexArray
) -> None:
    derivatives = block.derivatives(s, response, *values)
    if len(derivatives) != len(values):
        raise StructureError(f"{where}: derivatives() gives {len(derivatives)} arrays for {len(values)} parameters.")
    for index, parameter in enumerate(block.parameters):
        numerical, certain = numerical_derivative(block, s, response, values, index)
        formula = np.broadcast_to(derivatives[index], response.shape)
        if not _agree(formula[certain], numerical[certain], WRONG):
            stated, other, omega = _furthest(np.where(certain, formula, numerical), numerical)
            raise StructureError(
                f"{where}: its derivative to {parameter.name} is {stated:.4g} at {omega:.3g} rad/s, the numerical one "
                f"{other:.4g}; correct derivatives(), or leave it out to have them numerically."
            )


def _agree(response: ComplexArray, expected: ComplexArray, share: float) -> bool:
    response, expected = np.broadcast_arrays(response, expected)
    return bool(np.all(np.abs(response - expected) <= share * np.abs(expected) + 1e-300))


def _furthest(response: ComplexArray, expected: ComplexArray) -> tuple[complex, complex, float]:
    """Return both numbers and the frequency [rad/s] where they differ most."""
    apart = np.abs(response - expected) / np.maximum(np.abs(expected), 1e-300)
    index = np.unravel_index(int(np.argmax(apart)), response.shape)
    return complex(response[index]), complex(expected[index]), float(OMEGA_RAD_S[index[-1]])
