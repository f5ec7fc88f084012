"""What messages do not tell of the age of their values stands beside the latency of the torque."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.signals import ChannelSignal, SpeedSignal
from shaftprint.survey import priors_of
from shaftprint.survey._fits import stated_working_point
from shaftprint.vessel import Vessel, load_vessel


@pytest.fixture
def prior():
    def latency(*, torque_hz=float("inf"), speed_hz=2000.0, **gauge):
        content = load_vessel("stan-tug-1205").model_dump()
        content["sensors"]["shaft_torque"] |= gauge
        speed = {"name": "n_e", "channel": "EngineSpeed", "shaft": "engine", "unit": "rpm", "latency_s": 0.01}
        content["sensors"]["speed"] = [speed]
        vessel, values = Vessel.model_validate(content), np.ones(4)
        torque = ChannelSignal(name="M_s", channel="M", values=values, reference=1.0, value_rate_hz=torque_hz)
        speed = SpeedSignal(name="n_e", channel="n", values=values, reference=1.0, pulse_rate_hz=speed_hz)
        nothing = SimpleNamespace(bend_std=float("inf"))
        signals = SimpleNamespace(
            working_point=stated_working_point(vessel), mode="shaftprint", channels={"M_s": torque}, excitations={},
            engine_speed=speed, rate_hz=200.0, set_point_delay=None, calibration=nothing, dc_scale_std=0.0,
        )  # fmt: skip
        return priors_of(structure("GAUGE-CLOSED"), vessel, signals)["t_gauge"]

    return latency


def test_a_period_is_counted_where_no_deviation_is_stated(prior):
    """Even over a period: its length over the root of 12, 2.89 ms of 10 ms and 5.77 ms of 20 ms."""
    alone, torque, both = (
        prior(latency_std_s=None, **rates)
        for rates in ({}, {"torque_hz": 100.0}, {"torque_hz": 100.0, "speed_hz": 50.0})
    )
    assert alone.std == pytest.approx(0.002)
    assert torque.std == pytest.approx((0.002**2 + 0.002887**2) ** 0.5, rel=1e-3)
    assert both.std == pytest.approx((0.002**2 + 0.002887**2 + 0.005774**2) ** 0.5, rel=1e-3)
    assert both.mean == alone.mean == 0.0
    assert both.sources["age of speed messages"] == pytest.approx(0.005774, rel=1e-3)


def test_a_deviation_that_is_stated_holds_the_age(prior):
    assert prior(latency_std_s=0.001, torque_hz=100.0).std == pytest.approx(0.001)
