"""A quarter of an hour of the tug, its torque and its set point in every unit that they have: the same response."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_spectra
from shaftprint.vessel import Vessel

pytestmark = pytest.mark.slow

# A solid shaft of 0.1 m shows 1 mV/V at 5000 pi N m.
SHAFT = {"outer_diameter_m": 0.1, "shear_modulus_gpa": 80.0, "gauge_factor": 2.0}


@pytest.fixture(scope="module")
def response(short_trip, short_campaign):
    """What becomes of the voyage as another sensor shows it, by ``reading = per_v * voltage + at_zero``."""

    def shown(ship, name, *, per_v=1.0, at_zero=0.0, bent=None):
        sensor = getattr(ship.sensors, name)
        with read_recording(short_trip.path) as recording:
            raw = recording.channels[sensor.channel]
            other = replace(raw, unit=sensor.unit, scale=per_v * raw.scale, offset=per_v * raw.offset + at_zero)
            if bent is not None:
                bent_values = bent(raw.values(0, raw.count))
                other = replace(other, scale=1.0, offset=0.0, source=lambda start, stop: bent_values[start:stop])
            changed = replace(recording, channels=dict(recording.channels) | {sensor.channel: other})
            signals = prepare_signals(changed, ship, short_campaign)
        return estimate_spectra(signals, short_campaign).response

    return shown


@pytest.fixture(scope="module")
def in_volts(response, vessel):
    return response(vessel, "shaft_torque")


def with_sensor(vessel, name, fields):
    content = vessel.model_dump(exclude_none=True)
    content["sensors"][name] |= fields
    return Vessel.model_validate(content)


def expect_same(found, expected):
    assert found.lines == expected.lines
    assert (found.used == expected.used).all()
    assert found.response == pytest.approx(expected.response, rel=1e-9)
    assert found.covariance == pytest.approx(expected.covariance, rel=1e-6)


@pytest.mark.parametrize(
    ("fields", "per_v", "at_zero"),
    [
        # the tug's telemetry gives 500 N m a volt
        pytest.param({"unit": "N m", "scale_nm_per_unit": 1.0}, 500.0, 0.0, id="N m"),
        pytest.param({"unit": "kN m", "scale_nm_per_unit": 1000.0}, 0.5, 0.0, id="kN m"),
        pytest.param({"unit": "mA", "scale_nm_per_unit": 625.0, "reading_at_zero": 12.0}, 0.8, 12.0, id="mA"),
        pytest.param({"unit": "%", "scale_nm_per_unit": -50.0}, -10.0, 0.0, id="%, reversed"),
        pytest.param(
            {"unit": "mV/V", "shaft": SHAFT, "scale_nm_per_unit": 5000.0 * np.pi}, 0.1 / np.pi, 0.0, id="mV/V"
        ),
    ],
)
def test_torque_in_every_unit(response, in_volts, vessel, fields, per_v, at_zero):
    ship = with_sensor(vessel, "shaft_torque", fields)
    expect_same(response(ship, "shaft_torque", per_v=per_v, at_zero=at_zero), in_volts)


@pytest.mark.parametrize(
    ("fields", "per_v", "at_zero"),
    [
        pytest.param({"unit": "V", "v_per_unit": 2.0}, 0.5, 0.0, id="V behind a divider"),
        # -10 to 0 V are 20 to 4 mA, and 100 to 0 %
        pytest.param({"unit": "mA", "v_per_unit": -0.625, "v_at_zero": 2.5}, -1.6, 4.0, id="mA"),
        pytest.param({"unit": "%", "v_per_unit": -0.1}, -10.0, 0.0, id="%"),
        pytest.param(
            {"unit": "rpm", "v_per_unit": -0.004, "v_at_zero": -0.3, "bend_std": 0.015}, -250.0, -75.0, id="rpm"
        ),
    ],
)
def test_set_point_in_every_unit(response, in_volts, vessel, fields, per_v, at_zero):
    ship = with_sensor(vessel, "set_point", fields)
    expect_same(response(ship, "set_point", per_v=per_v, at_zero=at_zero), in_volts)


def test_a_set_point_that_is_bent_is_straightened(response, in_volts, vessel):
    """The levels of the staircase lie where the lever asks for 7 and 13 % a volt, the sines where it asks for 10."""
    volts = np.array([-9.0, -5.9, -4.1, -1.0])
    shown = np.array([41.0 + 13.0 * 3.1, 41.0, 59.0, 59.0 + 7.0 * 3.1])
    shown[0] = 41.0 - 13.0 * 3.1
    # the line of the simulated tug
    table = np.column_stack([shown, -250.97 * volts - 83.467]).tolist()
    fields = {"unit": "%", "v_per_unit": 0.1, "v_at_zero": -10.0}

    def bent(values):
        return np.interp(values, volts, shown)

    straight = response(with_sensor(vessel, "set_point", fields | {"table_rpm": table}), "set_point", bent=bent)
    used = straight.used & in_volts.used
    error = np.abs(straight.response[:, 0] / in_volts.response[:, 0] - 1.0)
    assert error.T[used].max() < 1e-5
    without = response(with_sensor(vessel, "set_point", fields), "set_point", bent=bent)
    # the staircases' line is another one then
    assert np.abs(without.response[:, 0] / in_volts.response[:, 0] - 1.0).T[used].min() > 0.05
