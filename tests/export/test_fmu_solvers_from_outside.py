"""Model exchange with solvers that do less than they should: the FMU helps where it can and says where it cannot."""

from itertools import pairwise

import numpy as np
import pytest

from shaftprint.catalogue import limited, structure
from shaftprint.simulation import simulate, simulate_exactly

SPEED_RPM, TORQUE_NM = 1183.8, 1740.0
GAUGE = structure("GAUGE-CLOSED"), {"t_d": 0.0703, "t_sp": 0.0518}
RATE = limited("torque", "rate"), {"t_d": 0.0703, "t_sp": 0.0518, "m_max": 2.8, "m_min": -0.3, "T_aw": 0.5, "r_x": 10.0}
VERSIONS = pytest.mark.parametrize("version", [2, 3])


def warnings_in(capsys):
    """What FMPy printed of the FMU's log; with a logger of one's own it keeps that for later runs, when it is gone."""
    return [line.partition("] ")[2] for line in capsys.readouterr().out.splitlines() if line.startswith("[WARNING]")]


def of_fmpy(path, time, set_point_rpm, kind, **more):
    """Rows of FMPy."""
    fmpy = pytest.importorskip("fmpy", reason="FMPy runs the FMU")
    columns = [("time", float), ("engine_speed_set_point", float)]
    return fmpy.simulate_fmu(
        str(path),
        input=np.array(list(zip(time, set_point_rpm, strict=True)), dtype=columns),
        start_values={"engine_speed_set_point": set_point_rpm[0]},
        stop_time=time[-1],
        step_size=time[1],
        output_interval=time[1],
        output=["engine_speed", "shaft_torque"],
        fmi_type=kind,
        **more,
    )


def at_once(rows, time):
    """First row of each instant: speed before what happens there."""
    return rows["engine_speed"][np.searchsorted(rows["time"], time - 1e-9)]


@pytest.mark.slow
@VERSIONS
def test_a_jump_between_samples_of_a_table_is_no_tenth_of_a_second_late(fmu, capsys, version):
    """FMPy's solver holds the input and steps over its jump: 3.7 of 20 rpm were missed for half a second."""
    time = np.arange(401) * 0.01
    set_point = SPEED_RPM + np.where(time >= 1.0 - 1e-9, 20.0, 0.0)
    rows = of_fmpy(fmu(*GAUGE, version=version), time, set_point, "ModelExchange")
    chosen, values = GAUGE
    trace = simulate_exactly(
        chosen, chosen.vector(values), time, {"n_set": set_point / SPEED_RPM - 1.0}, hold=True, longest_step_s=1e-3
    )
    assert np.abs(at_once(rows, time) - SPEED_RPM * (1.0 + trace.outputs["n"])).max() < 1e-4 * 20.0
    # its steps grow to a fiftieth of the 4 s, longer than the delay in the loop
    assert ["largest step" in words for words in warnings_in(capsys)] == [True]


def test_a_smooth_input_from_a_table_is_no_series_of_jumps(fmu):
    time = np.arange(401) * 0.01
    rows = of_fmpy(fmu(*GAUGE), time, SPEED_RPM + 10.0 * np.sin(time), "ModelExchange")
    assert rows.size < 2 * time.size


@pytest.mark.slow
@VERSIONS
def test_a_rate_limit_makes_no_storm_of_events(fmu, version):
    """When it let go the solver made 344,094 rows in 50 ms, a step of the limit's own for each."""
    time = np.arange(601) * 0.01
    set_point = SPEED_RPM - np.where(time >= 1.0 - 1e-9, 300.0, 0.0)
    rows = of_fmpy(fmu(*RATE, version=version), time, set_point, "ModelExchange")
    assert rows.size < 1.2 * time.size
    chosen, values = RATE
    asked = {"n_set": set_point / SPEED_RPM - 1.0}
    # the simulation takes a limited rack a step early: twice that of half the step less that of the step is prompt
    coarse, fine = (
        simulate(chosen, chosen.vector(values), time, asked, hold=True, longest_step_s=h).outputs["n"]
        for h in (1e-3, 5e-4)
    )
    assert np.abs(at_once(rows, time) - SPEED_RPM * (1.0 + 2.0 * fine - coarse)).max() < 5e-4 * 300.0


class Careless:
    """A loop of fixed steps that serves of the events what it is told to."""

    def __init__(self, own, *, asks=True, serves=True, obeys=False):
        self.own, self.asks, self.serves, self.obeys = own, asks, serves, obeys

    def run(self, time, value):
        own, found = self.own, [SPEED_RPM]
        own._x = x = np.ctypeslib.as_ctypes(np.zeros(own.description.numberOfContinuousStates))
        if self.asks:
            own._update()
        else:
            own.fmu.enterContinuousTimeMode()
        own.fmu.getContinuousStates(x, len(x))
        state = np.array(x)
        for begin, end in pairwise(time):
            state = own._go(begin, end, state, lambda t, *_: value(t))
            wants_event, _ = own.fmu.completedIntegratorStep()
            if self.obeys and wants_event:
                own.fmu.enterEventMode()
                own._update()
            found.append(own.get("engine_speed")[0])
        return np.array(found)


def expected(time, value):
    chosen, values = GAUGE
    deviation = value(time) / SPEED_RPM - 1.0
    trace = simulate(chosen, chosen.vector(values), time, {"n_set": deviation}, longest_step_s=1e-3)
    return SPEED_RPM * (1.0 + trace.outputs["n"])


def sine(time):
    return SPEED_RPM + 10.0 * np.sin(time)


@VERSIONS
@pytest.mark.parametrize("habits", [{"asks": False}, {"asks": True}, {"asks": False, "obeys": True}], ids=str)
def test_a_host_that_serves_no_events_still_gets_the_late_signals(fmu, solved, version, habits):
    """They never arrived: the speed stood still through the sine. The sine begins with a corner at zero."""
    time = np.arange(301) * 0.01
    with solved(fmu(*GAUGE, version=version)) as own:
        own.start()
        found = Careless(own, **habits).run(time, sine)
    assert np.abs(found - expected(time, sine)).max() < 2e-3 * 10.0


@VERSIONS
def test_a_solver_that_serves_events_is_not_warned(fmu, capsys, version):
    time = np.arange(101) * 0.01
    of_fmpy(fmu(*GAUGE, version=version), time, sine(time), "ModelExchange", solver="Euler")
    assert warnings_in(capsys) == []


@VERSIONS
def test_an_event_that_is_passed_is_said_once(fmu, solved, capsys, version):
    """The start is a corner, which arrives after the delay in the loop."""
    with solved(fmu(*GAUGE, version=version)) as own:
        own.start()
        own._update()
        for now in np.arange(1, 30) * 0.01:
            own.fmu.setTime(now)
            own.fmu.completedIntegratorStep()
    said = warnings_in(capsys)
    assert len(said) == 1
    assert said[0].startswith("the solver passed the event announced for 0.0703 s and stopped at 0.08 s")


@VERSIONS
def test_rates_asked_for_before_the_input_has_its_value_are_warned_of(fmu, solved, capsys, version):
    """PathSim completes a step at zero with an input of 0, before its sources have spoken."""
    with solved(fmu(*GAUGE, version=version)) as own:
        own.start()
        own._x = np.ctypeslib.as_ctypes(np.zeros(own.description.numberOfContinuousStates))
        own._update()
        own._rates(0.0, np.zeros(len(own._x)), 0.0)
    (words,) = warnings_in(capsys)
    assert "engine_speed_set_point = 0, far from the working point" in words


@VERSIONS
def test_an_input_that_was_none_yet_at_the_first_event_does_not_kick_the_line(fmu, solved, version):
    """What PathSim does: late signals began with the set point of 0, and the speed fell by 3.7 rpm after the delay."""
    with solved(fmu(*GAUGE, version=version)) as own:
        own.start()
        own.fmu.enterContinuousTimeMode()
        own.set(engine_speed_set_point=0.0)
        own.fmu.completedIntegratorStep()
        own.fmu.enterEventMode()
        found = Careless(own, obeys=True).run(np.arange(101) * 0.01, lambda time: SPEED_RPM)
    assert np.abs(found - SPEED_RPM).max() < 1e-6


@VERSIONS
@pytest.mark.parametrize("kind", ["CoSimulation", "ModelExchange"])
def test_a_run_that_begins_at_zero_is_warned_of(fmu, capsys, version, kind):
    """Some tools set every input to zero before the first value."""
    time = np.arange(11) * 0.01
    path = fmu(*GAUGE, version=version)
    rows = of_fmpy(path, time, np.zeros(time.size), kind)
    assert rows["engine_speed"][0] == pytest.approx(0.0, abs=1e-6)
    said = warnings_in(capsys)
    assert len(said) == 1
    assert "engine_speed_set_point = 0, far from the working point of 1183.8" in said[0]
    of_fmpy(path, time, np.full(time.size, 0.9 * SPEED_RPM), kind)
    assert warnings_in(capsys) == []
