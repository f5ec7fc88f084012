"""Lines that are too fast for the messages of a channel."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.signals import ChannelSignal, ExcitationSignal, SpeedSignal
from shaftprint.spectra._aliases import alias_remarks


@pytest.mark.parametrize(
    ("frequency_hz", "count"), [(4.9, 0), (5.1, 1), (12.0, 1), (26.0, 2), (51.0, 3)]
)  # half of 10 Hz torque, 50 Hz set point and 100 Hz speed
def test_each_channel_says_what_it_cannot_show(frequency_hz, count):
    one = {"channel": "x", "values": np.ones(4), "reference": 1.0}
    torque = ChannelSignal(name="M_s", value_rate_hz=10.0, **one)
    moved = ExcitationSignal(name="n_set", per_volt=1.0, value_rate_hz=50.0, **one)
    speed = SpeedSignal(name="n_e", pulse_rate_hz=100.0, **one)
    remarks = alias_remarks(frequency_hz, SimpleNamespace(channels={"M_s": torque}), speed, moved)
    assert len(remarks) == count
    if count:
        assert remarks[-1] == "above 5.00 Hz, half the rate of the shaft torque's messages: aliased"
