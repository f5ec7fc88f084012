"""Fits beside each other, compared where they explain the same data."""

from collections.abc import Sequence

import numpy as np

from shaftprint.cli._progress import Steps
from shaftprint.identify import Comparison, Identification, compare_fits


def comparisons_of(fits: Sequence[Identification], *, seed: int, steps: Steps) -> tuple[Comparison, ...]:
    """Return a comparison for every group of two or more fits of the same channels, in the order of the fits.

    Parameters
    ----------
    fits
        Fits to responses of one recording, weighed alike.
    seed
        Seed of the draws; each group begins with it anew.
    steps
        Progress of the command.
    """
    groups: dict[tuple[tuple[str, str], ...], list[Identification]] = {}
    for found in fits:
        groups.setdefault(found.structure.channels, []).append(found)
    chosen = [group for group in groups.values() if len(group) > 1]
    if not chosen:
        return ()
    steps.begin("Comparing the structures", total=float(len(chosen)))
    compared = []
    for group in chosen:
        compared.append(compare_fits(group, rng=np.random.default_rng(seed)))
        steps.advance(1.0)
    return tuple(compared)
