"""The peer of row 2: raw channels to 200 Hz signals as one writes it in an afternoon, in memory, with pandas and SciPy.

Edges where the volts cross the middle, speed from the time between them, previous neighbour on the grid, a rolling
median and a rolling median deviation against outliers, ``scipy.signal.decimate`` for torque and set point.
"""

import sys
from pathlib import Path

import h5py
import numpy as np
import pandas as pd
from scipy.interpolate import interp1d
from scipy.signal import decimate

from shaftprint.arrays import FloatArray

GEAR_RATIO = 3.82
PULSES = {"PTM_e": (1, 1.0), "PTM_1": (1, GEAR_RATIO), "PTM_4": (4, GEAR_RATIO)}
NM_PER_V = 500.0
RATE_HZ = 2000.0
GRID_HZ = 200.0
WINDOW = 21
LIMIT_MAD = 3.0


def read(path: Path) -> pd.DataFrame:
    """Return all channels in volts."""
    with h5py.File(path) as file:
        channels = file["channels"]
        names = ["U_setpoint", *PULSES, "M_s"]
        return pd.DataFrame(
            {n: channels[n][:] * channels[n].attrs["scale_factor"] + channels[n].attrs["add_offset"] for n in names}
        )


def engine_speed(volts: FloatArray, pulses: int, ratio: float, grid_s: FloatArray) -> FloatArray:
    """Return engine speed [rev/s] on the grid."""
    high = volts > 0.5 * (volts.min() + volts.max())
    edge_s = (np.flatnonzero(np.diff(high.astype(int)) == 1) + 1) / RATE_HZ
    speed = ratio / (pulses * np.diff(edge_s))
    holder = interp1d(edge_s[1:], speed, kind="previous", bounds_error=False, fill_value=(speed[0], speed[-1]))
    return np.asarray(holder(grid_s))


def without_outliers(values: pd.Series) -> pd.Series:
    """Return the values with outliers replaced by the rolling median."""
    median = values.rolling(WINDOW, center=True, min_periods=1).median()
    deviation = (values - median).abs()
    spread = 1.4826 * deviation.rolling(WINDOW, center=True, min_periods=1).median()
    return values.where(deviation <= LIMIT_MAD * spread, median)


def main(path: Path) -> pd.DataFrame:
    """Return set point, torque and speeds at 200 Hz."""
    raw = read(path)
    factor = int(RATE_HZ / GRID_HZ)
    grid_s = np.arange(0, len(raw), factor) / RATE_HZ
    found = {
        "set_point_v": decimate(without_outliers(raw["U_setpoint"]).to_numpy(), factor, ftype="fir"),
        "torque_nm": decimate(without_outliers(raw["M_s"]).to_numpy(), factor, ftype="fir") * NM_PER_V,
    }
    for name, (pulses, ratio) in PULSES.items():
        found[name] = engine_speed(raw[name].to_numpy(), pulses, ratio, grid_s)
    return pd.DataFrame(found, index=grid_s)


if __name__ == "__main__":
    signals = main(Path(sys.argv[1]))
    print(len(signals), signals.mean().round(3).to_dict())
