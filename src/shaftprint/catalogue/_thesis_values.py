"""The parameter sets that chapter 5.6 of the thesis holds against the short chirp and the steps.

Values of thesis tables 5.2 and 5.3 and of the benchmark, with the lag ``2 zeta omega_n s`` with which they are stable.
OL1+OL4 and OL1+OL5 are open-loop fits put into the closed loops of CL3 and CL4.
"""

from collections.abc import Mapping

THESIS_VALUES: Mapping[str, tuple[str, Mapping[str, float]]] = {
    "CL4": ("CL4", {"tau_n": 0.3290, "K_p": 1.6004, "K_i": 4.4388, "t_d": 0.1161, "omega_n": 9.7705, "zeta": 0.4}),
    "OL1+OL5": ("CL4", {"tau_n": 0.3897, "K_p": 4.36, "K_i": 4.2664, "t_d": 0.1023, "omega_n": 8.202, "zeta": 0.88}),
    "CL3": ("CL3", {"tau_n": 0.3537, "K_p": 1.1833, "K_i": 5.3967, "omega_n": 7.2133, "zeta": 0.4}),
    "OL1+OL4": ("CL3", {"tau_n": 0.3897, "K_p": 2.902, "K_i": 4.2699, "omega_n": 8.2912, "zeta": 0.5616}),
    "benchmark": ("BENCHMARK", {"tau_n": 0.275, "K_p": 0.01, "K_i": 10.0, "g": -0.314, "v": 1.0}),
}
"""Name of each set, the structure that it belongs to and its values."""
