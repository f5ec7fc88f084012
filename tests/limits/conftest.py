from collections.abc import Callable, Mapping

import numpy as np
import pytest

from shaftprint.arrays import FloatArray, frozen_bool, frozen_float
from shaftprint.limits.prediction._set_point import GovernorRecord
from shaftprint.time_domain._decimator import Decimator
from shaftprint.vessel import load_vessel

EVERY, RATE_HZ = 8, 100.0


@pytest.fixture(scope="session")
def vessel():
    return load_vessel("stan-tug-1205")


def made_record(rows: int, drive_at: Callable[[FloatArray], Mapping[str, FloatArray]]) -> GovernorRecord:
    """Return a record of so many rows whose inputs are given as functions of time; its output is nothing."""
    decimator = Decimator(every=EVERY)
    time = np.arange((rows - 1) * EVERY + 1 + 2 * decimator.half) / RATE_HZ
    drive = drive_at(time)
    return GovernorRecord(
        name="made",
        rate_hz=RATE_HZ / EVERY,
        start_s=0.0,
        inputs={name: frozen_float(decimator.filtered(values)) for name, values in drive.items()},
        outputs={"y": frozen_float(np.zeros(rows))},
        used=frozen_bool(np.ones(rows, dtype=bool)),
        drive={name: frozen_float(values) for name, values in drive.items()},
        every=EVERY,
        corner_time_s=frozen_float(time),
        corner_value=frozen_float(drive["n_set"]),
    )
