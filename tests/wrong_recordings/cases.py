"""The wrong recordings: what was done to a good one, and what an answer must name."""

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from tests.wrong_recordings import mutations as m
from tests.wrong_recordings.trial import PICK_UPS as ENGINE_AND_PROPELLER
from tests.wrong_recordings.trial import SET_POINT, SPEED, TORQUE, Change


@dataclass(frozen=True, kw_only=True, slots=True)
class Case:
    """One wrong recording."""

    name: str
    """What is wrong, in words."""
    change: Change
    """What was done to the good one."""
    cause: str
    """What an error or one of the first three reasons must match, case ignored."""
    truth: Mapping[str, float] = field(default_factory=dict)
    """Numbers whose truth the change moves, as factors on the truth of the good one."""
    assumption: str = ""
    """What one of the printed assumptions must match, where no evidence in the recording can show the fault."""
    fast: bool = False
    """Whether it is among the ten of every test run."""


def _step(size: float, at_s: float = 540.0):  # type: ignore[no-untyped-def]
    return lambda time: 1.0 + size * (time >= at_s)


def _ramp(size: float):  # type: ignore[no-untyped-def]
    return lambda time: 1.0 + size * time / time[-1]


SCALE = "scale"
GAUGE_CHANGES = "(gain|zero|torque over the square).*chang|chang.*(gain|zero)"
CLIPPED = "cut off|clipp|sticks|saturat|full scale"
LATE_TORQUE = "torque gauge comes late|torque gauge smooths|latency|t_gauge"
LATE_SPEED = "speed pick-up (comes late|is late|smooths)|t_pickup"
CLOCK = "clock|sample rate|rate_hz|rate of"
CAMPAIGN = "campaign|set point"
PULSES = "pulse|strip|pick-up|PTM_e"
NOTHING = "no cause: the numbers must be right"
SET_POINT_CLOCK = "constant shift of U_setpoint"

GAUGE = (
    Case(name="vessel file: gauge scale times 2", cause=SCALE, fast=True,
         change=m.sensor("shaft_torque", scale_nm_per_unit=1000.0, full_scale_nm=10000.0)),
    Case(name="vessel file: gauge scale halved", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=250.0)),
    Case(name="vessel file: gauge scale times 1.25", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=625.0, full_scale_nm=6250.0)),
    Case(name="vessel file: gauge scale times 0.8", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=400.0)),
    Case(name="vessel file: gauge scale times 1.1", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=550.0, full_scale_nm=5500.0)),
    Case(name="vessel file: gauge scale times 0.9", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=450.0)),
    Case(name="vessel file: gauge scale times 10", cause=SCALE,
         change=m.sensor("shaft_torque", scale_nm_per_unit=5000.0, full_scale_nm=50000.0)),
    Case(name="torque channel a tenth", cause=SCALE, change=m.gain(TORQUE, lambda time: 0.1)),
    Case(name="torque channel: unit mV", cause="unit", change=m.attributes(TORQUE, unit="mV")),
    Case(name="torque channel: scale 0", cause="scale", change=m.attributes(TORQUE, scale=0.0)),
    Case(name="gauge gain jumps by 10 % at 540 s", cause=GAUGE_CHANGES, fast=True,
         change=m.gain(TORQUE, _step(0.1))),
    Case(name="gauge gain falls by 10 % at 540 s", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _step(-0.1))),
    Case(name="gauge gain jumps by 20 % at 350 s", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _step(0.2, 350.0))),
    Case(name="gauge gain drifts up by 10 %", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _ramp(0.1))),
    Case(name="gauge gain drifts down by 10 %", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _ramp(-0.1))),
    Case(name="gauge gain jumps by 4 % at 300 s", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _step(0.04, 300.0))),
    Case(name="gauge gain drifts up by 6 %", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _ramp(0.06))),
    Case(name="gauge warms up by 6 % with 150 s", cause=GAUGE_CHANGES,
         change=m.gain(TORQUE, lambda time: 0.94 + 0.06 * np.exp(-time / 150.0))),
    Case(name="gauge zero jumps by 5 % at 540 s", cause=GAUGE_CHANGES,
         change=m.changed(TORQUE, lambda time, v: v + 0.05 * v.mean() * (time >= 540.0))),
    Case(name="gauge zero drifts by 5 %", cause=GAUGE_CHANGES,
         change=m.changed(TORQUE, lambda time, v: v + 0.05 * v.mean() * time / time[-1])),
    Case(name="gauge zero 3 % of the mean", cause=NOTHING,
         change=m.changed(TORQUE, lambda time, v: v + 0.03 * v.mean())),
    Case(name="gauge zero 10 % of the mean", cause="zero",
         change=m.changed(TORQUE, lambda time, v: v + 0.1 * v.mean())),
    Case(name="vessel file: gauge zero 100 N m", cause="zero", change=m.sensor("shaft_torque", zero_nm=100.0)),
    Case(name="gauge follows a power law of 0.9", cause="scale|linear",
         change=m.changed(TORQUE, lambda time, v: v.mean() * np.sign(v) * np.abs(v / v.mean()) ** 0.9)),
    Case(name="torque clipped at +12 % of its mean", cause=CLIPPED, fast=True,
         change=m.changed(TORQUE, lambda time, v: np.minimum(v, 1.12 * v.mean()))),
    Case(name="torque clipped at -12 % of its mean", cause=CLIPPED,
         change=m.changed(TORQUE, lambda time, v: np.maximum(v, 0.88 * v.mean()))),
    Case(name="torque clipped at +40 % of its mean", cause=CLIPPED,
         change=m.changed(TORQUE, lambda time, v: np.minimum(v, 1.4 * v.mean()))),
    Case(name="torque: the highest 0.3 % clipped", cause=CLIPPED,
         change=m.changed(TORQUE, lambda time, v: np.minimum(v, np.quantile(v, 0.997)))),
    Case(name="torque dead from 500 s on", cause="dead|stands still",
         change=m.changed(TORQUE, lambda time, v: np.where(time < 500.0, v, v.mean()))),
    Case(name="torque zero", cause="dead|move|torque", change=m.gain(TORQUE, lambda time: 0.0)),
    Case(name="torque reversed from 540 s on", cause="one sign",
         change=m.gain(TORQUE, lambda time: np.where(time < 540.0, 1.0, -1.0))),
    Case(name="vessel file: gauge scale of the engine's shaft", cause="scale.*gear ratio",
         change=m.sensor("shaft_torque", scale_nm_per_unit=500.0 / 3.82)),
    Case(name="torque reversed", cause="sign|positive", change=m.gain(TORQUE, lambda time: -1.0)),
    Case(name="torque drowned in noise", cause="noise|noisy", change=m.slow_noise(TORQUE, 1.3, 20.0)),
    Case(name="torque 5 ms late", cause=LATE_TORQUE, change=m.late(0.005, TORQUE)),
    Case(name="torque 10 ms late", cause=LATE_TORQUE, change=m.late(0.01, TORQUE)),
    Case(name="torque 20 ms late", cause=LATE_TORQUE, change=m.late(0.02, TORQUE), fast=True),
    Case(name="torque 50 ms late", cause=LATE_TORQUE, change=m.late(0.05, TORQUE)),
    Case(name="torque 0.1 s late", cause=LATE_TORQUE, change=m.late(0.1, TORQUE)),
    Case(name="torque 1 s late", cause=LATE_TORQUE, change=m.late(1.0, TORQUE)),
    Case(name="torque through a low-pass of 20 Hz", cause=LATE_TORQUE, change=m.low_pass(TORQUE, 20.0)),
    Case(name="torque through a low-pass of 5 Hz", cause=LATE_TORQUE, change=m.low_pass(TORQUE, 5.0)),
    Case(name="hum of 2 % in the torque", cause=NOTHING, change=m.hum(TORQUE, 0.07)),
    Case(name="hum of 10 % in the torque", cause=NOTHING, change=m.hum(TORQUE, 0.35)),
    Case(name="vessel file: latency of the torque 20 ms instead of 5", cause=LATE_TORQUE,
         change=m.sensor("shaft_torque", latency_s=0.02)),
    Case(name="0.1 s of the torque lost at 600 s", cause=f"{LATE_TORQUE}|{CLOCK}|shift|M_s",
         change=m.cut_out(600.0, 600.1, TORQUE)),
    Case(name="swell of 10 % and 0.1 Hz between lines", cause=NOTHING, change=m.swell(0.1, 0.1, 446.0, 449.0)),
    Case(name="swell of 10 % on the line of S1", cause="S1", change=m.swell(0.02, 0.1, 230.0, 343.0)),
    Case(name="swell of 10 % on the line of S3", cause="S3", change=m.swell(0.06, 0.1, 449.0, 529.0)),
    Case(name="swell of 10 % on the line of S4", cause="S4", change=m.swell(0.15, 0.1, 532.0, 585.0)),
)  # fmt: skip

PICK_UPS = (
    Case(name="1 % of the engine's pulses lost", cause=PULSES, change=m.without_pulses(SPEED, 0.01)),
    Case(name="5 % of the engine's pulses lost", cause=PULSES, change=m.without_pulses(SPEED, 0.05)),
    Case(name="30 % of the engine's pulses lost", cause=PULSES, change=m.without_pulses(SPEED, 0.3)),
    Case(name="every second pulse of the engine lost", cause=PULSES, change=m.every_second_pulse(SPEED)),
    Case(name="30 % of the engine's pulses doubled", cause=PULSES, change=m.doubled_pulses(SPEED, 0.3)),
    Case(name="all of the engine's pulses doubled", cause=PULSES, change=m.doubled_pulses(SPEED, 1.0)),
    Case(name="engine's pick-up dead from 500 s on", cause=PULSES,
         change=m.changed(SPEED, lambda time, v: np.where(time < 500.0, v, v.min()))),
    Case(name="vessel file: 4 strips given as 3", cause="pulses_per_revolution|strip",
         change=m.pick_up(2, pulses_per_revolution=3, strip_angles_deg=None)),
    Case(name="vessel file: 1 strip on the engine given as 2", cause="pulses_per_revolution|strip|ratio",
         change=m.pick_up(0, pulses_per_revolution=2)),
    Case(name="pulses of all pick-ups through a divider by two", cause="speed is in doubt.*half",
         change=m.divided(*ENGINE_AND_PROPELLER)),
    Case(name="vessel file: one pick-up alone, its strip given as 2", cause="half the true one.*pulses_per_revolution",
         change=m.alone(0, pulses_per_revolution=2)),
    Case(name="vessel file: one pick-up alone, the propeller's given as the engine's", cause="gear ratio.*shaft",
         change=m.alone(1, shaft="engine")),
    Case(name="vessel file: one pick-up alone, the engine's given as the propeller's", cause="gear ratio.*shaft",
         change=m.alone(0, shaft="propeller")),
    Case(name="engine's pulses fade to a third at 300 s", cause="too low to be counted",
         change=m.changed(SPEED, lambda time, v: np.where(time < 300.0, v, v.min() + (v - v.min()) / 3.0))),
    Case(name="all channels sampled at 200 Hz", cause="rate is too low", change=m.slower(200.0)),
    Case(name="vessel file: gear ratio 3.28", cause="ratio", change=m.vessel("gearbox", ratio=3.28)),
    Case(name="vessel file: gear ratio 3.80", cause="ratio", change=m.vessel("gearbox", ratio=3.80)),
    Case(name="pick-ups of engine and propeller swapped", cause="ratio|pick-up", change=m.swapped("PTM_e", "PTM_1"),
         fast=True),
    Case(name="engine's pick-up 30 ms late", cause=LATE_SPEED, change=m.late(0.03, SPEED)),
    Case(name="engine's pick-up 100 ms late", cause=LATE_SPEED, change=m.late(0.1, SPEED)),
    Case(name="engine's pick-up 0.4 s late", cause=LATE_SPEED, change=m.late(0.4, SPEED)),
    Case(name="all pick-ups 50 ms late", cause=LATE_SPEED, change=m.late(0.05, *ENGINE_AND_PROPELLER)),
    Case(name="hum on the engine's pick-up, a third of a pulse", cause=NOTHING, change=m.hum(SPEED, 1.6)),
    Case(name="hum on the engine's pick-up, most of a pulse", cause=PULSES, change=m.hum(SPEED, 3.0)),
)  # fmt: skip

SET_POINTS = (
    Case(name="set point inverted", cause=CAMPAIGN, change=m.changed(SET_POINT, lambda time, v: 2 * v.mean() - v)),
    Case(name="set point constant", cause=CAMPAIGN, change=m.changed(SET_POINT, lambda time, v: 0 * v + v.mean())),
    Case(name="set point's movement a tenth", cause=f"{CAMPAIGN}|volt|slope",
         change=m.changed(SET_POINT, lambda time, v: -5.0 + 0.1 * (v + 5.0))),
    Case(name="set point a thousandth", cause="mV for V",
         change=m.both(m.attributes(SET_POINT, scale=1e-6),
                       m.changed(SET_POINT, lambda time, v: v / v.mean() * -5.05e-3))),
    Case(name="torque of 2 % in the set point", cause="another channel",
         change=lambda trial: trial.with_values(
             SET_POINT, trial.values(SET_POINT) + 0.02 * trial.values(TORQUE))),
    Case(name="set point 60 s late", cause=CAMPAIGN, change=m.late(60.0, SET_POINT)),
    Case(name="set point 0.2 s late", cause=f"{CAMPAIGN}|delay|bound", change=m.late(0.2, SET_POINT)),
    Case(name="set point 0.2 s early", cause=NOTHING, assumption=SET_POINT_CLOCK, change=m.late(-0.2, SET_POINT),
         fast=True),
    Case(name="set point 0.06 s early", cause=NOTHING, assumption=SET_POINT_CLOCK, change=m.late(-0.06, SET_POINT)),
    Case(name="set point 2 s early", cause=CAMPAIGN, change=m.late(-2.0, SET_POINT)),
    Case(name="set point and torque swapped", cause=f"{CAMPAIGN}|torque", change=m.swapped(SET_POINT, TORQUE)),
    Case(name="set point clipped at +0.4 V", cause=CAMPAIGN,
         change=m.changed(SET_POINT, lambda time, v: np.minimum(v, -4.65))),
    Case(name="0.5 s of the set point lost at 600 s", cause=f"{CAMPAIGN}|{CLOCK}|S\\d+",
         change=m.cut_out(600.0, 600.5, SET_POINT)),
    Case(name="hum of 0.5 V on the set point", cause=f"{CAMPAIGN}|steady|noise", change=m.hum(SET_POINT, 0.5)),
    Case(name="noise of 0.3 V on the set point", cause=f"{CAMPAIGN}|steady|noise", change=m.noise(SET_POINT, 0.3)),
    Case(name="set point's gain 2 % high during the sines", cause="scale of the set point|set-point scale|c_set",
         change=m.changed(SET_POINT, lambda time, v: np.where(time < 228.0, v, -5.05 + 1.02 * (v + 5.05)))),
    Case(name="set point 3 % large from 587 s on", cause="amplitude of the set point",
         change=m.changed(SET_POINT, lambda time, v: np.where(time < 587.0, v, -5.05 + 1.03 * (v + 5.05)))),
    Case(name="set point 1 % small from 480 s on, volts and all", cause="amplitude of the set point",
         change=m.changed(SET_POINT, lambda time, v: np.where(time < 480.0, v, 0.99 * v))),
    Case(name="set point's sines 5 % high", cause="scale of the set point|set-point scale|c_set",
         change=m.changed(SET_POINT, lambda time, v: np.where(time < 228.0, v, -5.05 + 1.05 * (v + 5.05)))),
)  # fmt: skip

CLOCKS = (
    Case(name="declared rate 1 % low", cause="clock of the recording|recording.*clock", change=m.rate(0.99)),
    Case(name="declared rate 0.5 % low", cause="clock of the recording|recording.*clock", change=m.rate(0.995),
         fast=True),
    Case(name="declared rate 0.5 % high", cause="clock of the recording|recording.*clock", change=m.rate(1.005)),
    Case(name="declared rate 1 % high", cause="clock of the recording|recording.*clock|too short",
         change=m.rate(1.01)),
    Case(name="declared rate of the torque 200 ppm high", cause=CLOCK, change=m.rate(1.0002, TORQUE), fast=True),
    Case(name="declared rate of the torque 20 ppm high", cause=CLOCK, change=m.rate(1.00002, TORQUE)),
    Case(name="declared rate of the set point 20 ppm high", cause=CLOCK, change=m.rate(1.00002, SET_POINT)),
    Case(name="declared rate of the pick-up 50 ppm high", cause=CLOCK, change=m.rate(1.00005, SPEED)),
    Case(name="torque sampled 0.5 % too fast", cause="clock", change=m.sampled_at(1.005, TORQUE)),
    Case(name="pick-ups sampled 0.5 % too fast", cause="clock", change=m.sampled_at(1.005, *ENGINE_AND_PROPELLER)),
    Case(name="set point sampled 0.5 % too fast", cause=f"clock|{CAMPAIGN}", change=m.sampled_at(1.005, SET_POINT)),
    Case(name="rate of the torque not a number", cause="rate", change=m.attributes(TORQUE, rate_hz=float("nan"))),
    Case(name="rate of the torque negative", cause="rate", change=m.attributes(TORQUE, rate_hz=-2000.0)),
    Case(name="start of the torque infinite", cause="start", change=m.attributes(TORQUE, start_s=float("inf"))),
    Case(name="3 s lost in S4", cause=f"{CAMPAIGN}|short|start", change=m.cut_out(560.0, 563.0)),
    Case(name="0.7 s lost in all channels at 600 s", cause=CAMPAIGN, change=m.cut_out(600.0, 600.7)),
    Case(name="second half cut off", cause="short|lasts", fast=True, change=m.everywhere(lambda v: v[: v.size // 2])),
    Case(name="first 60 s lost", cause=f"{CAMPAIGN}|short", change=m.everywhere(lambda v: v[120_000:])),
    Case(name="reversed in time", cause=f"{CAMPAIGN}|misfit|explain", change=m.everywhere(lambda v: v[::-1].copy())),
)  # fmt: skip

GAPS = (
    Case(name="missing: 30 s of the torque in S4", cause=NOTHING, change=m.missing(550.0, 580.0, TORQUE)),
    Case(name="missing: 30 s of the set point in S4", cause=NOTHING, change=m.missing(550.0, 580.0, SET_POINT)),
    Case(name="missing: 20 s of the pulses in S3", cause=NOTHING, change=m.missing(490.0, 510.0, SPEED)),
    Case(name="missing: 12.3 s of all channels in S5", cause=NOTHING, change=m.missing(600.0, 612.3)),
    Case(name="missing: one value of the torque", cause=NOTHING, change=m.missing(610.0, 610.0005, TORQUE)),
    Case(name="missing: the first 100 s, and the start says so", cause=NOTHING, change=m.begun_late(100.0)),
    Case(name="missing: the first 60 s, held", cause=f"{NOTHING}|lasts|stands still|no pulses",
         change=m.held(0.0, 60.0)),
    Case(name="missing: the last 60 s, held", cause=f"{NOTHING}|lasts|stands still|no pulses",
         change=m.held(800.0, 860.0)),
    Case(name="missing: 30 s of the torque in S4, held", cause=NOTHING, change=m.held(550.0, 580.0, TORQUE)),
    Case(name="missing: nothing, but the clock jumps in S4", cause=NOTHING, change=m.clock_jump(0.0003, 560.0)),
)  # fmt: skip

FILES = (
    Case(name="campaign file: frequencies in rad/s", cause="rad/s", fast=True,
         change=m.sines(lambda one: {"frequency_hz": 2.0 * np.pi * one.frequency_hz})),
    Case(name="campaign file: S6 0.5 % too fast", cause="S6", change=m.sine("S6", frequency_hz=0.5025)),
    Case(name="campaign file: S6 2 % too fast", cause="S6", change=m.sine("S6", frequency_hz=0.51)),
    Case(name="campaign file: S6 13 % too fast", cause="S6", change=m.sine("S6", frequency_hz=0.565)),
    Case(name="campaign file: all sines 0.5 % too fast", cause="clock of the recording|campaign",
         change=m.sines(lambda one: {"frequency_hz": 1.005 * one.frequency_hz})),
    Case(name="campaign file: amplitudes halved", cause=CAMPAIGN,
         change=m.sines(lambda one: {"amplitude_v": 0.5 * one.amplitude_v})),
    Case(name="campaign file: offset -7 V instead of -5 V", cause="offset_v|working voltage",
         change=m.campaign(lambda trial: {"offset_v": -7.0})),
    Case(name="vessel file: torque coefficient 30 % higher, as with a fouled propeller", cause=NOTHING,
         change=m.vessel("propeller", torque_coefficient=1.3 * 0.04943)),
    Case(name="vessel file: propeller's diameter 1.10 m", cause="K_Q|diameter", assumption="diameter",
         change=m.vessel("propeller", diameter_m=1.10)),
    Case(name="vessel file: inertia upstream halved", cause="tau_up|I_up|known of|inertia",
         change=m.inertias(0.5, "upstream")),
    Case(name="vessel file: inertia upstream 1.5 times", cause="tau_up|I_up|known of|inertia",
         assumption="inertia upstream",
         change=m.inertias(1.5, "upstream")),
    Case(name="vessel file: inertia downstream twice", cause=NOTHING, change=m.inertias(2.0, "downstream")),
    Case(name="vessel file: fresh water", cause=NOTHING, change=lambda trial: trial.with_density(1000.0),
         truth={"K_Q": 1.025}),
)  # fmt: skip

STILL, HOLDS, FILTER = "stands still for", "holds each value|low-pass|clock", "low-pass|holds each value"

SAMPLES = (
    Case(name="torque keeps its last value 30 % of the time, 0.1 s each", cause=STILL, fast=True,
         change=m.held_in_bursts(0.3, 0.1, TORQUE)),
    Case(name="torque keeps its last value 50 % of the time, 0.05 s each", cause=STILL,
         change=m.held_in_bursts(0.5, 0.05, TORQUE)),
    Case(name="torque keeps its last value 10 % of the time, 0.2 s each", cause=STILL,
         change=m.held_in_bursts(0.1, 0.2, TORQUE)),
    Case(name="torque held at 3 Hz", cause=HOLDS, change=m.held_at(3.0, TORQUE)),
    Case(name="torque held at 10 Hz", cause=HOLDS, change=m.held_at(10.0, TORQUE)),
    Case(name="torque held at 25 Hz", cause=HOLDS, change=m.held_at(25.0, TORQUE)),
    Case(name="set point keeps its last value 30 % of the time, 0.1 s each", cause=STILL,
         change=m.held_in_bursts(0.3, 0.1, SET_POINT)),
    Case(name="set point held at 3 Hz", cause=HOLDS, change=m.held_at(3.0, SET_POINT)),
    Case(name="set point held at 10 Hz", cause=HOLDS, change=m.held_at(10.0, SET_POINT)),
    Case(name="set point held at 25 Hz", cause=HOLDS, change=m.held_at(25.0, SET_POINT)),
    Case(name="set point through a low-pass of 2 Hz", cause=FILTER, change=m.low_pass(SET_POINT, 2.0)),
    Case(name="set point through a low-pass of 5 Hz", cause=FILTER, change=m.low_pass(SET_POINT, 5.0)),
    Case(name="set point through a low-pass of 10 Hz", cause=FILTER, change=m.low_pass(SET_POINT, 10.0)),
    Case(name="set point as the mean of the last 0.1 s", cause=FILTER, change=m.mean_of(0.1, SET_POINT)),
    Case(name="set point sampled 50 ppm too fast", cause=CLOCK, change=m.sampled_at(1.00005, SET_POINT)),
    Case(name="set point sampled 50 ppm too slowly", cause=CLOCK, change=m.sampled_at(0.99995, SET_POINT)),
    Case(name="set point sampled 20 ppm too fast", cause=CLOCK, assumption="clock of its own",
         change=m.sampled_at(1.00002, SET_POINT)),
)  # fmt: skip

CASES = (*GAUGE, *PICK_UPS, *SET_POINTS, *CLOCKS, *GAPS, *FILES, *SAMPLES)
FAST = tuple(case for case in CASES if case.fast)
