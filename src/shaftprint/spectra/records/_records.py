"""Plain arrays from any source, checked and stacked: the records behind a frequency response."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import ResponseError

Channels: TypeAlias = Mapping[str, ArrayLike]


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Records:
    """Measured time series of one or more runs with the same channels, inputs first."""

    inputs: tuple[str, ...]
    """Names of the inputs."""
    outputs: tuple[str, ...]
    """Names of the outputs."""
    rate_hz: float
    """Sample rate of all channels [Hz]."""
    values: tuple[FloatArray, ...]
    """Samples of each run in the units of the user, shape (inputs + outputs, samples); lengths may differ."""


def read_records(
    inputs: Channels | Sequence[Channels], outputs: Channels | Sequence[Channels], rate_hz: float
) -> Records:
    """Check arrays of one or more runs and stack them.

    ``inputs``, ``outputs``: samples by channel name, of one run or of several. ``rate_hz``: sample rate [Hz]. Returns
    the records. Raises ResponseError if the rate is not positive, names are missing, double or differ between runs, a
    channel is no row of finite numbers, lengths of a run differ, or a channel does not move.
    """
    if not (np.isfinite(rate_hz) and rate_hz > 0.0):
        raise ResponseError(f"rate_hz = {rate_hz}: expected a positive, finite sample rate in Hz.")
    all_inputs, all_outputs = _runs("inputs", inputs), _runs("outputs", outputs)
    if len(all_inputs) != len(all_outputs):
        raise ResponseError(
            f"inputs and outputs: expected as many records of both, found {len(all_inputs)} and {len(all_outputs)}."
        )
    names = tuple(all_inputs[0]), tuple(all_outputs[0])
    both = set(names[0]) & set(names[1])
    if both:
        raise ResponseError(f"{', '.join(sorted(both))}: expected a channel among inputs or outputs, found it in both.")
    values = []
    for run, channels in enumerate(zip(all_inputs, all_outputs, strict=True)):
        for kind, present, expected in zip(("inputs", "outputs"), channels, names, strict=True):
            if set(present) != set(expected):
                raise ResponseError(
                    f"record {run + 1}, {kind}: expected {', '.join(expected)} as in record 1, found "
                    f"{', '.join(present) or 'none'}."
                )
        rows = [_row(f"record {run + 1}, {n}", c[n]) for c, side in zip(channels, names, strict=True) for n in side]
        lengths = {row.size for row in rows}
        if len(lengths) > 1:
            raise ResponseError(
                f"record {run + 1}: expected channels of one length, found {', '.join(map(str, sorted(lengths)))} "
                "samples."
            )
        values.append(frozen_float(np.stack(rows)))
    return Records(inputs=names[0], outputs=names[1], rate_hz=float(rate_hz), values=tuple(values))


def _runs(kind: str, channels: Channels | Sequence[Channels]) -> Sequence[Channels]:
    runs = [channels] if isinstance(channels, Mapping) else channels
    if isinstance(runs, str | np.ndarray) or not len(runs) or not all(isinstance(run, Mapping) for run in runs):
        raise ResponseError(
            f'{kind}: expected a mapping of names to arrays such as {{"voltage": samples}}, or a list of such mappings.'
        )
    if not runs[0]:
        raise ResponseError(f"{kind}: expected at least one channel, found none.")
    return runs


def _row(name: str, samples: ArrayLike) -> FloatArray:
    try:
        row = np.asarray(samples)
        if np.iscomplexobj(row):
            raise ResponseError(f"{name}: expected real samples, found complex numbers.")
        row = row.astype(np.float64)
    except (TypeError, ValueError):
        raise ResponseError(f"{name}: expected an array of numbers.") from None
    if row.ndim != 1 or row.size == 0:
        raise ResponseError(
            f"{name}: expected one row of samples, found an array of shape {row.shape}: give every channel its own "
            "name, and flatten a column with ravel()."
        )
    lost = ~np.isfinite(row)
    if lost.any():
        index = int(np.argmax(lost))
        raise ResponseError(
            f"{name}: expected finite numbers, found {row[index]} at sample {index} ({int(lost.sum())} such samples): "
            "fill them in or cut the record there."
        )
    if np.ptp(row) == 0.0:
        raise ResponseError(f"{name}: expected a signal that moves, found {row[0]:g} throughout.")
    return row
