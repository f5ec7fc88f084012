"""What a fit has reached after each step, in a file: one that was stopped goes on from there, bit for bit."""

import hashlib
import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

import shaftprint
from shaftprint.arrays import BoolArray, FloatArray, frozen_bool, frozen_float
from shaftprint.errors import ServiceError
from shaftprint.files import write_bytes
from shaftprint.recording._recording import sha256_of
from shaftprint.service._model import ServiceModel
from shaftprint.service._segment_file import channel_file
from shaftprint.time_domain._noise_model import NoiseModel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class Reached:
    """Where a fit is after a step."""

    theta: FloatArray
    """Values of the free parameters, shape (free,)."""
    counts: BoolArray
    """Which segments count, shape (segments,)."""
    noise: NoiseModel
    """The noise by which they are compared."""
    steps: int
    """Steps that were taken."""
    size: float
    """Size of the last one, over the standard deviation in its direction."""
    is_last: bool
    """Whether the fit has come to rest."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Progress:
    """A file that says what a fit has reached, of the same segments from the same values only."""

    path: Path
    """The file."""
    key: str
    """What is fitted, as a hash."""
    free: int
    """How many parameters are."""

    def reached(self, segments: int) -> Reached | None:
        """Return what the file holds; None where there is none, or it is of other segments, values or versions."""
        try:
            told = json.loads(self.path.read_text(encoding="utf-8"))
            if told["key"] != self.key:
                return None
            reached = Reached(
                theta=frozen_float(np.array(told["theta"])),
                counts=frozen_bool(np.array(told["counts"], dtype=np.bool_)),
                noise=NoiseModel(
                    coefficients=frozen_float(np.array(told["coefficients"]).reshape(-1, 2, 2)),
                    covariance=frozen_float(np.array(told["covariance"])),
                ),
                steps=int(told["steps"]),
                size=float(told["size"]),
                is_last=bool(told["is_last"]),
            )
        except (OSError, ValueError, TypeError, KeyError, OverflowError, RecursionError):
            return None
        fits = reached.theta.shape == (self.free,) and reached.counts.shape == (segments,)
        return reached if fits and reached.noise.covariance.shape == (2, 2) else None

    def keep(self, reached: Reached) -> None:
        """Write what was reached, whole or not at all; numbers come back as they are.

        Raises ServiceError if it cannot be written.
        """
        told = {
            "key": self.key,
            "theta": reached.theta.tolist(),
            "counts": reached.counts.tolist(),
            "coefficients": reached.noise.coefficients.tolist(),
            "covariance": reached.noise.covariance.tolist(),
            "steps": reached.steps,
            "size": reached.size,
            "is_last": reached.is_last,
        }
        write_bytes(self.path, json.dumps(told).encode(), noun="progress of the fit", error=ServiceError)


def progress_of(path: Path, tables: Sequence[Path], model: ServiceModel) -> Progress:
    """Return the progress of a fit of some tables of segments from the values of a model.

    Raises ServiceError if a table cannot be read.
    """
    hashed = hashlib.sha256(shaftprint.__version__.encode())
    try:
        for table in tables:
            for file in (table, channel_file(table)):
                hashed.update(sha256_of(file).encode())
    except OSError as error:
        raise ServiceError(f"{error.filename}: expected segments of shaftprint service scan, found none.") from None
    facts = [dict(model.values), dict(model.known), dict(model.prior_std), model.engine_speed_rev_s]
    hashed.update(json.dumps([*facts, model.shaft_torque_nm], sort_keys=True).encode())
    return Progress(path=path, key=hashed.hexdigest(), free=len(model.free))
