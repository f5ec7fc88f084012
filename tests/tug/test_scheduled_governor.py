"""Gains and delay that go with the speed, and a generator with steps, against what they must do."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.campaign import setpoint
from shaftprint.errors import SettingsError
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel

Make = Callable[..., Any]
SHARE = 0.75
VOLTS = -(0.75 * 1183.8 + 83.467) / 250.97 + 0.04947603299199


def _rpm(vessel: Vessel, tug: Tug, campaign: Any) -> Any:
    return 60.0 * simulate_signals(vessel, campaign, tug=tug).engine_speed_rev_s


@pytest.mark.parametrize(
    ("power", "constant"),
    [
        (
            {"governor_gain_exponent": 0.5},
            {"proportional_gain": 5.7 * SHARE**0.5, "integral_gain_per_s": 4.27 * SHARE**0.5},
        ),
        ({"governor_delay_exponent": -1.0}, {"governor_delay_s": 0.0703 / SHARE}),
    ],
)
def test_at_a_level_of_its_own_the_governor_is_that_of_the_level(
    vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make, power: dict[str, float], constant: dict[str, float]
) -> None:
    small, offset = 0.002, {"offset_v": VOLTS}
    campaign = ask(25.0, sines=[sine(1.0, small)], **offset)
    scheduled = _rpm(vessel, replace(quiet_tug, **power), campaign)
    alike = _rpm(vessel, replace(quiet_tug, **constant), campaign)
    other = _rpm(vessel, quiet_tug, campaign)
    assert scheduled.mean() == pytest.approx(SHARE * 1183.8, rel=1e-4)
    # what is left goes with the square of the swing
    assert np.ptp(scheduled - alike) < 0.005 * np.ptp(alike)
    assert np.ptp(scheduled - other) > 0.05 * np.ptp(alike)


def test_at_the_working_point_nothing_is_changed(vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make) -> None:
    campaign = ask(25.0, sines=[sine(1.0, 0.002)])
    tug = replace(quiet_tug, governor_gain_exponent=0.5, governor_delay_exponent=-1.0)
    plain = _rpm(vessel, quiet_tug, campaign)
    assert np.ptp(_rpm(vessel, tug, campaign) - plain) < 0.005 * np.ptp(plain)


def test_a_generator_holds_its_voltage_in_steps(
    vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make, tmp_path: Any
) -> None:
    campaign = ask(25.0, sines=[sine(0.2, 0.5)])
    step_v, cycle_s = 20.0 / 2**12, 0.02
    tug = replace(quiet_tug, generator_step_v=step_v, generator_cycle_s=cycle_s)
    signals = simulate_signals(vessel, campaign, tug=tug, rate_hz=2000.0)
    volts = (60.0 * signals.set_point_rev_s + 83.467) / -250.97 - tug.set_point_offset_v
    assert volts / step_v == pytest.approx(np.rint(volts / step_v), abs=1e-6)
    held = volts.reshape(-1, 40)
    assert np.ptp(held, axis=1).max() < 1e-9
    middle = setpoint(campaign, signals.time_s.reshape(-1, 40)[:, 20])
    assert np.abs(held[:, 0] - middle).max() <= 0.5 * step_v * 1.001
    truth = sail(vessel, campaign, tmp_path / "log.nc", tug=tug, seed=1)
    assert truth.physical["generator_step_v"] == step_v
    assert truth.physical["generator_cycle_s"] == cycle_s


@pytest.mark.parametrize("name", ["generator_step_v", "generator_cycle_s"])
def test_a_generator_without_steps_is_none(vessel: Vessel, quiet_tug: Tug, ask: Make, name: str) -> None:
    with pytest.raises(SettingsError, match=f"expected {name} above 0, found 0"):
        simulate_signals(vessel, ask(), tug=replace(quiet_tug, **{name: 0.0}))


def test_a_delay_that_becomes_too_short_is_refused(vessel: Vessel, quiet_tug: Tug, ask: Make) -> None:
    # a quarter of 5 ms at four times the speed, three steps of 0.5 ms are 1.5 ms
    short = replace(quiet_tug, governor_delay_s=0.005, governor_delay_exponent=-1.0)
    with pytest.raises(SettingsError, match=r"at least 0\.006, three steps of the simulation at every speed"):
        simulate_signals(vessel, ask(), tug=short)
