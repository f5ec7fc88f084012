"""What a record says less of where a number is assumed: by how much dry friction yields, in motion that turns often.

A held number ``q`` with the standard deviation ``s`` changes the outputs by ``c = s df/dq``. With it as noise beside
noise of unit variance, the residuals have the covariance ``I + C C^T``, and ``(I + C C^T)^-1/2`` makes them white: that
shortens what lies along ``C`` and leaves the rest.
"""

import numpy as np

from shaftprint.arrays import FloatArray


def shortened(rows: FloatArray, columns: FloatArray) -> FloatArray:
    """Return whitened rows, shape (rows, length), as they count beside assumed numbers.

    ``columns``: what one standard deviation of each assumed number changes, whitened, shape (assumed, length).
    """
    _, size, turned = np.linalg.svd(columns, full_matrices=False)
    share = 1.0 - 1.0 / np.sqrt(1.0 + size**2)
    return np.asarray(rows - (rows @ turned.T * share) @ turned)
