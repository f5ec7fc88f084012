"""The propeller's load in a record: how it carries noise from speed to torque, and how it moves.

A propeller at the quay takes ``M_p = l(t) (1 + n)^2``, with a load ``l`` that inflow and depth change over minutes.
Two things follow that no noise of one colour describes. Noise ``d`` of the speed is noise ``2 l (1 + n) d`` of the
torque: twice as much at full speed as at half of it. And a load that rises by a share is more torque the more the
speed moves, in step with it. Where speed and torque share nearly all of their noise, as they do behind an engine that
hunts, both look like other inertias and delays: the time constant ``tau_dn`` of a chirp of ten minutes was off by five
of its standard deviations, ``k_q`` by eight, ``t_gauge`` by six (scatter over six simulated recordings, load moving by
1.4 %); as below all are within one.

So the torque is compared without ``l n^2``, of data and model alike, which leaves noise of one colour; and the pattern
``(1 + n)^2`` of the measured speed, times a piecewise linear function of time, is projected out of it as drifts are.

With the load goes what the torque tells of its slope ``k_q``. What the speed still tells of it is little and wrong, for
the pattern is that of a measured speed: records whose ``k_q`` is 2 gave 1.61 +/- 0.01 and 2.43 +/- 0.12. Something else
has to tell of it, or it is held.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.time_domain._record import Record

# Time from one corner of the load to the next [s]: inflow moves over minutes, steps over seconds.
CORNER_S = 40.0
SPEED, TORQUE = "n", "M_s"


def load_columns(record: Record, outputs: tuple[str, ...]) -> FloatArray:
    """Return what a load that moves slowly adds to the outputs, shape (columns, samples, outputs).

    Nothing for records shorter than two corners: their one load is that of the record.
    """
    time = record.time_s - record.start_s
    pieces = round(float(time[-1]) / CORNER_S)
    if pieces < 2:
        return np.zeros((0, record.samples, len(outputs)))
    corners = np.linspace(0.0, float(time[-1]), pieces + 1)
    columns = np.zeros((pieces + 1, record.samples, len(outputs)))
    square = (1.0 + record.outputs[SPEED]) ** 2
    for number, corner in enumerate(np.eye(pieces + 1)):
        columns[number, :, outputs.index(TORQUE)] = np.interp(time, corners, corner) * square
    return columns


def without_quadratic_torque(simulated: FloatArray, outputs: tuple[str, ...], load: float) -> FloatArray:
    """Return outputs and derivatives with the torque less ``load n^2``, shape (1 + wanted, samples, outputs)."""
    speed, torque = outputs.index(SPEED), outputs.index(TORQUE)
    linear = simulated.copy()
    linear[0, :, torque] -= load * simulated[0, :, speed] ** 2
    linear[1:, :, torque] -= 2.0 * load * simulated[0, :, speed] * simulated[1:, :, speed]
    return linear


def with_quadratic_torque(values: FloatArray, outputs: tuple[str, ...], load: float) -> FloatArray:
    """Return outputs with the torque that ``without_quadratic_torque`` took off, shape (samples, outputs)."""
    squared = values.copy()
    squared[:, outputs.index(TORQUE)] += load * values[:, outputs.index(SPEED)] ** 2
    return squared
