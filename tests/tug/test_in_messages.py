"""What of a tug comes over a bus, and what its vessel file must say for that."""

import pytest

from shaftprint.errors import SettingsError
from shaftprint.tug import Tug
from shaftprint.tug._in_messages import in_messages
from shaftprint.vessel import Vessel


def _on_a_bus(vessel, unit):
    content = vessel.model_dump()
    content["sensors"]["speed"] = [{"name": "n_x", "channel": "X", "unit": "rpm", "shaft": "engine"}]
    if unit != "V":
        content["sensors"]["set_point"] = {"channel": "P", "unit": unit, "v_per_unit": -0.05, "v_at_zero": -2.0}
    return Vessel.model_validate(content)


# steps of SPN 91 and SPN 515
@pytest.mark.parametrize(("unit", "step"), [("%", 0.4), ("rpm", 0.125)])
def test_rates_become_cycles(vessel, unit, step):
    rates_hz = {"torque": 100.0, "speed": 50.0, "set-point": 25.0}
    tug = in_messages(Tug(), _on_a_bus(vessel, unit), rates_hz=rates_hz, jitter=0.15, lost=0.01)
    assert (tug.torque_cycle_s, tug.speed_cycle_s, tug.set_point_cycle_s) == (0.01, 0.02, 0.04)
    assert (tug.set_point_resolution, tug.message_jitter, tug.messages_lost) == (step, 0.15, 0.01)
    assert in_messages(Tug(), vessel, rates_hz={}) == Tug()


def test_sensors_that_send_no_messages_are_refused(vessel):
    with pytest.raises(SettingsError, match="expected a speed in rpm, as messages hold it, found none"):
        in_messages(Tug(), vessel, rates_hz={"speed": 50.0})
    with pytest.raises(SettingsError, match="expected a set point in % or rpm, as messages hold it, found V"):
        in_messages(Tug(), _on_a_bus(vessel, "V"), rates_hz={"set-point": 50.0})
    with pytest.raises(
        SettingsError, match="expected one of torque, speed, set-point with a positive rate, found rack"
    ):
        in_messages(Tug(), vessel, rates_hz={"rack": 50.0})
