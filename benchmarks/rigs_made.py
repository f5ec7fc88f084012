"""The twins, one function each, from a source of random numbers to records and a drive file."""

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.random import Generator

from benchmarks.rig_truths import DriveText, Twin, binary, levels, rubbed, smooth, stepped, timed, transfer

TWO_PI = 2.0 * np.pi


def _moves(samples: int, every: int, places: list[float]) -> np.ndarray:
    """Return a reference that goes from place to place by smooth steps."""
    share = 0.5 - 0.5 * np.cos(np.pi * np.clip(np.arange(every) / (0.6 * every), 0.0, 1.0))
    parts = [before + (after - before) * share for before, after in zip([0.0, *places], places, strict=False)]
    return np.concatenate(parts)[:samples]


def axis_from_force(rng: Generator) -> Twin:
    """Return a linear axis moved by its controller, identified from its force."""
    truth = {"M": 95.1, "F_v": 203.5, "F_c": 20.4, "F_0": -3.2}
    interval = 0.005
    reference = _moves(2000, 250, [0.15, -0.05, 0.2, 0.0, -0.15, 0.1, 0.02, -0.1])
    force = _controlled(reference, interval, truth)
    motion = rubbed(force, interval, 200, truth["M"], truth["F_v"], truth["F_c"], truth["F_c"], truth["F_0"], 0.0, 0.0)
    text = DriveText(name="linear axis, force to place").signals("inputs", F="N").signals("outputs", x="m")
    text.block("F_o", "constant", value="F_0").block("drag", "gain", ["v"], gain="F_v")
    text.block("dry", "coulomb-friction", ["v"], size="F_c", yielding=2e-6, within=5e-4)
    text.block("v", "inertia", ["F", "F_o", "-drag", "-dry"], inertia="M").block("x", "integrator", ["v"])
    text.free(M=(1.0, 1000.0, 50.0), F_v=(0.0, 2000.0, 100.0), F_c=(0.0, 200.0, 10.0), F_0=(-50.0, 50.0, 0.0))
    text.row("start", name="v", value=0.0).fit(start="known", offset="none", inputs_hold=True)
    return text.made(
        truth, {"moves": timed(interval, F=force, x=motion[:, 0] + 1e-3 * rng.standard_normal(force.size))}
    )


def _controlled(reference: np.ndarray, interval: float, truth: Mapping[str, float]) -> np.ndarray:
    """Return the force by which a digital controller brings the axis along a reference, held from sample to sample."""
    force, place, speed = np.zeros(reference.size), 0.0, 0.0
    for k in range(reference.size):
        force[k] = np.round(2500.0 * (12.0 * (reference[k] - place) - speed), 3)
        for _ in range(50):
            step = interval / 50
            free = speed + step * (force[k] + truth["F_0"] - truth["F_v"] * speed) / truth["M"]
            most = step * truth["F_c"] / truth["M"]
            speed = np.sign(free) * max(abs(free) - most, 0.0)
            place += step * speed
    return force


def axis_in_its_loop(rng: Generator) -> Twin:
    """Return such an axis identified in its loop, whose gains are known: SERVO along a line."""
    truth = {"J": 95.1, "d": 203.5, "T_C": 20.4}
    interval, gains = 0.004, (14.0, 1800.0)
    reference = _moves(2000, 250, [0.15, -0.05, 0.2, 0.0, -0.15, 0.1, 0.02, -0.1])
    motion = rubbed(reference, interval, 200, truth["J"], truth["d"], truth["T_C"], truth["T_C"], 0.0, *gains)
    noisy = timed(
        interval,
        theta_set=reference,
        theta=motion[:, 0] + 5e-4 * rng.standard_normal(reference.size),
        T_m=motion[:, 2] + 20.0 * rng.standard_normal(reference.size),
    )
    text = DriveText(name="linear axis in its loop").signals("inputs", theta_set="m")
    text.signals("outputs", theta="m", T_m="N")
    for name, value in (("K_x", gains[0]), ("K_v", gains[1]), ("K_iv", 0.0), ("t_u", 0.0)):
        text.row("known", name=name, value=value)
    text.fit(inputs_hold=True)
    return text.made(truth, {"moves": noisy}, structure="SERVO")


def rotor_of_a_servo(rng: Generator) -> Twin:
    """Return a small servo motor, torque to speed, whose dry friction differs by the direction."""
    truth = {"J": 1.4e-4, "B": 9.0e-5, "T_f": 0.033, "T_b": 0.025}
    interval, files = 0.02, {}
    for number in range(4):
        torque = 0.08 * levels(rng, 400, 20)
        motion = rubbed(torque, interval, 400, truth["J"], truth["B"], truth["T_f"], truth["T_b"], 0.0, 0.0, 0.0)
        files[f"run_{number}"] = timed(interval, T=torque, w=motion[:, 1] + 5.0 * rng.standard_normal(torque.size))
    text = DriveText(name="servo motor, torque to speed").signals("inputs", T="N m").signals("outputs", w="rad/s")
    text.block("drag", "gain", ["w"], gain="B")
    text.block("dry", "coulomb-friction", ["w"], size="T_f", size_backward="T_b", yielding=0.002, within=5e-4)
    text.block("w", "inertia", ["T", "-drag", "-dry"], inertia="J")
    text.free(J=(1e-5, 1e-2, 3e-4), B=(1e-6, 1e-2, 3e-4), T_f=(0.0, 0.2, 0.01), T_b=(0.0, 0.2, 0.01))
    text.row("start", name="w", value=0.0).fit(start="known", offset="none", inputs_hold=True)
    return text.made(truth, files)


def shaft_behind_loggers(rng: Generator) -> Twin:
    """Return torque along a shaft from the torque of its propeller, in three tests whose two loggers began apart."""
    truth = {"K": 0.98, "w": TWO_PI * 22.3, "z": 0.09, "t(impulse)": 0.461, "t(step)": 0.664, "t(ice)": 0.300}
    interval, samples = 0.004, 1500
    time_s = interval * np.arange(samples)
    inputs = {
        "impulse": np.where((time_s > 1.0) & (time_s < 1.03), 12.0, 0.0),
        "step": np.where(time_s > 1.0, 5.0, 0.0),
        "ice": np.where(time_s > 0.5, np.abs(np.sin(TWO_PI * 4.3 * time_s)) + 6.0 * levels(rng, samples, 60), 0.0),
    }
    line = transfer([truth["K"] * truth["w"] ** 2], [1.0, 2.0 * truth["z"] * truth["w"], truth["w"] ** 2])
    files = {
        name: timed(
            interval,
            Q=torque,
            T_2=stepped(line, torque, interval, truth[f"t({name})"])[:, 0] + 0.1 * rng.standard_normal(samples),
        )
        for name, torque in inputs.items()
    }
    text = DriveText(name="shaft behind two loggers").signals("inputs", Q="N m").signals("outputs", T_2="N m")
    text.block("T", "second-order-lag", ["Q"], gain="K", frequency="w", damping="z")
    text.block("T_2", "delay", ["T"], time="t")
    text.free(K=(0.1, 10.0, 1.0), w=(60.0, 300.0, 120.0), z=(0.01, 1.0, 0.2), t=(0.0, 1.0, 0.45))
    text.row("per_record", name="t").fit(inputs_hold=True)
    return text.made(truth, files)


def motor_first_order(rng: Generator) -> Twin:
    """Return a laboratory motor as a first order with delay, in four records."""
    truth = {"K": 18.5, "T": 0.058, "t_d": 0.0145}
    interval, samples = 0.01, 400
    time_s = interval * np.arange(samples)
    inputs = {
        "step": np.where(time_s > 0.5, 6.0, 0.0),
        "ramp": np.clip(2.5 * (time_s - 0.4), 0.0, 7.0),
        "stair": np.floor(time_s / 0.5),
        "chirp": np.where(time_s > 0.2, 4.0 * np.sin(TWO_PI * (0.3 + 0.8 * time_s) * time_s), 0.0),
    }
    line = transfer([truth["K"]], [truth["T"], 1.0])
    files = {
        name: timed(
            interval, u=u, w=stepped(line, u, interval, truth["t_d"])[:, 0] + 0.8 * rng.standard_normal(samples)
        )
        for name, u in inputs.items()
    }
    text = DriveText(name="laboratory motor, first order").signals("inputs", u="V").signals("outputs", w="rad/s")
    text.block("lag", "first-order-lag", ["u"], gain="K", time="T").block("w", "delay", ["lag"], time="t_d")
    text.free(K=(1.0, 100.0, 10.0), T=(0.005, 1.0, 0.1), t_d=(0.0, 0.1, 0.01)).fit(inputs_hold=True)
    return text.made(truth, files)


def speed_without_sign(rng: Generator) -> Twin:
    """Return coupled drives: a belt whose speed is measured without its sign, from rest."""
    truth = {"k": 1.9, "T": 0.18, "w": 20.1, "z": 0.12}
    interval, samples = 0.02, 500
    inputs = {"binary": binary(rng, samples, 9), "uniform": 1.5 * levels(rng, samples, 6)}
    square = truth["w"] ** 2
    line = transfer(
        [truth["k"] * square], np.polymul([truth["T"], 1.0], [1.0, 2.0 * truth["z"] * truth["w"], square]).tolist()
    )
    files = {
        name: timed(interval, u=u, y=np.abs(stepped(line, u, interval)[:, 0]) + 0.02 * rng.standard_normal(samples))
        for name, u in inputs.items()
    }
    text = DriveText(name="coupled drives").signals("inputs", u="V").signals("outputs", y="V")
    text.block("motor", "first-order-lag", ["u"], gain="k", time="T")
    text.block("belt", "second-order-lag", ["motor"], frequency="w", damping="z").block("y", "abs", ["belt"])
    text.free(k=(0.1, 20.0, 1.0), T=(0.02, 2.0, 0.3), w=(5.0, 60.0, 15.0), z=(0.01, 1.0, 0.2))
    text.row("start", name="motor", value=0.0).fit(start="known", offset="none", inputs_hold=True)
    return text.made(truth, files)


def hardening_spring(rng: Generator) -> Twin:
    """Return an electronic oscillator with a cubic spring under noise."""
    truth = {"g": 1.9e5, "c": 42.6, "k": 1.91e5, "k_3": 7.5e5}
    interval, samples = 1.0 / 610.35, 1500
    force = np.asarray(0.15 * signal_noise(rng, samples))

    def rate(_: float, state: np.ndarray, u: float) -> list[float]:
        x, v = state
        return [v, truth["g"] * u - truth["c"] * v - truth["k"] * x - truth["k_3"] * x**3]

    motion = smooth(rate, [0.0, 0.0], force, interval)
    text = DriveText(name="cubic spring").signals("inputs", u="V").signals("outputs", x="V")
    text.block("drive", "gain", ["u"], gain="g").block("drag", "gain", ["v"], gain="c")
    text.block("spring", "gain", ["x"], gain="k").block("cube", "power", ["x"], exponent=3)
    text.block("hard", "gain", ["cube"], gain="k_3")
    text.block("v", "integrator", ["drive", "-drag", "-spring", "-hard"]).block("x", "integrator", ["v"])
    text.free(g=(1e4, 1e6, 1.5e5), c=(1.0, 1000.0, 60.0), k=(5e4, 1e6, 1.7e5), k_3=(0.0, 1e7, 3e5))
    text.row("start", name="x", value=0.0).fit(start="known", offset="none", inputs_hold=True)
    noisy = timed(interval, u=force, x=motion[:, 0] + 2e-3 * rng.standard_normal(samples))
    return text.made(truth, {"noise": noisy})


def signal_noise(rng: Generator, samples: int) -> np.ndarray:
    """Return noise without what lies above the resonance, of unit size, behind a first zero."""
    noise = np.convolve(rng.standard_normal(samples + 4), np.ones(5) / 5.0, mode="valid")
    noise[:5] = 0.0
    return np.asarray(noise / noise.std())


def heated_air(rng: Generator) -> Twin:
    """Return a hair dryer: two lags and the way of the air."""
    truth = {"K": 0.92, "T_1": 0.37, "T_2": 0.11, "t_d": 0.165}
    interval, samples = 0.08, 1000
    power = binary(rng, samples, 5)
    line = transfer([truth["K"]], np.polymul([truth["T_1"], 1.0], [truth["T_2"], 1.0]).tolist())
    air = stepped(line, power, interval, truth["t_d"])[:, 0] + 0.03 * rng.standard_normal(samples)
    text = DriveText(name="dryer").signals("inputs", u="V").signals("outputs", y="V")
    text.block("coil", "first-order-lag", ["u"], gain="K", time="T_1")
    text.block("sensor", "first-order-lag", ["coil"], time="T_2").block("y", "delay", ["sensor"], time="t_d")
    text.free(K=(0.1, 10.0, 1.0), T_1=(0.2, 2.0, 0.5), T_2=(0.01, 0.2, 0.05), t_d=(0.0, 0.5, 0.1)).fit(inputs_hold=True)
    return text.made(truth, {"binary": timed(interval, u=power, y=air)})


def turbine(rng: Generator) -> Twin:
    """Return three masses of a wind turbine: from the generator's torque to the speeds of generator and rotor."""
    truth = {"J_1": 60.0, "J_2": 25.0, "J_3": 800.0, "k_1": 4.0e5, "k_2": 1.2e6, "c": 150.0, "d": 400.0}
    a = np.zeros((5, 5))  # speeds 1 to 3, twists 1 and 2
    a[3, :2], a[4, 1:3] = (1.0, -1.0), (1.0, -1.0)
    first = np.array([truth["c"], -truth["c"], 0.0, truth["k_1"], 0.0])
    second = np.array([0.0, truth["c"], -truth["c"], 0.0, truth["k_2"]])
    a[0], a[1] = -first / truth["J_1"], (first - second) / truth["J_2"]
    a[2] = (second - np.array([0.0, 0.0, truth["d"], 0.0, 0.0])) / truth["J_3"]
    b = np.array([[1.0 / truth["J_1"]], [0.0], [0.0], [0.0], [0.0]])
    c = np.eye(5)[[0, 2]]
    interval, samples = 0.002, 3000
    torque = 2000.0 * binary(rng, samples, 7)
    motion = stepped((a, b, c, np.zeros((2, 1))), torque, interval) + 0.01 * rng.standard_normal((samples, 2))
    text = DriveText(name="wind turbine, three masses").signals("inputs", T="N m")
    text.signals("outputs", w_1="rad/s", w_3="rad/s")
    text.block("S_1", "pi", ["w_1", "-w_2"], proportional="c", integral="k_1")
    text.block("S_2", "pi", ["w_2", "-w_3"], proportional="c", integral="k_2")
    text.block("w_1", "inertia", ["T", "-S_1"], inertia="J_1").block("w_2", "inertia", ["S_1", "-S_2"], inertia="J_2")
    text.block("drag", "gain", ["w_3"], gain="d").block("w_3", "inertia", ["S_2", "-drag"], inertia="J_3")
    text.free(J_1=(5.0, 500.0, 50.0), J_2=(2.0, 200.0, 20.0), J_3=(100.0, 5000.0, 1000.0), k_1=(5e4, 5e6, 5e5))
    text.free(k_2=(5e4, 1e7, 1e6), c=(0.0, 5000.0, 100.0), d=(0.0, 5000.0, 300.0))
    text.fit(inputs_hold=True)
    noisy = timed(interval, T=torque, w_1=motion[:, 0], w_3=motion[:, 1])
    return text.made(truth, {"binary": noisy})


def brushless_axis(rng: Generator) -> Twin:
    """Return a brushless motor from the duty of its drive to its speed."""
    truth = {"K": 249.5, "T": 0.096, "t_d": 0.0108}
    interval, samples = 0.00288, 2000
    duty = np.where(np.arange(samples) < 600, 0.4 * (np.arange(samples) > 40), 0.4 + 0.15 * binary(rng, samples, 60))
    line = transfer([truth["K"]], [truth["T"], 1.0])
    speed = stepped(line, duty, interval, truth["t_d"])[:, 0] + 1.5 * rng.standard_normal(samples)
    text = DriveText(name="brushless axis").signals("inputs", u="-").signals("outputs", w="rad/s")
    text.block("lag", "first-order-lag", ["u"], gain="K", time="T").block("w", "delay", ["lag"], time="t_d")
    text.free(K=(10.0, 1000.0, 100.0), T=(0.005, 1.0, 0.05), t_d=(0.0, 0.1, 0.02)).fit(inputs_hold=True)
    return text.made(truth, {"steps": timed(interval, u=duty, w=speed)})


def crane(rng: Generator) -> Twin:
    """Return a hydraulic crane from its valve, which opens by a curve that is known, to the pressure."""
    truth = {"K": -2.0, "w": 0.283, "z": 0.06}
    interval, samples = 1.0, 1024
    valve = 1.2 * levels(rng, samples, 12)
    points = [[-1.5, -1.1], [-0.2, -0.1], [0.2, 0.1], [1.5, 1.1]]
    line = transfer([truth["K"] * truth["w"] ** 2], [1.0, 2.0 * truth["z"] * truth["w"], truth["w"] ** 2])
    flow = np.interp(valve, *np.array(points).T)
    pressure = stepped(line, flow, interval)[:, 0] + 0.2 * rng.standard_normal(samples)
    text = DriveText(name="hydraulic crane").signals("inputs", u="-").signals("outputs", p="-")
    text.block("flow", "table", ["u"], points=points)
    text.block("p", "second-order-lag", ["flow"], gain="K", frequency="w", damping="z")
    text.free(K=(-20.0, 20.0, -1.0), w=(0.05, 1.0, 0.2), z=(0.005, 1.0, 0.1)).fit(inputs_hold=True)
    return text.made(truth, {"valve": timed(interval, u=valve, p=pressure)})


def dynamometer(rng: Generator) -> Twin:
    """Return four rotors on one motor: an inertia each, one friction; the bare shaft was weighed."""
    inertias = {"bare": 1.5e-4, "disc": 5.4e-4, "disc_open": 5.9e-4, "actuator": 8.4e-3}
    truth = {"d": 8.0e-4, "T_C": 0.012} | {f"J({name})": J for name, J in inertias.items() if name != "bare"}
    interval, files = 0.01, {}
    for name, inertia in inertias.items():
        torque = 0.25 * levels(rng, 500, 25)
        motion = rubbed(torque, interval, 200, inertia, truth["d"], truth["T_C"], truth["T_C"], 0.0, 0.0, 0.0)
        files[name] = timed(interval, T=torque, w=motion[:, 1] + 5.0 * rng.standard_normal(torque.size))
    text = DriveText(name="dynamometer, four rotors").signals("inputs", T="N m").signals("outputs", w="rad/s")
    text.block("drag", "gain", ["w"], gain="d")
    text.block("dry", "coulomb-friction", ["w"], size="T_C", yielding=0.002, within=5e-4)
    text.block("w", "inertia", ["T", "-drag", "-dry"], inertia="J")
    text.free(J=(1e-5, 0.1, 1e-3), d=(1e-5, 0.1, 1e-3), T_C=(0.0, 0.2, 0.02))
    text.row("per_record", name="J", values={"bare": 1.5e-4})
    text.row("start", name="w", value=0.0).fit(start="known", offset="none", inputs_hold=True)
    return text.made(truth, files)


def robot_arm(rng: Generator) -> Twin:
    """Return a flexible robot arm with two modes, from torque to acceleration of its end."""
    truth = {"g_1": 0.08, "w_1": TWO_PI * 0.0584, "z_1": 0.03, "g_2": -0.05, "w_2": TWO_PI * 0.1269, "z_2": 0.02}
    interval, samples = 1.0, 1024
    torque = np.asarray(signal_noise(rng, samples))
    swing = np.zeros(samples)
    for mode in ("1", "2"):
        gain, frequency, damping = (truth[f"{name}_{mode}"] for name in ("g", "w", "z"))
        line = transfer([gain * frequency**2], [1.0, 2.0 * damping * frequency, frequency**2])
        swing += stepped(line, torque, interval)[:, 0]
    text = DriveText(name="robot arm, two modes").signals("inputs", T="-").signals("outputs", a="-")
    text.block("a_1", "second-order-lag", ["T"], gain="g_1", frequency="w_1", damping="z_1")
    text.block("a_2", "second-order-lag", ["T"], gain="g_2", frequency="w_2", damping="z_2")
    text.block("a", "sum", ["a_1", "a_2"])
    text.free(g_1=(-1.0, 1.0, 0.1), w_1=(0.2, 0.55, 0.35), z_1=(0.001, 0.5, 0.05))
    text.free(g_2=(-1.0, 1.0, -0.1), w_2=(0.6, 1.2, 0.85), z_2=(0.001, 0.5, 0.05)).fit(inputs_hold=True)
    return text.made(truth, {"noise": timed(interval, T=torque, a=swing + 0.02 * rng.standard_normal(samples))})


def flexible_beam(rng: Generator) -> Twin:
    """Return a flexible beam of which sines and sweeps left frequency responses, with 3 % and 1 % of noise."""
    truth = {"K": 0.62, "p": TWO_PI * 2.0, "w": TWO_PI * 16.5, "z": 0.035, "t_d": 0.0042}
    files, lines = {}, {"sines": np.linspace(0.5, 20.0, 25), "sweeps": np.geomspace(0.6, 22.0, 60)}
    for (name, hertz), share in zip(lines.items(), (0.03, 0.01), strict=True):
        s = 1j * TWO_PI * hertz
        square = truth["w"] ** 2
        motion = truth["K"] / (s / truth["p"] + 1.0) * square / (s**2 + 2.0 * truth["z"] * truth["w"] * s + square)
        std = share * np.abs(motion)
        error = std / np.sqrt(2.0) * (rng.standard_normal(hertz.size) + 1j * rng.standard_normal(hertz.size))
        measured = motion * np.exp(-s * truth["t_d"]) + error
        decibel, degrees = 20.0 * np.log10(np.abs(measured)), np.degrees(np.unwrap(np.angle(measured)))
        files[name] = {"f": hertz, "gain": decibel, "phase": degrees, "std": std}
    text = DriveText(name="flexible beam").signals("inputs", u="V").signals("outputs", a="V")
    text.row("responses", output="a", frequency="f", magnitude="gain", magnitude_unit="dB", phase="phase", std="std")
    text.block("motor", "ratio", ["u"], numerator=["K"], denominator=["T", 1.0])
    text.block("beam", "second-order-lag", ["motor"], frequency="w", damping="z").block(
        "a", "delay", ["beam"], time="t_d"
    )
    text.free(
        K=(0.01, 10.0, 1.0), T=(0.001, 1.0, 0.05), w=(30.0, 300.0, 100.0), z=(0.001, 0.7, 0.1), t_d=(0.0, 0.05, 0.001)
    )
    truth["T"] = 1.0 / truth.pop("p")
    return text.made(truth, files)


TWINS: Mapping[str, Callable[[Generator], Twin]] = MappingProxyType(
    {
        made.__name__: made
        for made in (
            axis_from_force,
            axis_in_its_loop,
            rotor_of_a_servo,
            shaft_behind_loggers,
            motor_first_order,
            speed_without_sign,
            hardening_spring,
            heated_air,
            turbine,
            brushless_axis,
            crane,
            flexible_beam,
            dynamometer,
            robot_arm,
        )
    }
)
"""Every twin by the name of its maker."""
