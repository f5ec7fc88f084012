"""A shaft that turns astern: the gauge shows it negative, and speed, torque and set point mean what they mean ahead."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.errors import SignalError
from shaftprint.signals import inspect_channels, prepare_signals
from shaftprint.signals._contradictions import contradictions
from shaftprint.vessel import SpeedSensor, Vessel


@pytest.fixture
def astern(vessel):
    content = vessel.model_dump()
    content["working_point"] |= {"direction": "astern", "shaft_torque_nm": -1725.0}
    content["propeller"]["astern_torque_coefficient"] = 0.049
    return Vessel.model_validate(content)


@pytest.fixture
def turned(spoiled):
    """The same recording with a gauge that shows the other sign, as one that counts ahead does astern."""
    return spoiled(M_s=lambda counts: -counts)


def test_what_drives_is_positive(ship, turned, vessel, astern, campaign):
    ahead, back = prepare_signals(ship.recording(), vessel, campaign), prepare_signals(turned, astern, campaign)
    assert back.shaft_torque_nm == pytest.approx(ahead.shaft_torque_nm, abs=1e-6)
    assert back.engine_speed.values == pytest.approx(ahead.engine_speed.values)
    assert back.working_point.shaft_torque_nm == pytest.approx(ahead.working_point.shaft_torque_nm)
    assert back.working_point.shaft_torque_nm > 0.0
    assert back.findings == ahead.findings


def test_zero_of_the_gauge_counts_ahead(turned, astern, campaign):
    """A gauge that shows 50 N m too much shows -1650 N m for -1700 N m; what is left is 50 N m more astern."""
    content = astern.model_dump()
    content["sensors"]["shaft_torque"]["zero_nm"] = 50.0
    with_zero = prepare_signals(turned, Vessel.model_validate(content), campaign)
    without = prepare_signals(turned, astern, campaign)
    assert with_zero.shaft_torque_nm == pytest.approx(without.shaft_torque_nm + 50.0)


def test_a_test_said_to_be_ahead_is_refused_in_one_sentence(turned, vessel, campaign):
    with pytest.raises(
        SignalError,
        match=r"channel M_s: expected a positive mean torque at the working point, found -1\d{3} N m; turn the sign "
        r'of scale_nm_per_unit .*, or state direction = "astern" of its working point where the shaft turned so\.$',
    ):
        prepare_signals(turned, vessel, campaign)


def test_a_test_said_to_be_astern_is_refused_in_one_sentence(ship, astern, campaign):
    with pytest.raises(
        SignalError,
        match=r"channel M_s: expected a negative mean torque at the working point, found 1\d{3} N m; turn the sign "
        r"of scale_nm_per_unit .*, or leave out direction of its working point where the shaft turned ahead\.$",
    ):
        prepare_signals(ship.recording(), astern, campaign)


def test_inspection_says_so_without_a_campaign(ship, turned, vessel, astern):
    assert contradictions(inspect_channels(turned, astern), astern) == ()
    (ahead,) = contradictions(inspect_channels(turned, vessel), vessel)
    assert ahead.startswith("channel M_s: expected a torque around 1725 N m, found a mean of -")
    assert 'state direction = "astern" of its working point where the shaft turned so' in ahead
    recording = ship.recording()
    (back,) = contradictions(inspect_channels(recording, astern), astern)
    assert back.startswith("channel M_s: expected a torque around -1725 N m, found a mean of 1")
    assert "leave out direction of its working point where the shaft turned ahead" in back


def test_torque_and_set_point_that_are_swapped(ship, spoiled, astern):
    swapped = spoiled(M_s=lambda counts: ship.counts["U_setpoint"], U_setpoint=lambda counts: -ship.counts["M_s"])
    # the set point is around -5 V, which 500 N m a volt make a torque of the same sign
    assert contradictions(inspect_channels(swapped, astern), astern) == ()


def with_speed(vessel, recording, make_channel, shown, **fields):
    sensor = SpeedSensor.model_validate({"name": "n_x", "channel": "X", "shaft": "propeller"} | fields)
    content = vessel.model_dump()
    content["sensors"]["speed"] = [sensor.model_dump()]
    channels = dict(recording.channels) | {"X": make_channel(shown, name="X", unit=sensor.unit, rate_hz=2000.0)}
    return replace(recording, channels=channels), Vessel.model_validate(content)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_an_instrument_of_the_shaft_shows_it_or_does_not(ship, turned, astern, campaign, make_channel, sign):
    shown = sign * 60.0 * ship.speed_rev_s / 3.82
    recording, vessel = with_speed(astern, turned, make_channel, shown, unit="rpm")
    speed = prepare_signals(recording, vessel, campaign).engine_speed.values
    assert speed.mean() == pytest.approx(ship.speed_rev_s.mean(), rel=1e-3)


def test_an_instrument_of_the_engine_does_not_turn_back(ship, turned, astern, campaign, make_channel):
    recording, vessel = with_speed(astern, turned, make_channel, -60.0 * ship.speed_rev_s, unit="rpm", shaft="engine")
    with pytest.raises(SignalError, match="channel X: expected a speed ahead, found a mean of -"):
        prepare_signals(recording, vessel, campaign)


@pytest.mark.parametrize("sign", [-1.0, 1.0])
def test_an_encoder_that_counts_the_other_way_is_said_so(ship, turned, astern, campaign, make_channel, sign):
    degrees = (sign * 360.0 * ship.angle_rev / 3.82) % 360.0
    recording, vessel = with_speed(astern, turned, make_channel, degrees, unit="deg")
    signals = prepare_signals(recording, vessel, campaign)
    assert signals.engine_speed.values.mean() == pytest.approx(ship.speed_rev_s.mean(), rel=1e-3)
    said = "channel X counts up while the shaft turns astern: its sign was turned"
    assert (said in signals.findings) == (sign > 0.0)
    assert np.all(signals.engine_speed.values > 0.0)
