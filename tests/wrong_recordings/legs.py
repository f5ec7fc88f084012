"""What is spoilt in a test of two speeds alone: one leg, what lies between the legs, and what is planned of them."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from tests.wrong_recordings import mutations as m
from tests.wrong_recordings.case import Case
from tests.wrong_recordings.cases import (
    CAMPAIGN,
    CASES,
    CLIPPED,
    CLOCK,
    FILTER,
    GAUGE_CHANGES,
    HOLDS,
    LATE_SPEED,
    LATE_TORQUE,
    NOTHING,
    PULSES,
    STILL,
)
from tests.wrong_recordings.trial import PICK_UPS, SET_POINT, SPEED, TORQUE, TWO_SPEEDS, Change

from shaftprint.campaign import Multisine

# M1 from 10 to 316 s at 1361 rpm, M2 from 331 to 635 s at 926 rpm, steps about M1 from 654 s on; periods of 33.1 s.
BETWEEN, SECOND, MIDDLE, STEPS, END = 323.0, 330.6, 480.0, 644.0, 714.0
PERIOD = 33.107635555556
OFFSET_V, LOWER_V = -5.707450199203, -3.971839043825
ONE_LEG = "explain all legs|M2"
PART_HELD = f"{STILL}|{HOLDS}"
LOAD, BEND = f"{NOTHING}|torque over the square|load|way|zero", f"{NOTHING}|bend|b_set|c_set|slope"
SET_POINT_GAIN = "amplitude of the set point|scale of the set point|set-point scale|c_set|b_set|level"


def _from(size: float, at_s: float) -> Callable[[m.Values], m.Values]:
    return lambda time: 1.0 + size * (time >= at_s)


def _about(level_v: float, factor: float) -> Change:
    return m.changed(SET_POINT, lambda time, v: level_v + factor * (v - level_v))


def _second(change: Change) -> Change:
    return m.within(change, SECOND, STEPS)


def _first(change: Change) -> Change:
    return m.within(change, 0.0, BETWEEN)


def _lines(of: Callable[[np.ndarray], np.ndarray]) -> Callable[[Multisine], dict[str, object]]:
    return lambda leg: {"phases_rad": tuple(of(np.array(leg.phases_rad)))}


def _other_leg(trial: m.Trial) -> dict[str, object]:
    first, second = trial.campaign.multisines
    fields = ("harmonics", "amplitudes_v", "phases_rad")
    one, other = ({name: getattr(leg, name) for name in fields} for leg in (first, second))
    return {"multisines": (first.model_copy(update=other), second.model_copy(update=one))}


GAUGE = (
    Case(name="gauge gain 8 % higher from 393 s on", cause=GAUGE_CHANGES, change=m.gain(TORQUE, _from(0.08, 393.0)),
         fast=True),
    Case(name="gauge gain 4 % higher in the second leg and after", cause=GAUGE_CHANGES, fast=True,
         change=m.gain(TORQUE, _from(0.04, BETWEEN))),
    Case(name="gauge gain 8 % lower in the second leg and after", cause=GAUGE_CHANGES,
         change=m.gain(TORQUE, _from(-0.08, BETWEEN))),
    Case(name="gauge gain 8 % higher in the second leg alone", cause=GAUGE_CHANGES,
         change=_second(m.gain(TORQUE, lambda time: 1.08))),
    Case(name="gauge gain 6 % lower in the first leg alone", cause=GAUGE_CHANGES,
         change=_first(m.gain(TORQUE, lambda time: 0.94))),
    Case(name="gauge gain 6 % higher in the steps alone", cause=GAUGE_CHANGES,
         change=m.gain(TORQUE, _from(0.06, STEPS))),
    Case(name="gauge gain drifts up by 8 %", cause=GAUGE_CHANGES,
         change=m.gain(TORQUE, lambda time: 1.0 + 0.08 * time / time[-1])),
    Case(name="gauge zero moves by 5 % of the mean between the legs", cause=f"{GAUGE_CHANGES}|zero",
         change=m.changed(TORQUE, lambda time, v: v + 0.05 * v.mean() * (time >= BETWEEN))),
    Case(name="gauge zero moves by 15 % of the mean between the legs", cause=f"{GAUGE_CHANGES}|zero",
         change=m.changed(TORQUE, lambda time, v: v + 0.15 * v.mean() * (time >= BETWEEN))),
    Case(name="torque clipped in the first leg", cause=CLIPPED,
         change=_first(m.changed(TORQUE, lambda time, v: np.minimum(v, np.quantile(v[time < BETWEEN], 0.9))))),
    Case(name="torque clipped in the second leg", cause=CLIPPED,
         change=_second(m.changed(TORQUE, lambda time, v: np.maximum(v, np.quantile(v[time > SECOND], 0.2))))),
    Case(name="torque keeps its last value 30 % of the time in the second leg", cause=STILL, fast=True,
         change=_second(m.held_in_bursts(0.3, 0.1, TORQUE))),
    Case(name="torque keeps its last value 30 % of the time in the first leg", cause=STILL,
         change=_first(m.held_in_bursts(0.3, 0.1, TORQUE))),
    Case(name="torque held at 10 Hz in the second leg", cause=PART_HELD, change=_second(m.held_at(10.0, TORQUE))),
    Case(name="torque held at 5 Hz in the first leg", cause=PART_HELD, change=_first(m.held_at(5.0, TORQUE))),
    Case(name="torque through a low-pass of 5 Hz in the second leg", cause=f"{LATE_TORQUE}|{ONE_LEG}",
         change=_second(m.low_pass(TORQUE, 5.0))),
    Case(name="torque 30 ms late in the second leg", cause=f"{LATE_TORQUE}|{ONE_LEG}",
         change=_second(m.late(0.03, TORQUE))),
    Case(name="torque 30 ms late", cause=LATE_TORQUE, change=m.late(0.03, TORQUE)),
    Case(name="torque dead in the second leg", cause="dead|stands still",
         change=m.changed(TORQUE, lambda time, v: np.where(time < SECOND, v, v[time < SECOND][-1]))),
    Case(name="torque dead from the middle of the second leg on", cause="dead|stands still",
         change=m.changed(TORQUE, lambda time, v: np.where(time < MIDDLE, v, v[time < MIDDLE][-1]))),
    Case(name="torque reversed in the second leg", cause="one sign",
         change=_second(m.gain(TORQUE, lambda time: -1.0))),
    Case(name="torque drowned in noise in the second leg", cause=f"noise|noisy|{ONE_LEG}",
         change=_second(m.slow_noise(TORQUE, 1.3, 20.0))),
    Case(name="swell of 5 % on a line of both legs", cause="swell|stray|explain|M1:3|M2:3",
         change=m.swell(3.0 / PERIOD, 0.05, 0.0, STEPS)),
    Case(name="swell of 5 % between the lines", cause=NOTHING, change=m.swell(2.5 / PERIOD, 0.05, 0.0, STEPS)),
    Case(name="ice: blows of 10 % for 0.3 s each 7 s in the second leg", cause=f"noise|noisy|{ONE_LEG}|explain",
         change=_second(m.gain(TORQUE, lambda time: 1.0 + 0.1 * (np.mod(time, 7.0) < 0.3)))),
)  # fmt: skip

SPEEDS = (
    Case(name="5 % of the engine's pulses lost in the second leg", cause=PULSES,
         change=_second(m.without_pulses(SPEED, 0.05))),
    Case(name="30 % of the engine's pulses doubled in the second leg", cause=PULSES,
         change=_second(m.doubled_pulses(SPEED, 0.3))),
    Case(name="pulses of all pick-ups halved in the second leg", cause="speed is in doubt|pulse|half|ratio",
         change=_second(m.divided(*PICK_UPS))),
    Case(name="engine's pick-up dead in the second leg", cause=PULSES,
         change=m.changed(SPEED, lambda time, v: np.where(time < SECOND, v, v.min()))),
    Case(name="engine's pulses fade to a third at the second leg", cause="too low to be counted",
         change=m.changed(SPEED, lambda time, v: np.where(time < SECOND, v, v.min() + (v - v.min()) / 3.0))),
    Case(name="engine's pick-up 30 ms late in the second leg", cause=f"{LATE_SPEED}|{ONE_LEG}|shift",
         change=_second(m.late(0.03, SPEED))),
)  # fmt: skip

SET_POINTS = (
    Case(name="set point's movement a tenth in both legs", cause=f"{CAMPAIGN}|volt|slope",
         change=m.both(_first(_about(OFFSET_V, 0.1)), _second(_about(LOWER_V, 0.1)))),
    Case(name="set point's movement 3 % large in the second leg", cause=SET_POINT_GAIN, fast=True,
         change=_second(_about(LOWER_V, 1.03))),
    Case(name="set point's movement 2 % small in the first leg", cause=SET_POINT_GAIN,
         change=_first(_about(OFFSET_V, 0.98))),
    Case(name="set point 3 % large from the second leg on, volts and all", cause=SET_POINT_GAIN,
         change=m.gain(SET_POINT, _from(0.03, BETWEEN))),
    Case(name="set point 3 % large from 587 s on", cause=SET_POINT_GAIN,
         change=m.within(_about(LOWER_V, 1.03), 587.0, STEPS)),
    Case(name="set point 1 % small from the middle of the second leg on", cause=SET_POINT_GAIN,
         change=m.gain(SET_POINT, _from(-0.01, MIDDLE))),
    Case(name="set point 5 % large throughout, volts and all", cause=SET_POINT_GAIN,
         change=m.gain(SET_POINT, lambda time: 1.05)),
    Case(name="lever's offset moves by 0.05 V between the legs", cause=f"{SET_POINT_GAIN}|offset", fast=True,
         change=m.changed(SET_POINT, lambda time, v: v + 0.05 * (time >= BETWEEN))),
    Case(name="lever's offset moves by 0.3 V between the legs", cause=f"{SET_POINT_GAIN}|offset|campaign",
         change=m.changed(SET_POINT, lambda time, v: v + 0.3 * (time >= BETWEEN))),
    Case(name="set point through a low-pass of 2 Hz in the second leg", cause=FILTER,
         change=_second(m.low_pass(SET_POINT, 2.0))),
    Case(name="set point through a low-pass of 5 Hz in the first leg", cause=FILTER,
         change=_first(m.low_pass(SET_POINT, 5.0))),
    Case(name="set point held at 10 Hz in the second leg", cause=PART_HELD,
         change=_second(m.held_at(10.0, SET_POINT))),
    Case(name="set point keeps its last value 30 % of the time in the second leg", cause=STILL,
         change=_second(m.held_in_bursts(0.3, 0.1, SET_POINT))),
    Case(name="set point 0.2 s late in the second leg", cause=f"{CAMPAIGN}|delay|{ONE_LEG}",
         change=_second(m.late(0.2, SET_POINT))),
    Case(name="set point 0.05 s late in the second leg", cause=f"{CAMPAIGN}|delay|{ONE_LEG}",
         change=_second(m.late(0.05, SET_POINT))),
    Case(name="set point inverted in the second leg", cause=CAMPAIGN, change=_second(_about(LOWER_V, -1.0))),
    Case(name="set point constant in the second leg", cause=CAMPAIGN, change=_second(_about(LOWER_V, 0.0))),
    Case(name="set point clipped in the second leg", cause=CAMPAIGN,
         change=_second(m.changed(SET_POINT, lambda time, v: np.minimum(v, LOWER_V + 0.3)))),
    Case(name="noise of 0.3 V on the set point in the second leg", cause=f"{CAMPAIGN}|steady|noise",
         change=_second(m.noise(SET_POINT, 0.3))),
    Case(name="torque of 2 % in the set point in the second leg", cause="another channel",
         change=_second(m.cross_talk(0.02, TORQUE, SET_POINT))),
)  # fmt: skip

CLOCKS = (
    Case(name="0.7 s lost between the legs", cause=f"{CAMPAIGN}|short|lost", change=m.cut_out(BETWEEN, BETWEEN + 0.7)),
    Case(name="0.7 s lost in the second leg", cause=f"{CAMPAIGN}|short|lost|M2",
         change=m.cut_out(MIDDLE, MIDDLE + 0.7)),
    Case(name="a whole period lost in the first leg", cause=f"{NOTHING}|{CAMPAIGN}|short|start|lost",
         change=m.cut_out(100.0, 100.0 + PERIOD)),
    Case(name="0.5 s of the set point lost in the second leg", cause=f"{CAMPAIGN}|{CLOCK}|M2",
         change=m.cut_out(MIDDLE, MIDDLE + 0.5, SET_POINT)),
    Case(name="set point sampled 50 ppm too fast from the second leg on", cause=f"{CLOCK}|{CAMPAIGN}|M2",
         change=m.within(m.sampled_at(1.00005, SET_POINT), SECOND)),
    Case(name="recording ends in the middle of the second leg", cause=f"{NOTHING}|short|lasts",
         change=m.everywhere(lambda v: v[: round(2000 * MIDDLE)])),
    Case(name="recording ends with the first leg", cause="short|lasts|M2",
         change=m.everywhere(lambda v: v[: round(2000 * BETWEEN)])),
    Case(name="legs in the wrong order", cause=CAMPAIGN, fast=True,
         change=m.exchanged((14.0, 318.0), (334.0, 638.0))),
    Case(name="second leg holds the first once more", cause=CAMPAIGN,
         change=m.everywhere(lambda v: np.concatenate([v[:660_000], v[20_000:648_000], v[1_288_000:]]))),
    Case(name="second leg 3 s early in all channels", cause=f"{CAMPAIGN}|M2",
         change=m.both(m.cut_out(BETWEEN, BETWEEN + 3.0), m.everywhere(lambda v: np.append(v, v[-6000:])))),
)  # fmt: skip

GAPS = (
    Case(name="missing: 100 s of the torque in the first leg", cause=NOTHING, change=m.missing(120.0, 220.0, TORQUE)),
    Case(name="missing: 30 s of the set point in the first leg", cause=NOTHING, fast=True,
         change=m.missing(120.0, 150.0, SET_POINT)),
    Case(name="missing: all of the second leg", cause="M2|short|gap|missing", change=m.missing(SECOND, STEPS)),
    Case(name="missing: all between the legs", cause=NOTHING, change=m.missing(317.0, 330.0)),
    Case(name="missing: the steps, held", cause=f"{NOTHING}|lasts|stands still|no pulses",
         change=m.held(STEPS, END + 1.0)),
    Case(name="missing: 60 s of the set point in the second leg, held", cause=f"{NOTHING}|stands still|{CAMPAIGN}",
         change=m.held(400.0, 460.0, SET_POINT)),
)  # fmt: skip

FILES = (
    Case(name="campaign file: level of the second leg 0.5 V high", cause=f"{CAMPAIGN}|level",
         change=m.leg("M2", lambda leg: {"level_v": leg.level_v + 0.5}), fast=True),
    Case(name="campaign file: level of the second leg 0.1 V low", cause=f"{NOTHING}|{CAMPAIGN}|level",
         change=m.leg("M2", lambda leg: {"level_v": leg.level_v - 0.1})),
    Case(name="campaign file: level of the first leg that of the second", cause=f"{CAMPAIGN}|level",
         change=m.leg("M1", lambda leg: {"level_v": LOWER_V})),
    Case(name="campaign file: slope of the lever 10 % high", cause="slope|c_set|speed is in doubt|rpm_per",
         change=m.campaign(lambda trial: {"slope_rpm_per_v": -276.0})),
    Case(name="campaign file: slope of the lever of the other sign", cause="slope|sign|c_set|speed",
         change=m.campaign(lambda trial: {"slope_rpm_per_v": 251.0})),
    Case(name="campaign file: speed at the offset 10 % low", cause=f"{NOTHING}|offset_rpm|speed",
         change=m.campaign(lambda trial: {"offset_rpm": 1225.0})),
    Case(name="campaign file: offset +5.7 V", cause=f"{CAMPAIGN}|offset",
         change=m.campaign(lambda trial: {"offset_v": 5.7})),
    Case(name="campaign file: period of the second leg 0.5 % long", cause=f"{CAMPAIGN}|M2|period",
         change=m.leg("M2", lambda leg: {"period_s": 1.005 * leg.period_s})),
    Case(name="campaign file: periods of both legs 2 % short", cause=f"{CAMPAIGN}|period|clock",
         change=m.both(*(m.leg(name, lambda leg: {"period_s": 0.98 * leg.period_s}) for name in ("M1", "M2")))),
    Case(name="campaign file: period of the second leg halved", cause=f"{CAMPAIGN}|M2|period",
         change=m.leg("M2", lambda leg: {"period_s": 0.5 * leg.period_s})),
    Case(name="campaign file: second leg 10 s later", cause=f"{CAMPAIGN}|M2|start",
         change=m.leg("M2", lambda leg: {"start_s": leg.start_s + 10.0, "settled_s": leg.settled_s + 10.0,
                                         "stop_s": leg.stop_s + 10.0})),
    Case(name="campaign file: all of the test 5 s later", cause=f"{CAMPAIGN}|start",
         change=m.both(*(m.leg(name, lambda leg: {"start_s": leg.start_s + 5.0, "settled_s": leg.settled_s + 5.0,
                                                  "stop_s": leg.stop_s + 5.0}) for name in ("M1", "M2")))),
    Case(name="campaign file: first leg settled before it begins", cause=f"{NOTHING}|{CAMPAIGN}|settled",
         change=m.leg("M1", lambda leg: {"settled_s": leg.settled_s - PERIOD / 2.0})),
    Case(name="campaign file: one phase of the second leg 0.5 rad off", cause=f"{NOTHING}|{CAMPAIGN}|phase",
         change=m.leg("M2", _lines(lambda phase: np.where(np.arange(phase.size) == 3, phase + 0.5, phase)))),
    Case(name="campaign file: phases of the second leg are none", cause=CAMPAIGN,
         change=m.leg("M2", _lines(lambda phase: 0.0 * phase))),
    Case(name="campaign file: phases of the second leg of the other sign", cause=CAMPAIGN,
         change=m.leg("M2", _lines(lambda phase: -phase))),
    Case(name="campaign file: amplitudes of the second leg halved", cause=CAMPAIGN,
         change=m.leg("M2", lambda leg: {"amplitudes_v": tuple(0.5 * one for one in leg.amplitudes_v)})),
    Case(name="campaign file: largest amplitude of the second leg twice", cause=CAMPAIGN,
         change=m.leg("M2", lambda leg: {"amplitudes_v": (2.0 * leg.amplitudes_v[0], *leg.amplitudes_v[1:])})),
    Case(name="campaign file: harmonics of the second leg one higher", cause=CAMPAIGN,
         change=m.leg("M2", lambda leg: {"harmonics": tuple(one + 1 for one in leg.harmonics)})),
    Case(name="campaign file: lines of the legs exchanged", cause=CAMPAIGN, change=m.campaign(_other_leg)),
    Case(name="campaign file: steps at other levels", cause=f"{NOTHING}|{CAMPAIGN}|St1",
         change=m.campaign(lambda trial: {"staircases": tuple(
             one.model_copy(update={"levels_v": tuple(1.0 + v for v in one.levels_v)})
             for one in trial.campaign.staircases)})),
)  # fmt: skip

SHIPS = (
    Case(name="governor with other gains at the other speed", cause="explain all legs|table", fast=True,
         ship={"governor_gain_exponent": 0.4}),
    Case(name="governor whose delay is a part of a turn", cause="explain all legs|delay|table",
         ship={"governor_delay_exponent": -1.0}),
    Case(name="governor's gains 20 % lower in the second leg", cause=ONE_LEG,
         change=m.another_ship(BETWEEN, proportional_gain=4.56, integral_gain_per_s=3.42)),
    Case(name="governor's gains 30 % lower from the middle of the second leg on", cause=f"{ONE_LEG}|explain",
         change=m.another_ship(MIDDLE, proportional_gain=4.0, integral_gain_per_s=3.0)),
    Case(name="ship's way changes between the legs: 6 % less load", cause=LOAD,
         change=m.another_ship(BETWEEN, shaft_torque_nm=1621.5, proportional_gain=5.7 / 0.94,
                               integral_gain_per_s=4.27 / 0.94)),
    Case(name="ship's way changes in the second leg: 6 % less load", cause=LOAD,
         change=m.another_ship(MIDDLE, shaft_torque_nm=1621.5, proportional_gain=5.7 / 0.94,
                               integral_gain_per_s=4.27 / 0.94)),
    Case(name="second leg of another ship", cause=f"{ONE_LEG}|explain",
         change=m.another_ship(BETWEEN, inertia_downstream_kg_m2=22.0, governor_delay_s=0.12)),
    Case(name="lever bends by 2 % per volt", cause=BEND, ship={"set_point_bend_per_v": 0.02}),
    Case(name="lever bends by 0.5 % per volt", cause=BEND,
         ship={"set_point_bend_per_v": -0.005}),
    Case(name="lever with play of 0.1 V", cause="play|hysteresis|c_set|linear|explain|scale of the set point",
         ship={"set_point_hysteresis_v": 0.1}),
    Case(name="set point held for 0.1 s by the control unit", cause=f"{NOTHING}|hold", assumption="hold",
         ship={"demand_cycle_s": 0.1}),
    Case(name="ship surges by 3 % at 0.1 Hz", cause=f"{NOTHING}|surge|swell|explain",
         ship={"noise": replace(TWO_SPEEDS.tug.noise, surge_rms=0.03, surge_hz=0.1)}),
    Case(name="rack whose rate is limited", cause="limit|rate|explain", ship={"rack_rate_limit_per_s": 0.5}),
)  # fmt: skip

KINDS_OF_LEGS = {
    "torque gauge": GAUGE,
    "pick-ups, speeds": SPEEDS,
    "set point, lever": SET_POINTS,
    "clocks, rates": CLOCKS,
    "missing stretches": GAPS,
    "vessel and campaign files": FILES,
    "ship, governor, channels": SHIPS,
}
CASES_OF_LEGS = (
    *(replace(case, test=TWO_SPEEDS) for cases in KINDS_OF_LEGS.values() for case in cases),
    *(replace(case, test=TWO_SPEEDS, fast=False) for case in CASES if case.both),
)
