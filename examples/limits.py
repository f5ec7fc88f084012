"""Steps that ask for more torque than the engine has: the linear model and the one with limits, side by side.

The simulated Stan Tug 1205 runs at 1183.8 rpm and is asked for 676 rpm, and ten seconds later for 1183.8 rpm again. For
small signals both models are the same. At large, the linear one takes torque that is not there and brakes with torque
that no engine has; the other one accelerates and brakes as fast as the full-load curve and the rack allow.
"""

from pathlib import Path

import numpy as np

from shaftprint.catalogue import limited, structure
from shaftprint.forecast import SimulatedSignal
from shaftprint.report import save_chart, simulation_chart
from shaftprint.simulation import simulate

SPEED_RPM, TORQUE_NM, BRAKE_NM = 1183.8, 1725.0, 465.54

# ---- what both models know, and what only one of them does ----

LINE = {"tau_up": 1.016, "tau_dn": 0.32, "k_q": 2.0, "g": 0.0, "t_gauge": 0.0, "c_set": 1.0}
GOVERNOR = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "t_sp": 0.0518}
LIMITS = {"m_max": 1325.0 / BRAKE_NM, "m_min": -0.3, "T_aw": 0.5, "r_x": 10.0}

# Full-load torque over that at the working point: 1038, 1325, 1289 and 1172 N m at 819, 1184, 1636 and 1800 rpm.
corners_rpm_nm = ((819.0, 1038.0), (SPEED_RPM, 1325.0), (1636.2, 1289.0), (1800.0, 1172.0))
curve = tuple((rpm / SPEED_RPM - 1.0, torque / 1325.0) for rpm, torque in corners_rpm_nm)

linear = structure("GAUGE-CLOSED")
ship = limited("torque", "rate", curve=curve)
sets = {linear.name: (linear, LINE | GOVERNOR), ship.name: (ship, LINE | GOVERNOR | LIMITS)}

# ---- two steps ----

time_s = np.arange(0.0, 20.0, 0.005)
set_point = np.where((time_s >= 1.0) & (time_s < 11.0), 676.6 / SPEED_RPM - 1.0, 0.0)
traces = {
    name: simulate(model, model.vector(values), time_s, {"n_set": set_point}, hold=True)
    for name, (model, values) in sets.items()
}

# ---- numbers and a picture ----

numbers = {}
for name, trace in traces.items():
    speed_rpm = SPEED_RPM * (1.0 + trace.outputs["n"])
    torque_nm = TORQUE_NM * (1.0 + trace.outputs["M_s"])
    rising = time_s >= 11.0
    share = (speed_rpm[rising] - 676.6) / (SPEED_RPM - 676.6)
    rise_s = time_s[rising][share >= 0.9][0] - time_s[rising][share >= 0.1][0]
    numbers[name] = {
        "lowest speed": speed_rpm.min(),
        "overshoot": 100.0 * (share.max() - 1.0),
        "rise time": rise_s,
        "lowest torque": torque_nm.min(),
        "highest torque": torque_nm.max(),
    }
units = {"lowest speed": "rpm", "overshoot": "%", "rise time": "s", "lowest torque": "N m", "highest torque": "N m"}
print(f"{'':16}" + "".join(f"{name:>20}" for name in numbers))
for number, unit in units.items():
    print(f"{number:16}" + "".join(f"{values[number]:20.4g}" for values in numbers.values()) + f"  {unit}")


def signals(trace):
    """Return set point, speed and torque with units."""
    return (
        SimulatedSignal(title="set point", unit="rpm", values=SPEED_RPM * (1.0 + set_point), is_input=True),
        SimulatedSignal(title="engine speed", unit="rpm", values=SPEED_RPM * (1.0 + trace.outputs["n"])),
        SimulatedSignal(title="shaft torque", unit="N m", values=TORQUE_NM * (1.0 + trace.outputs["M_s"])),
    )


figure = simulation_chart(
    time_s, signals(traces[ship.name]), name=ship.name, beside={linear.name: signals(traces[linear.name])}
)
save_chart(figure, Path("limits.svg"))
