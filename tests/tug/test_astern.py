"""A simulated ship whose shaft turns astern: the mirror of the one ahead, and what its sensors show of it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals

from shaftprint.errors import SettingsError
from shaftprint.recording import read_recording
from shaftprint.tug import Coupling, Noise, Sailing, Tug, build_plant, normalised_truth, sail
from shaftprint.tug.plant._physics import equilibrium
from shaftprint.vessel import SpeedSensor, Vessel, load_vessel

Make = Callable[..., Any]
SPEED_S, TORQUE_NM = 1183.8 / 60.0 / 3.82, 1725.0


@pytest.fixture(scope="module")
def astern() -> Vessel:
    return load_vessel("stan-tug-1205-astern")


LINES = {
    "rigid": {},
    "inflow": {"inflow_gain": 1.0, "inflow_time_s": 0.1},
    "elastic": {"coupling": Coupling(stiffness_nm_rad=60e3, damping_nm_s_rad=40.0)},
    "smoke": {"unboosted_torque_share": 0.5, "turbocharger_lag_s": 1.3},
}


@pytest.mark.parametrize("given", LINES.values(), ids=LINES)
def test_same_numbers_astern_are_the_mirror_of_those_ahead(
    vessel: Vessel, astern: Vessel, ask: Make, given: dict[str, Any]
) -> None:
    """The water takes the square of the speed either way: the engine does the same, the torque has the other sign."""
    jumps = {"name": "St", "levels_v": [-4.0, -6.0, -4.0], "dwell_s": 4.0, "start_s": 0.0}
    campaign = ask(12.0, staircases=[jumps])
    one, other = (simulate_signals(ship, campaign, tug=Tug(**given), seed=3) for ship in (vessel, astern))
    assert other.engine_speed_rev_s == pytest.approx(one.engine_speed_rev_s, rel=1e-12)
    assert other.brake_torque_nm == pytest.approx(one.brake_torque_nm, rel=1e-9, abs=1e-9)
    assert other.shaft_torque_nm == pytest.approx(-one.shaft_torque_nm, rel=1e-9, abs=1e-9)
    assert other.shaft_torque_nm.max() < 0.0
    assert np.array_equal(other.limited, one.limited)


def test_steady_line_astern_by_hand(astern: Vessel, quiet_tug: Tug) -> None:
    plant = build_plant(quiet_tug, astern)
    state = equilibrium(plant, 1183.8 / 60.0)
    assert state[0] == pytest.approx(-SPEED_S)
    assert plant.propeller_nm_s2 * state[0] * abs(state[0]) == pytest.approx(-TORQUE_NM)
    # the rack drives the engine as ahead: 1725 / (3.82 0.97) N m out of 1172.44 of full rack
    assert state[2] == pytest.approx(TORQUE_NM / (3.82 * 0.97) / 1172.44, rel=1e-4)


def test_truth_has_the_meaning_that_it_has_ahead(vessel: Vessel, astern: Vessel, quiet_tug: Tug) -> None:
    assert normalised_truth(quiet_tug, astern) == pytest.approx(normalised_truth(quiet_tug, vessel))


INSTRUMENTS = (
    SpeedSensor(name="rpm", channel="rpm_s", shaft="propeller", unit="rpm"),
    SpeedSensor(name="rpm_e", channel="rpm_e", shaft="engine", unit="rpm"),
    SpeedSensor(name="angle", channel="angle", shaft="propeller", unit="deg", rolls_over_at=360.0),
)


def test_channels_show_what_a_logger_shows(tmp_path: Path, astern: Vessel, quiet: Noise, ask: Make) -> None:
    sensors = astern.sensors.model_copy(update={"speed": (*astern.sensors.speed, *INSTRUMENTS)})
    ship = astern.model_copy(update={"sensors": sensors})
    tug = Tug(noise=quiet, torque_zero_offset_nm=50.0)
    truth = sail(ship, ask(12.0), tmp_path / "astern.nc", tug=tug, seed=1)
    with read_recording(tmp_path / "astern.nc") as recording:
        shown = {name: one.values(0, one.count) for name, one in recording.channels.items()}
    volts, shaft_rpm, engine_rpm, angle = (shown[name] for name in ("M_s", "rpm_s", "rpm_e", "angle"))
    pulses = {name: shown[name] > 2.0 for name in ("PTM_e", "PTM_1", "PTM_4")}
    # the gauge counts ahead, its zero too: -1725 + 50 N m at 500 N m a volt
    assert volts.mean() == pytest.approx((-TORQUE_NM + 50.0) / 500.0, abs=5e-3)
    assert shaft_rpm.mean() == pytest.approx(-60.0 * SPEED_S, rel=1e-3)
    assert engine_rpm.mean() == pytest.approx(1183.8, rel=1e-3)
    turned = np.diff(np.unwrap(np.radians(angle))).sum() / (2.0 * np.pi)
    assert turned == pytest.approx(-12.0 * SPEED_S, rel=2e-3)
    # pulses have no sign
    rising = {name: int(np.count_nonzero(np.diff(one.astype(int)) == 1)) for name, one in pulses.items()}
    expected = {"PTM_e": 1183.8 / 60.0 * 12.0, "PTM_1": 12.0 * SPEED_S, "PTM_4": 4.0 * 12.0 * SPEED_S}
    assert rising == pytest.approx(expected, abs=1.01)
    assert truth.physical["gear_ratio"] == -3.82
    # strips pass in their other order
    angles = {one.channel: one.angle_deg for one in truth.strips}
    ahead = np.array(tug.strip_angles_deg) / np.sum(tug.strip_angles_deg) * 360.0
    assert angles["PTM_4"] == pytest.approx(ahead[::-1])


def test_a_ship_astern_does_not_sail_free(astern: Vessel) -> None:
    with pytest.raises(SettingsError, match=r"expected a tug that stands still where vessel .* says astern"):
        build_plant(replace(Tug(), sailing=Sailing()), astern)
