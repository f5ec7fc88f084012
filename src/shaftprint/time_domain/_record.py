"""The noun of the room: a stretch of a test as it is fitted in time."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float, runs_of
from shaftprint.errors import SignalError
from shaftprint.notebook._shown import Shown
from shaftprint.time_domain._decimator import Decimator


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class Record(Shown):
    """Inputs and outputs on one uniform grid, with what drives the model beside them, on a finer one.

    Deviations are normalised with the working point. Where a record has gaps the model runs through them, and the
    outputs there do not count; a record begins and ends where its inputs do.
    """

    name: str
    """What was done, such as ``S5``, or ``C21+C22+C23``."""
    rate_hz: float
    """Samples a second of inputs and outputs [Hz]."""
    start_s: float
    """Time of the first sample, in seconds of the recording."""
    inputs: Mapping[str, FloatArray]
    """Input deviations by name [-], as much filtered as the outputs, each of shape (samples,)."""
    outputs: Mapping[str, FloatArray]
    """Output deviations by name [-], each of shape (samples,); where they are not used they may be anything finite."""
    used: BoolArray
    """Which samples count: false in gaps, and while the model forgets its start; shape (samples,)."""
    drive: Mapping[str, FloatArray]
    """The inputs before the filter, ``every`` samples for one of the record and ``margin`` more at either end, each of
    shape (``drive_samples``,)."""
    every: int = 1
    """Samples of the drive for one of the record."""
    hold: bool = False
    """Whether the drive holds between its samples; else it goes straight from one to the next."""
    load: float = 1.0
    """Propeller load relative to that of the working point: torque over the square of speed."""
    averaging_s: float = 0.0
    """Length of the window over which the pick-up's speed is a mean [s]."""
    hold_s: float = 0.0
    """Time for which the pick-up's value is held [s]."""
    pick_up_delay_s: float = 0.0
    """Delay of the pick-up's value behind the true speed [s]."""
    engine_speed_rev_s: float | None = None
    """Engine speed of the working point [rev/s]; None where only deviations are known."""
    shaft_torque_nm: float | None = None
    """Shaft torque of the working point [N m]; None where only deviations are known."""
    remarks: tuple[str, ...] = ()
    """What was taken for granted where its channels were read, in sentences."""
    decimator: Decimator = field(init=False, repr=False)
    """The filter between the drive's grid and the record's."""

    def __post_init__(self) -> None:
        """Check that all channels belong together.

        Raises SignalError if the rate is no positive number, a channel is missing, has another length or holds values
        that are not finite, or no sample is used.
        """
        if not (np.isfinite(self.rate_hz) and self.rate_hz > 0.0):
            raise SignalError(f"record {self.name}: expected a positive sample rate in Hz, found {self.rate_hz}.")
        object.__setattr__(self, "decimator", Decimator(every=self.every))
        if not self.inputs or not self.outputs or set(self.inputs) != set(self.drive):
            raise SignalError(
                f"record {self.name}: expected inputs, the same as a drive, and outputs, found inputs "
                f"{', '.join(self.inputs) or 'none'}, drive {', '.join(self.drive) or 'none'}, outputs "
                f"{', '.join(self.outputs) or 'none'}."
            )
        fine = (self.samples - 1) * self.every + 1 + 2 * self.margin
        for kind, channels, length in (
            ("input", self.inputs, self.samples),
            ("output", self.outputs, self.samples),
            ("drive", self.drive, fine),
        ):
            for name, values in channels.items():
                if values.shape != (length,) or not np.all(np.isfinite(values)):
                    raise SignalError(
                        f"record {self.name}, {kind} {name}: expected {length} finite samples, found shape "
                        f"{values.shape} with {int(np.sum(~np.isfinite(values)))} that are not finite."
                    )
        if not self.used.any():
            raise SignalError(f"record {self.name}: expected samples that are used, found none among {self.samples}.")

    @property
    def samples(self) -> int:
        """Number of samples of the grid, used or not."""
        return self.used.size

    @property
    def margin(self) -> int:
        """Samples of the drive before the first sample of the record, and after the last."""
        return self.decimator.half

    @property
    def time_s(self) -> FloatArray:
        """Time of each sample, in seconds of the recording, shape (samples,)."""
        return self.start_s + np.arange(self.samples) / self.rate_hz

    @property
    def drive_rate_hz(self) -> float:
        """Samples a second of the drive [Hz]."""
        return self.rate_hz * self.every

    @property
    def drive_time_s(self) -> FloatArray:
        """Time of each sample of the drive since its first [s], shape (samples of the drive,)."""
        return np.arange(next(iter(self.drive.values())).size) / self.drive_rate_hz

    @property
    def stretches(self) -> tuple[slice, ...]:
        """Uninterrupted stretches of used samples, in order of time."""
        return tuple(slice(*run) for run in runs_of(self.used))


def record_from_arrays(
    name: str,
    inputs: Mapping[str, ArrayLike],
    outputs: Mapping[str, ArrayLike],
    *,
    rate_hz: float,
    used: ArrayLike | None = None,
    start_s: float = 0.0,
    hold: bool = False,
) -> Record:
    """Return a record of normalised deviations from plain arrays; the inputs themselves drive the model.

    Parameters
    ----------
    inputs, outputs
        Deviations by name [-], each of shape (samples,).
    rate_hz
        Sample rate of all [Hz].
    used
        Which samples count, shape (samples,); all of those whose outputs are finite if not given.
    hold
        Whether inputs hold between samples; else they go straight from one to the next.

    Raises
    ------
    SignalError
        If lengths differ, an input or a used output is not finite, or no sample is used.
    """
    rows = {key: np.asarray(values, dtype=np.float64) for key, values in outputs.items()}
    if len({row.shape for row in rows.values()}) > 1:
        raise SignalError(
            f"record {name}: expected outputs of one length, found {[row.size for row in rows.values()]}."
        )
    finite = np.all([np.isfinite(row) for row in rows.values()], axis=0)
    counted = finite if used is None else np.asarray(used, dtype=np.bool_)
    if counted.shape != finite.shape or not np.all(finite[counted]):
        raise SignalError(
            f"record {name}: expected a mark for each of {finite.size} samples, and finite outputs where it is true, "
            f"found shape {counted.shape} and {int(np.sum(~finite))} samples that are not finite."
        )
    finite_rows = {key: np.where(finite, row, 0.0) for key, row in rows.items()}
    driven = {key: frozen_float(values) for key, values in inputs.items()}
    return Record(
        name=name,
        rate_hz=rate_hz,
        start_s=start_s,
        inputs=driven,
        outputs={key: frozen_float(values) for key, values in finite_rows.items()},
        used=frozen_bool(counted),
        drive=driven,
        hold=hold,
    )
