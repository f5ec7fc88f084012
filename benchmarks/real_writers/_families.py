"""All families, and the files of each."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from benchmarks.real_writers import can_logs, hdf5, mat, mdf, netcdf, octave, others, own, tdms, text, uff
from benchmarks.real_writers._truth import Family, Options, Truth

FAMILIES: tuple[Family, ...] = (
    mdf.FAMILY,
    tdms.FAMILY,
    hdf5.FAMILY,
    netcdf.FAMILY,
    mat.FAMILY,
    octave.FAMILY,
    text.FAMILY,
    uff.FAMILY,
    can_logs.FAMILY,
    others.FAMILY,
    own.FAMILY,
)
_SEED = 1


def written(family: Family, folder: Path, files: int, *, spread: bool = False) -> Iterator[tuple[Path, Options, Truth]]:
    """Write the files of a family: the extremes, then drawn ones.

    Parameters
    ----------
    family, folder
        What is written, and where.
    files
        How many.
    spread
        Whether they are taken from all of the table's at even distances.
    """
    step = max(family.files // files, 1) if spread else 1
    for number in range(0, min(files * step, family.files) if spread else files, step):
        yield write_one(family, folder, number)


def write_one(family: Family, folder: Path, number: int) -> tuple[Path, Options, Truth]:
    """Write the file of a number; it depends on nothing else."""
    rng = np.random.default_rng((_SEED, number))
    options = family.extremes[number] if number < len(family.extremes) else family.drawn(rng)
    path = folder / f"{family.name.replace(' ', '_')}_{number:03}{options.get('suffix', family.suffix)}"
    path.unlink(missing_ok=True)
    return path, options, family.write(path, rng, options)
