"""An elastic coupling in the simulated ship: its mode by hand, its rigid limit, its steps and its linear response."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from tests.tug.ideal_signals import simulate_signals
from tests.tug.linearised import linearised_response

from shaftprint.errors import SettingsError
from shaftprint.tug import Coupling, Tug, build_plant, derivatives, like_stan_tug_1205, normalised_truth
from shaftprint.tug.plant._disturbance import Disturbance
from shaftprint.tug.plant._physics import equilibrium
from shaftprint.tug.plant._plant import ENGINE, SPEED, TWIST
from shaftprint.tug.plant._voyage import voyage
from shaftprint.vessel import Vessel, load_vessel

Make = Callable[..., Any]
UPSTREAM, DOWNSTREAM = 54.006, 17.0
SPEED_S = 1183.8 / 60.0 / 3.82
SOFT = Coupling(stiffness_nm_rad=40e3, damping_nm_s_rad=60.0, driven_kg_m2=12.0)


def elastic(coupling: Coupling = SOFT, **given: Any) -> Tug:
    return Tug(coupling=coupling, **given)


def test_free_line_swings_at_the_frequency_of_two_masses_and_a_spring(vessel: Vessel) -> None:
    """``f = sqrt(k (1 / J_1 + 1 / J_2)) / (2 pi)``, J_1 ahead of the coupling and J_2 all behind it, undamped."""
    plant = build_plant(elastic(replace(SOFT, damping_nm_s_rad=0.0)), vessel)
    state = equilibrium(plant, SPEED_S * 3.82)
    slope = np.empty((3, 3))
    places, rates = [SPEED, ENGINE, TWIST], [0, 10, 11]
    for column, place in enumerate(places):
        shift = np.zeros(state.size)
        shift[place] = 1e-5
        # the rack stands still: it is not the governor that swings the line
        up, down = (
            derivatives.py_func(state + sign * shift, SPEED_S * 3.82, 0.0, 0.0, 0.0, plant) for sign in (1.0, -1.0)
        )
        slope[:, column] = [(up[rate] - down[rate]) / 2e-5 for rate in rates]
    swings = np.linalg.eigvals(slope)
    found_hz = np.abs(swings.imag).max() / (2.0 * np.pi)
    by_hand_hz = np.sqrt(40e3 * (1.0 / (UPSTREAM - 12.0) + 1.0 / (DOWNSTREAM + 12.0))) / (2.0 * np.pi)
    # the slope of the propeller torque, 2 M_s0 / n_s0, damps the mode and takes 1e-3 of its frequency at most
    assert found_hz == pytest.approx(by_hand_hz, rel=1e-3)


def test_stiff_coupling_is_a_rigid_line(vessel: Vessel) -> None:
    frequency = np.geomspace(0.02, 2.0, 9)
    stiff = linearised_response(
        elastic(replace(SOFT, stiffness_nm_rad=1e12)), vessel, frequency, outputs=("n", "M_s", "X")
    )
    assert stiff == pytest.approx(linearised_response(Tug(), vessel, frequency, outputs=("n", "M_s", "X")), rel=1e-6)


def test_line_starts_twisted_by_the_torque_it_carries(vessel: Vessel) -> None:
    """All that the propeller takes goes through the coupling: ``phi = M_s0 / k`` in rad."""
    state = equilibrium(build_plant(elastic(), vessel), SPEED_S * 3.82)
    assert 2.0 * np.pi * state[TWIST] == pytest.approx(1725.0 / 40e3, rel=1e-9)
    assert state[ENGINE] == state[SPEED]


@pytest.mark.parametrize("frequency_hz", [1.0, 5.5])
def test_stepped_line_follows_a_small_sine_as_linearised(
    vessel: Vessel, ask: Make, sine: Make, frequency_hz: float
) -> None:
    """Below the mode and near it: the kernel's steps against the response."""
    tug = elastic()
    campaign = ask(36.0, sines=[sine(frequency_hz, 0.01) | {"settled_s": 24.0, "stop_s": 34.01}])
    signals = simulate_signals(vessel, campaign, tug=tug, rate_hz=400.0)
    late = (signals.time_s >= 24.0) & (signals.time_s < 34.0)
    phase = 2.0 * np.pi * frequency_hz * signals.time_s[late]
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)

    def part(values: np.ndarray) -> complex:
        cosine, sine_part, mean = np.linalg.lstsq(columns, values[late], rcond=None)[0]
        return complex(cosine, -sine_part) / mean

    set_point = part(signals.set_point_rev_s)
    found = np.array([part(signals.engine_speed_rev_s), part(signals.shaft_torque_nm)]) / set_point
    expected = linearised_response(tug, vessel, [frequency_hz])[:, 0, 0]
    assert found == pytest.approx(expected, rel=2e-3)


def test_engine_turns_ahead_of_the_coupling_by_its_twist(vessel: Vessel, quiet_tug: Tug, ask: Make, sine: Make) -> None:
    """``n / n_1 = (c s + k) / (J s^2 + (c + q) s + k)``, J behind the coupling, q the slope of the load."""
    frequency_hz, step_s = 4.0, 1e-3
    campaign = ask(25.0, sines=[sine(frequency_hz, 0.01) | {"settled_s": 20.0, "stop_s": 24.01}])
    quiet = Disturbance(quiet_tug.noise, step_s, np.random.default_rng(1))
    tug = replace(quiet_tug, coupling=SOFT)
    (stretch,) = voyage(tug, vessel, campaign, step_s=step_s, steps=24000, chunk=24000, disturbance=quiet)
    late = stretch.time_s >= 20.0
    phase = 2.0 * np.pi * frequency_hz * stretch.time_s[late]
    columns = np.stack([np.cos(phase), np.sin(phase), np.ones_like(phase)], axis=1)

    def part(values: np.ndarray) -> complex:
        cosine, sine_part, _ = np.linalg.lstsq(columns, values[late], rcond=None)[0]
        return complex(cosine, -sine_part)

    s, slope = 2j * np.pi * frequency_hz, 2.0 * 1725.0 / (2.0 * np.pi * SPEED_S)
    expected = (60.0 * s + 40e3) / ((DOWNSTREAM + 12.0) * s**2 + (60.0 + slope) * s + 40e3)
    found = part(stretch.shaft_speed_rev_s) / part(stretch.engine_speed_rev_s)
    assert abs(expected) > 1.5
    assert found == pytest.approx(expected, rel=2e-3)
    # the angles are those of the speeds
    moved = part(stretch.engine_angle_rev - stretch.shaft_angle_rev)
    assert moved * s == pytest.approx(part(stretch.engine_speed_rev_s - stretch.shaft_speed_rev_s), rel=2e-3)


def test_truth_is_told_normalised_and_in_si(vessel: Vessel) -> None:
    told = normalised_truth(elastic(), vessel)
    assert told["k_c"] == pytest.approx(2.0 * np.pi * SPEED_S * 40e3 / 1725.0, rel=1e-9)
    assert told["d_c"] == pytest.approx(2.0 * np.pi * SPEED_S * 60.0 / 1725.0, rel=1e-9)
    assert told["tau_m"] == pytest.approx(2.0 * np.pi * SPEED_S * 12.0 / 1725.0, rel=1e-9)
    assert "k_c" not in normalised_truth(Tug(), vessel)


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"stiffness_nm_rad": 0.0}, "stiffness_nm_rad above 0"),
        ({"damping_nm_s_rad": -1.0}, "damping_nm_s_rad of at least 0"),
        ({"driven_kg_m2": 60.0}, "driven_kg_m2 from 0 to below"),
    ],
)
def test_impossible_coupling_is_refused(vessel: Vessel, change: dict[str, float], said: str) -> None:
    with pytest.raises(SettingsError, match=said):
        build_plant(elastic(replace(SOFT, **change)), vessel)


def test_ship_of_a_vessel_file_with_one_spring_has_its_coupling() -> None:
    """15 kN m/rad behind 7.8 kg m2 at 1800 rpm are 569 kN m/rad at a shaft that turns 6.16 times slower."""
    coupling = like_stan_tug_1205(load_vessel("pt-may")).coupling
    assert coupling is not None
    square = 6.16**2
    assert coupling.stiffness_nm_rad == pytest.approx(15e3 * square)
    assert coupling.driven_kg_m2 == pytest.approx(0.65 * square + 6.0)
    omega = np.sqrt(15e3 * square * (1.0 / (7.8 * square) + 1.0 / (0.65 * square + 6.0 + 70.9)))
    assert coupling.damping_nm_s_rad == pytest.approx(15e3 * square * 0.9 / (2.0 * np.pi * omega))


def test_ship_of_many_springs_is_sailed_rigid(vessel: Vessel) -> None:
    assert like_stan_tug_1205(vessel).coupling is None
