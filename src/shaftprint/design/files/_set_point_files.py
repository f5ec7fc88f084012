"""The set point of a planned test in the files that generators and MATLAB read."""

from pathlib import Path
from typing import Final

import numpy as np
import scipy

from shaftprint import __version__
from shaftprint.design.files._set_point_samples import SetPointSamples
from shaftprint.files import written_whole

CSV, GENERATOR, MAT = "set_point.csv", "set_point_generator.txt", "set_point.mat"
"""Names of the files: a table, voltages alone for an arbitrary waveform generator, and MATLAB's."""
# MATLAB keeps 116 bytes of text at the head of a file; a date would make equal plans differ.
_HEAD: Final = 116


def write_set_point(samples: SetPointSamples, folder: Path) -> None:
    """Write a set point as a table, as voltages alone and for MATLAB, each whole or not at all.

    ``set_point.csv`` has the columns ``time_s``, ``V`` and ``rpm``; ``set_point_generator.txt`` one voltage a line and
    nothing else, which is what generators import; ``set_point.mat`` the vectors ``time_s``, ``set_point_v``,
    ``set_point_rpm`` and the scalar ``sample_rate_hz``. Of a lever that is not moved in volts, table and MATLAB have
    its reading too: a column of its unit, and ``lever`` with ``lever_unit``.
    """
    lever = samples.lever
    columns = [samples.time_s, samples.volts, samples.speed_rpm]
    head, digits = "time_s,V,rpm", ["%.9g", "%.6f", "%.3f"]
    # the rpm of a lever stand there already
    if lever is not None and lever.unit != "rpm":
        columns, head, digits = [*columns, lever.reading(samples.volts)], f"{head},{lever.unit}", [*digits, "%.6f"]
    with written_whole(folder / CSV, overwrite=True) as part:
        np.savetxt(part, np.column_stack(columns), fmt=digits, delimiter=",", header=head, comments="")
    with written_whole(folder / GENERATOR, overwrite=True) as part:
        np.savetxt(part, samples.volts, fmt="%.6f")
    content: dict[str, object] = {
        "sample_rate_hz": samples.rate_hz,
        "time_s": samples.time_s,
        "set_point_v": samples.volts,
        "set_point_rpm": samples.speed_rpm,
    }
    if lever is not None:
        content |= {"lever": lever.reading(samples.volts), "lever_unit": lever.unit}
    with written_whole(folder / MAT, overwrite=True) as part:
        scipy.io.savemat(str(part), content, appendmat=False, oned_as="column", do_compression=True)
        with part.open("r+b") as stored:
            stored.write(f"MATLAB 5.0 MAT-file, written by shaftprint {__version__}".encode().ljust(_HEAD))
