"""What is known of a line before any test: the priors of the gauge-aware structures.

A test of set point, speed and shaft torque finds ``v K_p / tau``, ``v K_i / tau`` and ``(k_q - g) / tau`` with
``tau = tau_up + tau_dn``, but neither ``tau_up`` nor ``g`` alone. The torsional vibration calculation (TVC) knows the
inertia upstream of the gauge to a few percent, and brake torque over speed at constant rack is nearly flat in the
middle of the range.
"""

from typing import TYPE_CHECKING

import numpy as np

from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models import Structure

if TYPE_CHECKING:
    from shaftprint.signals import Mode, WorkingPoint
    from shaftprint.vessel import Vessel

PRIOR_OF_G = Prior(mean=0.0, std=0.1)
"""Slope of the engine torque with speed, before any test: flat to a tenth."""


def priors_from_vessel(
    structure: Structure, vessel: "Vessel", working_point: "WorkingPoint", *, mode: "Mode" = "shaftprint"
) -> dict[str, Prior]:
    """Return what is known of a structure's ``g``, ``tau_up``, ``t_sp``, ``t_gauge``, ``t_rack``, those that are free.

    The inertia time is ``tau_up = 2 pi I_up n_s0 / M_s0`` (thesis eq. 2.23). Its standard deviation holds that of
    the TVC and of the gauge's scale: a gauge that shows too much makes it too small. The error of the working point is
    not in it, because ``M_s0`` is the number by which the responses are divided, whatever the load was; it comes to all
    that is found over that number alike, after the fit.

    Parameters
    ----------
    structure
        Its free parameters are asked for.
    vessel, working_point
        What was tested, and where.
    mode
        How the signals were prepared: in thesis mode the whole latency of the torque is still in them.
    """
    names = {parameter.name for parameter in structure.free}
    gauge = vessel.sensors.shaft_torque
    found = {"g": PRIOR_OF_G} if "g" in names and "tau_up" in names else {}
    if "tau_up" in names and vessel.inertia_upstream_std_kg_m2 > 0.0:
        inertia, torque = vessel.inertia_upstream_kg_m2, working_point.shaft_torque_nm
        shaft_rev_s = working_point.engine_speed_rev_s / vessel.gearbox.ratio
        tau = 2.0 * np.pi * inertia * shaft_rev_s / torque
        sources = {
            "TVC": tau * vessel.inertia_upstream_std_kg_m2 / inertia,
            "gauge scale": -tau * gauge.scale_std,
        }
        sources = {name: float(part) for name, part in sources.items() if part}
        found["tau_up"] = Prior(mean=float(tau), std=float(np.linalg.norm(list(sources.values()))), sources=sources)
    if "t_gauge" in names and gauge.latency_std > 0.0:
        found["t_gauge"] = Prior(
            mean=gauge.latency_s if mode == "thesis" else 0.0,
            std=gauge.latency_std,
            sources={"telemetry latency": gauge.latency_std},
        )
    set_point = vessel.sensors.set_point
    if "t_sp" in names and set_point.latency_s is not None and set_point.latency_std_s is not None:
        found["t_sp"] = Prior(
            mean=set_point.latency_s,
            std=set_point.latency_std_s,
            sources={"set-point latency": set_point.latency_std_s},
        )
    rack = vessel.sensors.rack
    if "t_rack" in names and rack is not None and rack.latency_std_s:
        found["t_rack"] = Prior(
            mean=rack.latency_s if mode == "thesis" else 0.0,
            std=rack.latency_std_s,
            sources={"rack latency": rack.latency_std_s},
        )
    return found
