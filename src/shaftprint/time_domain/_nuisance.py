"""What is in a record beside the model: offsets and slow drifts of the outputs.

They are linear, and are projected out: for each parameter set they take their best values, exactly (variable
projection: Golub and Pereyra, The differentiation of pseudo-inverses and nonlinear least squares problems whose
variables separate, 1973).
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.time_domain._record import Record

# Columns of which less than this share is left beside the others are none.
LEAST_SHARE = 1e-9
# An input goes in steps where the fastest of its samples, this share of all, hold this share of its squared changes: of
# a sine a tenth of the samples holds a fifth, of a chirp two fifths.
FASTEST, OF_CHANGES = 0.1, 0.8


def usual_drift_degree(record: Record) -> int:
    """Return 0 for a record of steps, whose levels a drift would take for its own, and 1 for any other."""
    return 0 if all(_in_steps(values) for values in record.inputs.values()) else 1


def _in_steps(values: FloatArray) -> bool:
    """Return whether an input stands still most of the time, shape (samples,)."""
    squares = np.sort(np.diff(values) ** 2)[::-1]
    fastest = squares[: max(round(FASTEST * squares.size), 1)]
    return bool(fastest.sum() >= OF_CHANGES * squares.sum())


def drift_columns(record: Record, outputs: int, degree: int, *, anew_after_s: float) -> FloatArray:
    """Return polynomials in time for each output, shape (columns, samples, outputs).

    ``outputs``: number of outputs. ``degree``: highest power of time: 0 for offsets, 1 for drifts, -1 for none.
    ``anew_after_s``: a longer gap [s] begins a polynomial of its own.
    """
    pieces: list[list[int]] = []
    for stretch in record.stretches:
        if pieces and (stretch.start - pieces[-1][1]) / record.rate_hz <= anew_after_s:
            pieces[-1][1] = stretch.stop
        else:
            pieces.append([stretch.start, stretch.stop])
    columns = np.zeros((len(pieces), degree + 1, outputs, record.samples, outputs))
    for number, (begin, end) in enumerate(pieces):
        position = np.linspace(-1.0, 1.0, end - begin) if end - begin > 1 else np.zeros(1)
        for power in range(degree + 1):
            for output in range(outputs):
                columns[number, power, output, begin:end, output] = np.polynomial.legendre.legval(
                    position, np.eye(degree + 1)[power]
                )
    return columns.reshape(-1, record.samples, outputs)


def orthonormal(columns: FloatArray) -> FloatArray:
    """Return an orthonormal basis of rows, shape (rank, length), from rows that may depend on each other."""
    size = np.linalg.norm(columns, axis=1)
    kept = columns[size > 0.0] / size[size > 0.0, None]
    if not kept.size:
        return np.zeros((0, columns.shape[1]))
    _, sizes, right = np.linalg.svd(kept, full_matrices=False)
    return np.asarray(right[sizes > LEAST_SHARE * sizes[0]])


def without(rows: FloatArray, basis: FloatArray) -> FloatArray:
    """Return rows, shape (..., length), without what lies in an orthonormal basis, shape (rank, length)."""
    return np.asarray(rows - (rows @ basis.T) @ basis)


def left_of(rows: FloatArray, basis: FloatArray, *, least: float = LEAST_SHARE) -> FloatArray:
    """Return rows, shape (rows, length), without what lies in an orthonormal basis; nothing where rounding is left.

    ``least``: share of a row that must be left, lest it be nothing.

    An angle that is integrated and its offset are one constant: what rounding leaves of the one beside the other is a
    direction of its own, another with every parameter set, and no cost that takes it out is smooth.
    """
    left = without(rows, basis)
    own = np.linalg.norm(left, axis=1) > least * np.linalg.norm(rows, axis=1)
    return np.asarray(left * own[:, None])
