"""Orders in the torque: made lines of known response, known orders, and the simulated tug."""

from dataclasses import replace

import numpy as np
import pytest
from tests.tug.linearised import linearised_response

from shaftprint.campaign import Campaign, Sine, Staircase
from shaftprint.identify import planned_response
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.signals._orders import TrackedOrder, tracked_orders
from shaftprint.spectra import estimate_spectra
from shaftprint.spectra.orders._gears import with_measured_gears
from shaftprint.spectra.orders._order_fit import fit_orders
from shaftprint.spectra.orders._order_waves import order_bands, turns_of
from shaftprint.survey import STAN_TUG_NOISE
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel, load_vessel

RATE_HZ, SPEED_REV_S = 100.0, 20.0
SHAFT = TrackedOrder(name="shaft order 1", per_turn=0.25, speed="n_e")
LINE_HZ = 4.9
SPEED_OVER_SET_POINT, TORQUE_OVER_SET_POINT = 0.02 - 0.01j, 0.30 + 0.35j


@pytest.fixture
def made(make_signals, make_campaign):
    """A sine beside shaft order 1 at 5 Hz, the speed wandering slowly, and white noise in the torque."""

    def make(seed, *, hertz=LINE_HZ, order=0.09, wander=0.01, noise=0.02, seconds=40.0):
        rng = np.random.default_rng(seed)
        time_s = np.arange(round((seconds + 5.0) * RATE_HZ)) / RATE_HZ
        wave = 0.1 * np.exp(2j * np.pi * hertz * time_s)
        speed = (SPEED_OVER_SET_POINT * wave).real + wander * np.sin(2.0 * np.pi * time_s / 13.0)
        turns = np.cumsum(SPEED_REV_S * (1.0 + speed)) / RATE_HZ
        ripple = order * np.cos(2.0 * np.pi * (SHAFT.per_turn * turns) + rng.uniform(0.0, 6.28))
        torque = (TORQUE_OVER_SET_POINT * wave).real + (1.0 + speed) ** 2 * ripple
        torque += 2.0 * (speed - (SPEED_OVER_SET_POINT * wave).real) + noise * rng.standard_normal(time_s.size)
        speed = speed + 1e-5 * rng.standard_normal(time_s.size)
        signals = make_signals(wave.real, torque, {"n_e": speed}, rate_hz=RATE_HZ, orders=(SHAFT,))
        return signals, make_campaign(("S1", hertz, 1.0, 1.0 + seconds), amplitude_v=0.5)

    return make


def _torque(spectra):
    """Error of the torque response and its stated standard deviation."""
    response = spectra.response
    error = abs(response.response[1, 0, 0] - TORQUE_OVER_SET_POINT)
    return error, float(np.sqrt(response.covariance[0, 1, 1] + response.covariance[0, 3, 3]))


def test_fitted_orders_scatter_as_stated_and_count_one_degree_of_freedom_a_number():
    rng = np.random.default_rng(3)
    waves = rng.standard_normal((4, 60)) + 1j * rng.standard_normal((4, 60))
    truth = np.array([0.3, -0.2, 0.05, 0.1])
    chosen = np.arange(60) % 7 != 0
    z = []
    for _ in range(400):
        noise = 0.1 * (rng.standard_normal(60) + 1j * rng.standard_normal(60))
        fit = fit_orders(truth @ waves + noise, waves, chosen)
        z.append(np.linalg.solve(np.linalg.cholesky(fit.covariance), fit.coefficient - truth))
        # four real numbers are two complex ones; next to nothing is known beforehand
        assert fit.taken.sum() == pytest.approx(2.0, rel=1e-3)
        assert not fit.taken[~chosen].any()
    assert np.mean(np.square(z)) == pytest.approx(1.0, abs=0.1)


def test_a_line_beside_an_order_has_its_response_and_a_small_deviation(made):
    with_order, without = [], []
    for seed in range(30):
        signals, campaign = made(seed)
        with_order.append(_torque(estimate_spectra(signals, campaign)))
        signals, campaign = made(seed, order=0.0)
        without.append(_torque(estimate_spectra(replace(signals, orders=()), campaign)))
    error, std = np.array(with_order).T
    assert np.sqrt(np.mean((error / std) ** 2)) == pytest.approx(1.0, abs=0.25)
    # as well known as if there were no order
    assert np.median(std) < 1.2 * np.median(np.array(without)[:, 1])


def test_without_orders_in_the_record_the_response_stays(made):
    for seed in range(5):
        signals, campaign = made(seed, order=0.0)
        searched, plain = (estimate_spectra(one, campaign) for one in (signals, replace(signals, orders=())))
        change = abs(searched.response.response - plain.response.response)[1, 0, 0]
        assert change < 0.5 * _torque(plain)[1]
        assert searched.response.response[0] == plain.response.response[0]
        assert _torque(searched)[1] == pytest.approx(_torque(plain)[1], rel=0.2)
        assert searched.response.degrees_of_freedom[0] < plain.response.degrees_of_freedom[0]


def test_a_line_exactly_on_an_order_at_constant_speed_loses_its_torque_and_says_so(made):
    signals, campaign = made(1, hertz=5.0, wander=0.0)
    spectra = estimate_spectra(signals, campaign)
    error, std = _torque(spectra)
    # the order is 0.9 of the set point's sine, and nothing else in the record tells the two apart
    assert error < 2.0 * std
    assert std > 0.5
    assert "shaft order 1 (" in spectra.remarks["S1"]
    assert "hardly told from it" in spectra.remarks["S1"]


def test_the_speed_of_such_a_line_is_as_well_known_as_before(made):
    signals, campaign = made(1, hertz=5.0, wander=0.0)
    searched, plain = (estimate_spectra(one, campaign).response for one in (signals, replace(signals, orders=())))
    assert searched.response[0, 0, 0] == plain.response[0, 0, 0]
    assert searched.covariance[0, 0, 0] == pytest.approx(plain.covariance[0, 0, 0], rel=0.2)


def test_slow_lines_are_left_alone(made):
    signals, campaign = made(2, hertz=0.5)
    searched, plain = (estimate_spectra(one, campaign).response for one in (signals, replace(signals, orders=())))
    assert np.array_equal(searched.response, plain.response)
    assert np.array_equal(searched.covariance, plain.covariance)


def test_an_order_through_rounded_gears_is_found_where_it_is(made):
    """A ratio off by 0.13 % turns the order by one turn and a third in 200 s."""
    rounded = replace(SHAFT, per_turn=SHAFT.per_turn * 1.0013)
    through = replace(rounded, through_gears=True)
    z, ratios = [], []
    for seed in range(20):
        signals, campaign = made(seed, seconds=200.0)
        exact, blind, measured = (
            _torque(estimate_spectra(replace(signals, orders=(order,)), campaign))
            for order in (SHAFT, rounded, through)
        )
        z.append(measured[0] / measured[1])
        ratios.append((measured[1] / exact[1], blind[1] / exact[1]))
    assert np.sqrt(np.mean(np.square(z))) == pytest.approx(1.0, abs=0.3)
    found, lost = np.median(ratios, axis=0)
    assert found == pytest.approx(1.0, abs=0.1)
    assert lost > 2.0


@pytest.mark.parametrize("error", [0.0, 3e-4, -1.2e-3])
def test_the_ratio_is_measured_beside_lines_that_are_left_out(error):
    """A leg of ten periods of 34.3 s in which the shaft turns 60.94 times a period: the order stands beside a line."""
    rate_hz, periods, period_s = 25.0, 10, 34.3
    samples = round(periods * period_s * rate_hz)
    time_s = np.arange(samples) / rate_hz
    swing = sum(0.05 * np.cos(2.0 * np.pi * k * time_s / period_s + k) for k in (1, 3, 5))
    speed = 60.94 / period_s / SHAFT.per_turn * (1.0 + swing)
    load = (1.0 + swing) ** 2
    angle = 2.0 * np.pi * SHAFT.per_turn * (1.0 + error) * turns_of(speed, rate_hz)
    through = replace(SHAFT, through_gears=True)
    chosen = np.zeros(samples // 2 + 1, dtype=bool)
    chosen[periods * 45 : periods * 80] = True
    chosen[periods :: 2 * periods] = False
    measured = []
    for seed in range(12):
        rng = np.random.default_rng(seed)
        torque = load * 0.09 * np.cos(angle + rng.uniform(0.0, 6.28)) + 0.05 * rng.standard_normal(samples)
        (band,) = with_measured_gears(
            order_bands([through], {"n_e": speed}, rate_hz=rate_hz),
            {"n_e": speed},
            load,
            np.fft.rfft(torque),
            chosen,
            rate_hz=rate_hz,
            transform=lambda waves: np.fft.rfft(waves, axis=1),
        )
        measured.append(band.order.per_turn / SHAFT.per_turn - 1.0)
    # a tone's frequency is known to sqrt(6 / samples) sigma / (pi a T): over 609 turns
    std = np.sqrt(6.0 / samples) * 0.05 / (np.pi * 0.09) / 609.4
    z = (np.array(measured) - error) / std
    assert np.sqrt(np.mean(z**2)) < 1.6
    assert abs(z.mean()) < 1.0


def test_without_the_order_in_the_record_rounded_gears_change_nothing(made):
    signals, campaign = made(4, order=0.0)
    through = replace(SHAFT, through_gears=True)
    responses = [
        estimate_spectra(replace(signals, orders=(order,)), campaign).response.response for order in (SHAFT, through)
    ]
    assert np.array_equal(*responses)


@pytest.mark.parametrize(
    ("sensors", "expected"),
    [(("n_e", "n_e4"), ("n_e4", False, "n_e", False)), (("n_e",), ("n_e", True, "n_e", False))],
)
def test_an_order_turns_with_the_finest_pick_up_of_its_shaft(sensors, expected):
    vessel = load_vessel("stan-tug-1205")
    orders = {one.name: one for one in tracked_orders(vessel, dict.fromkeys(sensors))}
    shaft, engine = orders["shaft order 1"], orders["engine order 1/2"]
    assert (shaft.speed, shaft.through_gears, engine.speed, engine.through_gears) == expected


def test_an_encoder_counts_the_turns_of_its_shaft_and_an_instrument_does_not():
    content = load_vessel("stan-tug-1205").model_dump()
    pick_up = content["sensors"]["speed"][0]
    for unit, through_gears in (("deg", False), ("rpm", True)):
        one = {"name": "n_x", "channel": "X", "shaft": "propeller", "unit": unit}
        content["sensors"]["speed"] = [pick_up, one]
        vessel = Vessel.model_validate(content)
        orders = {order.name: order for order in tracked_orders(vessel, dict.fromkeys(("n_e", "n_x")))}
        assert orders["shaft order 1"].through_gears == through_gears


def test_in_thesis_mode_orders_stay_in_and_a_line_on_one_says_so(made):
    signals, campaign = made(1)
    thesis = replace(signals, mode="thesis")
    spectra = estimate_spectra(thesis, campaign)
    assert np.array_equal(
        spectra.response.response, estimate_spectra(replace(thesis, orders=()), campaign).response.response
    )
    assert "S1" not in spectra.remarks
    signals, campaign = made(1, hertz=5.0)
    spectra = estimate_spectra(replace(signals, mode="thesis"), campaign)
    assert "stands on shaft order 1 (4.94 to 5.06 Hz), which was left in the torque" in spectra.remarks["S1"]


@pytest.mark.slow
def test_a_line_at_the_shaft_order_of_the_simulated_tug_is_off_by_its_stated_deviation(tmp_path):
    vessel = load_vessel("stan-tug-1205")
    sine = {"amplitude_v": 0.6, "start_s": 130.0, "settled_s": 135.0, "stop_s": 175.0}
    campaign = Campaign(
        name="line at the shaft order",
        duration_s=180.0,
        offset_v=-5.0,
        staircases=(Staircase(name="St1", levels_v=(-4.0, -5.0, -6.0, -5.0), dwell_s=25.0, start_s=10.0),),
        sines=(Sine(name="S1", frequency_hz=5.16, **sine),),
    )
    expected = linearised_response(Tug(), vessel, [5.16])[1, 0, 0]
    before, after = [], []
    for seed in range(6):
        sail(vessel, campaign, tmp_path / f"{seed}.nc", seed=seed)
        with read_recording(tmp_path / f"{seed}.nc") as recording:
            signals = prepare_signals(recording, vessel, campaign)
        for one, errors in ((replace(signals, orders=()), before), (signals, after)):
            response = estimate_spectra(one, campaign).response
            std = np.sqrt(response.covariance[0, 1, 1] + response.covariance[0, 3, 3])
            errors.append((abs(response.response[1, 0, 0] - expected), std))
        assert "shaft order 1" in estimate_spectra(signals, campaign).remarks["S1"]
    (old, old_std), (new, new_std) = np.array(before).T, np.array(after).T
    assert np.sqrt(np.mean((old / old_std) ** 2)) > 5.0
    assert np.sqrt(np.mean((new / new_std) ** 2)) < 1.6
    assert np.sqrt(np.mean(new**2)) < 0.1 * np.sqrt(np.mean(old**2))
    planned = planned_response(campaign, STAN_TUG_NOISE)
    assert "beside an order of the shaft" in planned.remarks["S1"]
    predicted = np.sqrt(planned.covariance[0, 1, 1] + planned.covariance[0, 3, 3])
    # on the safe side: the stored level at 5.16 Hz is on a straight line between 3.4 and 7.2 Hz
    assert 0.8 < predicted / np.sqrt(np.mean(new_std**2)) < 2.5
