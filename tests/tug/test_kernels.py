"""What is compiled does what its Python says: the same voyage with and without the compiler."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

# Steps far enough to hit every limit, faults often enough to meet each kind, inflow, a rate limit and a ship underway.
VOYAGES = """
from dataclasses import replace
import sys
import numpy as np
from shaftprint.campaign import Campaign
from shaftprint.recording import read_recording
from shaftprint.tug import Noise, Sailing, Tug, sail
from tests.tug.ideal_signals import simulate_signals
from shaftprint.vessel import load_vessel

folder = sys.argv[1]
vessel = load_vessel("stan-tug-1205")
busy = replace(
    Noise(),
    missing_pulse_interval_s=0.5,
    doubled_pulse_interval_s=0.5,
    torque_spike_interval_s=0.5,
    torque_dropout_interval_s=0.5,
)


def steps(duration_s, levels, dwell_s):
    stairs = {"name": "St", "levels_v": levels, "dwell_s": dwell_s, "start_s": 0.0}
    return Campaign.model_validate(
        {"name": "short", "duration_s": duration_s, "offset_v": -5.0, "staircases": [stairs]}
    )


tugs = {
    "plain": Tug(),
    "no_delay": Tug(governor_delay_s=0.0),
    "inflow": Tug(inflow_gain=1.0, inflow_time_s=0.1),
    "limited": Tug(
        demand_rate_limit_rpm_per_s=2000.0, rack_rate_limit_per_s=2.0, unboosted_torque_share=0.6,
        governor_deadband_rpm=5.0,
    ),
    "underway": Tug(sailing=Sailing()),
    "scheduled": Tug(governor_gain_exponent=0.5, governor_delay_exponent=-1.0, generator_cycle_s=0.01),
}
arrays = {}
for name, tug in tugs.items():
    signals = simulate_signals(vessel, steps(1.4, [-2.8, -7.2, -0.9], 0.4), tug=tug, seed=1, rate_hz=2000.0)
    for field in ("engine_speed_rev_s", "shaft_torque_nm", "brake_torque_nm", "rack_given", "limited"):
        arrays[f"{name}.{field}"] = getattr(signals, field)
truth = sail(vessel, steps(7.0, [-5.0], 7.0), f"{folder}/log.nc", tug=Tug(noise=busy), seed=4)
arrays["faults"] = np.array([fault.time_s for fault in truth.faults])
with read_recording(f"{folder}/log.nc") as recording:
    for name, channel in recording.channels.items():
        arrays[f"log.{name}"] = channel.values(0, channel.count)
np.savez(f"{folder}/arrays.npz", **arrays)
"""


def sailed(folder: Path, *, compiled: bool) -> dict[str, np.ndarray]:
    folder.mkdir()
    environment = {name: value for name, value in os.environ.items() if not name.startswith("COV")}
    subprocess.run(
        [sys.executable, "-c", VOYAGES, str(folder)],
        env=environment | {"NUMBA_DISABLE_JIT": "0" if compiled else "1"},
        check=True,
    )
    with np.load(folder / "arrays.npz") as arrays:
        return dict(arrays)


@pytest.mark.slow
def test_compiled_and_plain_kernels_agree(tmp_path: Path) -> None:
    compiled, plain = (sailed(tmp_path / str(way), compiled=way) for way in (True, False))
    assert compiled.keys() == plain.keys()
    assert np.array_equal(compiled.pop("faults"), plain["faults"])
    assert plain["faults"].size > 8
    for name, values in compiled.items():
        if name.endswith(".limited"):
            assert np.array_equal(values, plain[name]), name
        elif name.startswith("log."):
            # one count, where a value lies on the edge between two
            assert values == pytest.approx(plain[name], abs=0.006), name
        else:
            assert values == pytest.approx(plain[name], rel=1e-9, abs=1e-9), name
    assert any(values.any() for name, values in compiled.items() if name.endswith(".limited"))
