"""Row 4: a nonlinear closed loop with limits and a delay, 300,000 steps, beside ``scipy.integrate.solve_ivp``.

Governor with back-calculation, limits of torque and rack rate, delay, second-order lag, quadratic propeller. The peer
is what an engineer writes without the package: the same equations in a Python function with a fifth-order Pade
approximation of the delay, ``np.interp`` for the set point and ``solve_ivp`` with RK45. Its tolerance is the loosest
power of ten at which it is no less accurate than ours; both are held against the simulation with an eighth of the step.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from scipy.integrate import solve_ivp

from benchmarks.timing import Spread, cpu_seconds, print_table
from shaftprint.arrays import FloatArray
from shaftprint.models import Diagram, Parameter, Structure, clip, limited_pi, quadratic_propeller, second_order_lag
from shaftprint.models.equations._flow import Flow
from shaftprint.models.equations._formula import Formula
from shaftprint.simulation import simulate

SAMPLES, RATE_HZ = 300_000, 200.0
TRUTH = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.0703, "omega_n": 10.3, "zeta": 0.47, "tau": 1.336, "m_max": 2.2, "r_x": 6.0}
T_AW, M_MIN, FOLLOW = 0.5, -0.6, 100.0
PADE_5 = (30240.0, 15120.0, 3360.0, 420.0, 30.0, 1.0)


def loop() -> Structure:
    """Return the closed loop with its eight parameters."""
    bounds = {
        "K_p": 20.0,
        "K_i": 20.0,
        "t_d": 0.5,
        "omega_n": 60.0,
        "zeta": 4.0,
        "tau": 5.0,
        "m_max": 6.0,
        "r_x": 100.0,
    }
    parameters = tuple(Parameter(name, "-", 0.0, bounds[name], value, name) for name, value in TRUTH.items())
    diagram = Diagram("limited loop", "n_set", ("n", "M_b"), equations, parameters)
    return Structure(name="LIMITED", title="limited loop", input="n_set", outputs=dict(diagram.ports()))


def equations(flow: Flow, n_set: Formula, p: Any) -> Mapping[str, Formula]:
    """Return speed and brake torque."""
    speed = flow.state("n")
    governed = limited_pi(
        flow,
        n_set - speed,
        proportional=p.K_p,
        integral=p.K_i,
        lowest=M_MIN - 1.0,
        highest=p.m_max - 1.0,
        anti_windup_s=T_AW,
    )
    rack = flow.state("rack")
    flow.rate(rack, clip(FOLLOW * (governed.given - rack), -p.r_x, p.r_x))
    asked = second_order_lag(flow, flow.delayed(rack, p.t_d), p.omega_n, p.zeta)
    torque = clip(asked, M_MIN - 1.0, p.m_max - 1.0)
    flow.rate(speed, (torque - quadratic_propeller(speed, 2.0)) / p.tau)
    return {"n": speed, "M_b": torque}


def peer(time: FloatArray, u: FloatArray, tolerance: float) -> FloatArray:
    """Return speed and brake torque by ``solve_ivp``, shape (2, samples)."""
    k_p, k_i, t_d, omega, zeta, tau, m_max, r_x = TRUTH.values()
    bottom = np.array(PADE_5[::-1]) * t_d ** np.arange(5, -1, -1)
    top = bottom * (-1.0) ** np.arange(5, -1, -1)
    direct = top[0] / bottom[0]
    b = (top[1:] - direct * bottom[1:]) / bottom[0]
    a = bottom[1:] / bottom[0]

    def rates(t: float, x: FloatArray) -> list[float]:
        speed, integral, rack, lag, lag_rate = x[:5]
        error = np.interp(t, time, u) - speed
        wanted = k_p * error + integral
        given = min(max(wanted, M_MIN - 1.0), m_max - 1.0)
        # observable canonical form of the Pade approximation
        late = x[5] + direct * rack
        torque = min(max(lag, M_MIN - 1.0), m_max - 1.0)
        turned = 1.0 + speed
        delay = [b[i] * rack - a[i] * x[5] + (x[6 + i] if i < 4 else 0.0) for i in range(5)]
        late_rack = late
        return [
            (torque - (turned * abs(turned) - 1.0)) / tau,
            k_i * error + (given - wanted) / T_AW,
            min(max(FOLLOW * (given - rack), -r_x), r_x),
            lag_rate,
            omega * (omega * (late_rack - lag) - 2.0 * zeta * lag_rate),
            *delay,
        ]

    found = solve_ivp(rates, (time[0], time[-1]), np.zeros(10), "RK45", time, rtol=tolerance, atol=1e-3 * tolerance)
    return np.stack([found.y[0], np.clip(found.y[3], M_MIN - 1.0, m_max - 1.0)])


@dataclass(slots=True)
class Times:
    """CPU seconds, one value a repetition."""

    peer: list[float] = field(default_factory=list)
    """One simulation by ``solve_ivp``."""
    ours: list[float] = field(default_factory=list)
    """One simulation."""
    gradient: list[float] = field(default_factory=list)
    """Cost, gradient and ``J^T J`` of eight parameters."""
    fit: list[float] = field(default_factory=list)
    """A warm fit of eight parameters."""


def run(repetitions: int) -> None:
    """Measure row 4 and print it."""
    print("\n## Row 4: nonlinear closed loop with limits and delay, 300,000 steps")
    ship = loop()
    values = ship.vector(TRUTH)
    time = np.arange(SAMPLES) / RATE_HZ
    u = _set_point(time)
    fine = _outputs(ship, values, time, u, longest_step_s=1.0 / RATE_HZ / 8.0)
    ours = _outputs(ship, values, time, u)
    error = _relative(ours, fine)
    tolerance = _tolerance(time, u, fine, error)
    rng = np.random.default_rng(4)
    measured = fine + np.array([[0.002], [0.02]]) * rng.standard_normal(fine.shape)
    times = Times()
    for repetition in range(-1, repetitions):
        ours_s, _ = cpu_seconds(lambda: _outputs(ship, values, time, u))
        gradient_s, _ = cpu_seconds(lambda: _normal_equations(ship, values, time, u, measured))
        fit_s, found = cpu_seconds(lambda: _warm_fit(ship, values, time, u, measured))
        if repetition >= 0:
            times.ours.append(ours_s)
            times.gradient.append(gradient_s)
            times.fit.append(fit_s)
    for _ in range(max(1, repetitions // 3)):
        peer_s, simulated = cpu_seconds(lambda: peer(time, u, tolerance))
        times.peer.append(peer_s)
    _print(times, tolerance, (error, _relative(simulated, fine)), found, _complex_step(ship, values, time, u))


def _set_point(time: FloatArray) -> FloatArray:
    """Return a chirp, then steps that ask for more torque than there is."""
    chirp = 0.1 * np.sin(2.0 * np.pi * (0.01 * time + 0.5 * (2.0 - 0.01) / 750.0 * time**2))
    steps = 0.4 * ((time % 50.0) < 25.0)
    return np.where(time < 750.0, chirp, steps)


def _outputs(
    ship: Structure, values: FloatArray, time: FloatArray, u: FloatArray, longest_step_s: float = 1.0 / RATE_HZ
) -> FloatArray:
    found = simulate(ship, values, time, {"n_set": u}, longest_step_s=longest_step_s)
    return np.stack([found.outputs["n"], found.outputs["M_b"]])


def _relative(found: FloatArray, exact: FloatArray) -> FloatArray:
    """Return root mean square errors over the root mean squares."""
    return np.asarray(np.sqrt(np.mean((found - exact) ** 2, axis=1) / np.mean(exact**2, axis=1)))


def _tolerance(time: FloatArray, u: FloatArray, fine: FloatArray, error: FloatArray) -> float:
    """Return the loosest tolerance at which the peer is no less accurate on a fortieth of the record.

    What is left at a tight tolerance is the error of the Pade approximation, which no tolerance takes away.
    """
    part = slice(0, SAMPLES // 40)
    tight = _relative(peer(time[part], u[part], 1e-9), fine[:, part])
    for tolerance in (1e-3, 1e-4, 1e-5, 1e-6, 1e-7):
        found = _relative(peer(time[part], u[part], tolerance), fine[:, part])
        if np.all(found <= np.maximum(error, 2.0 * tight)):
            return tolerance
    return 1e-8


def _normal_equations(
    ship: Structure, values: FloatArray, time: FloatArray, u: FloatArray, measured: FloatArray
) -> tuple[float, FloatArray, FloatArray]:
    """Return cost, gradient and ``J^T J`` with white noise of 0.2 % and 2 %."""
    found = simulate(ship, values, time, {"n_set": u}, wanted=ship.names)
    cost, slope, square = 0.0, np.zeros(values.size), np.zeros((values.size, values.size))
    for row, (output, std) in enumerate((("n", 0.002), ("M_b", 0.02))):
        left = (measured[row] - found.outputs[output]) / std
        rows = found.derivatives[output] / std
        cost += 0.5 * float(left @ left)
        slope -= rows @ left
        square += rows @ rows.T
    return cost, slope, square


def _warm_fit(ship: Structure, values: FloatArray, time: FloatArray, u: FloatArray, measured: FloatArray) -> FloatArray:
    """Return the estimates of a Gauss-Newton fit that starts 5 % off."""
    at = values * 1.05
    cost, slope, square = _normal_equations(ship, at, time, u, measured)
    for _ in range(30):
        tried = at - np.linalg.solve(square, slope)
        new = _normal_equations(ship, tried, time, u, measured)
        if not new[0] < cost * (1.0 - 1e-9):
            break
        at, (cost, slope, square) = tried, new
    return at


def _complex_step(ship: Structure, values: FloatArray, time: FloatArray, u: FloatArray) -> float:
    """Return the largest difference between the derivatives and those of a complex step, over the largest."""
    part = slice(SAMPLES // 2, SAMPLES // 2 + 20_000)
    found = simulate(ship, values, time[part], {"n_set": u[part]}, wanted=ship.names)
    worst = 0.0
    for place in range(values.size):
        moved = values.astype(np.complex128)
        moved[place] += 1e-30j
        stepped = simulate(ship, moved, time[part], {"n_set": u[part]})
        for output in ("n", "M_b"):
            exact = np.imag(stepped.outputs[output]) / 1e-30
            worst = max(worst, float(np.abs(found.derivatives[output][place] - exact).max() / np.abs(exact).max()))
    return worst


def _print(
    times: Times, tolerance: float, errors: tuple[FloatArray, FloatArray], found: FloatArray, complex_step: float
) -> None:
    peer_s, ours, gradient, fit = (Spread(tuple(part)) for part in (times.peer, times.ours, times.gradient, times.fit))
    rows = [
        (f"solve_ivp RK45, fifth-order Pade, rtol {tolerance:g}", peer_s.text(1e3, 0), ""),
        ("one simulation, exact delay", ours.text(1e3, 1), f"{peer_s.median / ours.median:.0f}"),
        (
            "cost, gradient and J'J of 8 parameters",
            gradient.text(1e3, 1),
            f"{gradient.median / ours.median:.1f} of ours",
        ),
        ("warm fit of 8 parameters, from 5 % off", fit.text(1e3, 0), ""),
    ]
    print_table("CPU time, median [min..max], and the ratio to one simulation", ("what", "CPU, ms", "ratio"), rows)
    rows = [
        (name, f"{error[0]:.1e}", f"{error[1]:.1e}") for name, error in (("ours", errors[0]), ("solve_ivp", errors[1]))
    ]
    print_table("Errors over an eighth of the step, root mean square", ("simulation", "n", "M_b"), rows)
    rows = [
        (name, f"{100.0 * (value / truth - 1.0):+.3f}")
        for (name, truth), value in zip(TRUTH.items(), found, strict=True)
    ]
    print_table("Warm fit with noise of 0.2 % and 2 %", ("parameter", "error, %"), rows)
    print(f"\nDerivatives against a complex step: {complex_step:.0e} of the largest")
