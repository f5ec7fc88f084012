"""The time step: short enough for what is fast, and said where it cannot be."""

import numpy as np
import pytest

from shaftprint.catalogue import limited, two_mass_line
from shaftprint.errors import StructureError
from shaftprint.models import (
    Delay,
    Diagram,
    FirstOrderLag,
    Gain,
    Integrator,
    Parameter,
    PIGovernor,
    RationalBlock,
    Sensitivity,
    Structure,
    ZeroOrderHold,
    rate_limited,
)
from shaftprint.simulation import simulate

TIME = np.arange(0.0, 2.0, 0.01)
STEP = np.where(TIME >= 0.5, 1.0, 0.0)
T = Parameter("T", "s", 0.0, 1.0, 0.1, "lag")
LAG = Structure(name="lag", title="lag", input="u", outputs={"y": FirstOrderLag(T)})


def after_a_rise(t, time_constant):
    """Return a lag's answer to the straight rise from 0 to 1 within the sample before 0.5 s."""

    def ramp(t):
        return np.where(t > 0.0, t - time_constant * (1.0 - np.exp(-np.maximum(t, 0.0) / time_constant)), 0.0)

    return (ramp(t - 0.49) - ramp(t - 0.5)) / 0.01


def test_a_lag_far_shorter_than_the_step_is_followed():
    found = simulate(LAG, [0.0009], TIME, {"u": STEP}).outputs["y"]
    np.testing.assert_allclose(found, after_a_rise(TIME, 0.0009), atol=2e-3)


def test_a_lag_too_short_for_any_step_is_refused():
    with pytest.raises(StructureError, match="hold a time constant that short at zero"):
        simulate(LAG, [1e-6], TIME, {"u": STEP})


def test_a_lag_of_nothing_is_left_out_while_it_is_held():
    found = simulate(LAG.held_at(T=0.0), [0.0], TIME, {"u": STEP})
    np.testing.assert_allclose(found.outputs["y"], STEP, atol=1e-15)


@pytest.mark.parametrize("wanted", [(), ("T",)])
def test_a_lag_that_becomes_nothing_in_a_fit_is_refused(wanted):
    with pytest.raises(StructureError, match=r"division by zero .* at zero are T"):
        simulate(LAG, [0.0], TIME, {"u": STEP}, wanted=wanted)


def test_a_value_that_is_no_number_is_named():
    with pytest.raises(StructureError, match="finite values, found none of T"):
        simulate(LAG, [np.nan], TIME, {"u": STEP})


def test_first_torsional_mode_swings_as_in_small_steps():
    line = two_mass_line()
    inputs = {"M_e": 1000.0 * STEP}
    whole, tenth = (simulate(line, line.vector({}), TIME, inputs, longest_step_s=step) for step in (5e-3, 5e-4))
    worst = np.abs(whole.outputs["M_s"] - tenth.outputs["M_s"]).max()
    assert worst < 5e-3 * np.abs(tenth.outputs["M_s"]).max()


def test_a_fast_loop_with_a_delay_shorter_than_the_step_stays_stable():
    # the servo axis of the examples: 150 rad/s behind 2 ms, and a hold of 0.5 ms
    gain, late = Parameter("K", "-", 0.0, 1e4, 1500.0, "gain"), Parameter("t", "s", 0.0, 0.02, 0.002, "delay")
    mass = Parameter("m", "kg", 1.0, 100.0, 10.0, "mass")
    axis = RationalBlock(lambda m: ([1.0], [m, 50.0]), (mass,))
    loop = PIGovernor(gain, Parameter("K_i", "-", 0.0, 1e6, 2e4, "gain")) * Delay(late) * ZeroOrderHold(0.5e-3) * axis
    outer = Gain(Parameter("K_x", "1/s", 0.0, 100.0, 25.0, "gain")) * loop * Sensitivity(loop) * Integrator()
    servo = Structure(name="servo", title="servo", input="u", outputs={"x": outer * Sensitivity(outer)})
    coarse, fine = (
        simulate(servo, servo.vector({}), TIME, {"u": STEP}, longest_step_s=step).outputs["x"] for step in (5e-3, 1e-4)
    )
    np.testing.assert_allclose(coarse, fine, atol=1e-4)


def test_the_last_sample_shows_what_the_computer_took_then():
    diagram = Diagram("part", "u", ("y",), lambda flow, u, p: {"y": rate_limited(flow, u, p.T)}, (T,))
    model = Structure(name="part", title="part", input="u", outputs={"y": diagram.port("y")})
    u = np.arange(6) * 1.0
    found = simulate(model, [1.0], np.arange(6) * 1.0, {"u": u}, longest_step_s=1.0)
    np.testing.assert_allclose(found.outputs["y"], u, atol=1e-12)


def test_more_parameters_than_lanes_and_a_long_record():
    ship = limited("torque", "rate", "deadband")
    wanted = tuple(p.name for p in ship.free)
    time = 0.01 * np.arange(100_000)
    inputs = {"n_set": 0.1 * np.sin(0.5 * time)}
    every = simulate(ship, ship.vector({}), time, inputs, wanted=wanted)
    last = simulate(ship, ship.vector({}), time, inputs, wanted=wanted[-1:])
    assert len(wanted) > 16
    assert every.derivatives["n"].shape == (len(wanted), time.size)
    np.testing.assert_allclose(every.derivatives["n"][-1], last.derivatives["n"][0], atol=1e-12)
    assert np.all(np.isfinite(every.derivatives["M_s"]))


def test_what_has_faded_is_nothing():
    """Numbers near the smallest that there are take a processor a hundred times as long: e^-900 is 1e-391."""
    fading = simulate(LAG, [0.002], TIME, {"u": np.zeros(TIME.size)}, wanted=["T"], initial=[1.0])
    early = TIME <= 0.2
    assert fading.outputs["y"][early] == pytest.approx(np.exp(-TIME[early] / 0.002), rel=0.1)
    for faded in (fading.outputs["y"], fading.derivatives["y"][0]):
        assert np.all(faded[TIME > 1.8] == 0.0)
        assert np.abs(faded[faded != 0.0]).min() > 1e-215
