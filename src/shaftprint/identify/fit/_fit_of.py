"""A fit to as many responses as there are: to one, or to several jointly."""

from collections.abc import Sequence

import numpy as np

from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify, identify_jointly
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse


def fit_of(
    pairs: Sequence[tuple[Structure, FrequencyResponse]],
    *,
    rng: np.random.Generator,
    settings: Settings,
    lines: Sequence[str] | None = None,
) -> Identification:
    """Return the fit of one structure to one response, or to several at their working points.

    ``pairs``: the structure at each working point with its response. ``rng``: source of the start values. ``settings``:
    how to search and weigh. ``lines``: names of the lines of a single response to fit; those that responses mark as
    used by default.
    """
    if len(pairs) == 1:
        return identify(*pairs[0], rng=rng, settings=settings, lines=lines)
    return identify_jointly(pairs, rng=rng, settings=settings)
