"""A signal that comes late by any part of a sample, stretch by stretch."""

import math

import numpy as np

from shaftprint.arrays import FloatArray


class Late:
    """Stream of the samples of one signal, so many samples late, straight lines between them."""

    def __init__(self, samples: float) -> None:
        """Begin before the first stretch.

        ``samples``: by how many samples the signal is late, not negative.
        """
        self._late = samples
        self._kept = math.ceil(samples) + 1
        self._tail: FloatArray | None = None

    def next(self, values: FloatArray, *, before: float = 0.0) -> FloatArray:
        """Return the next stretch as it comes late, shape (samples,).

        ``values``: the signal itself, shape (samples,). ``before``: by how much it rose from sample to sample before
        the first stretch, steadily.
        """
        if self._tail is None:
            self._tail = values[0] + before * np.arange(-self._kept, 0)
        longer = np.concatenate([self._tail, values])
        self._tail = longer[-self._kept :]
        places = self._kept + np.arange(values.size) - self._late
        late: FloatArray = np.interp(places, np.arange(longer.size), longer)
        return late
