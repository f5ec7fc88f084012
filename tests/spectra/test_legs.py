"""Legs of known content: a line with an inertia and a quadratic propeller, moved by all lines at once."""

import re
from dataclasses import replace

import numpy as np
import pytest
from tests.made_signals import made_channels, with_channels
from tests.spectra.legs_by_speed import estimate_legs

from shaftprint.campaign import Campaign, Multisine
from shaftprint.signals import LegState, SetPointCalibration, Signals, WorkingPoint
from shaftprint.signals._orders import TrackedOrder
from shaftprint.spectra.legs._leg_lines import leg_freedom
from shaftprint.spectra.lines._noise import LineNoise

SPEED_REV_S, TORQUE_NM, RATE_HZ = 14.0, 830.0, 100.0
INERTIA_S = 0.27
HARMONICS = (1, 3, 5, 9, 15, 21)
PERIOD_S, PERIODS = 8.0, 9
LEG = Multisine(
    name="M1",
    level_v=-3.6,
    period_s=PERIOD_S,
    harmonics=HARMONICS,
    amplitudes_v=(0.2, 0.15, 0.15, 0.1, 0.1, 0.2),
    phases_rad=(0.1, 1.3, 2.9, 0.4, 4.0, 5.5),
    start_s=2.0,
    settled_s=10.0,
    stop_s=10.0 + PERIOD_S * PERIODS,
)
CAMPAIGN = Campaign(name="made", duration_s=90.0, offset_v=-3.6, ramp_s=1.0, multisines=(LEG,))
PER_VOLT = -4.0
# 2.59 Hz at the mean speed, beside the fastest line at 2.625 Hz, and 2.3 to 2.9 Hz as the speed swings
ORDER = TrackedOrder(name="shaft order 1", per_turn=0.185, speed="n_e")


def speed_over_set_point(omega_rad_s):
    return np.exp(-0.12j * omega_rad_s) / (1.0 + 0.3j * omega_rad_s)


def made_leg(
    *,
    clock_ratio=0.0,
    wander=0.0,
    wander_s=37.0,
    noise=0.0,
    cut_v=None,
    leg=LEG,
    size=1.0,
    pulse_rate_hz=1e6,
    rng=None,
    periods=PERIODS,
    order=0.0,
    order_late_s=0.0,
    tracked=ORDER,
    second=0.0,
    added=0.0,
):
    """Signals of the leg: u = sum of its lines, n = H u, M_s = (1 + wander) (1 + n)^2 + inertia + added, and noise."""
    time_s = np.arange(round((leg.stop_s + 8.0) * RATE_HZ)) / RATE_HZ
    set_point, speed, change = (np.zeros(time_s.size) for _ in range(3))
    for harmonic, amplitude_v, phase_rad in zip(leg.harmonics, leg.amplitudes_v, leg.phases_rad, strict=True):
        omega = 2.0 * np.pi * harmonic / (leg.period_s * (1.0 + clock_ratio))
        wave = amplitude_v * np.exp(1j * (omega * (time_s - leg.start_s) + phase_rad - 0.5 * np.pi))
        set_point += size * wave.real * PER_VOLT / SPEED_REV_S
        answer = size * speed_over_set_point(omega) * wave * PER_VOLT / SPEED_REV_S
        # twice the frequency, its phase that of the square of the line
        twice = second * (answer / np.abs(answer)) ** 2
        speed += (answer + twice).real
        change += (1j * omega * (answer + 2.0 * twice)).real
    if cut_v is not None:
        set_point = np.minimum(set_point, cut_v)
    load = 1.0 + wander * np.cos(2.0 * np.pi * time_s / wander_s + 1.0)
    turns = tracked.per_turn * SPEED_REV_S * np.cumsum(1.0 + speed) / RATE_HZ
    turns = np.interp(time_s - order_late_s, time_s, turns)
    load = load * (1.0 + order * np.cos(2.0 * np.pi * turns + 0.7))
    torque = load * (1.0 + speed) ** 2 + INERTIA_S * change + added
    if noise:
        torque += noise * rng.standard_normal(time_s.size)
        speed = speed + 0.1 * noise * rng.standard_normal(time_s.size)
    inside = slice(round(10.0 * RATE_HZ), round((10.0 + leg.period_s * periods) * RATE_HZ))
    mean = float(np.mean(torque[inside]) / np.mean((1.0 + speed[inside]) ** 2))
    point = WorkingPoint(
        engine_speed_rev_s=SPEED_REV_S,
        shaft_torque_nm=TORQUE_NM * mean,
        engine_speed_std_rev_s=0.001,
        shaft_torque_std_nm=1.0,
        set_point_v=-3.6,
        load_std=0.001,
    )
    channels = made_channels(
        point,
        SPEED_REV_S * (1.0 + set_point),
        TORQUE_NM * torque,
        {"n_e": {"values": SPEED_REV_S * (1.0 + speed), "channel": "P", "pulse_rate_hz": pulse_rate_hz}},
        per_volt=PER_VOLT,
        scale_std=0.01,
    )
    line = SetPointCalibration(
        slope_rev_s_per_v=PER_VOLT,
        intercept_rev_s=-0.4,
        covariance=np.eye(2),
        level_v=np.array([-3.6]),
        level_rev_s=np.array([SPEED_REV_S]),
        level_std_rev_s=np.array([0.001]),
    )
    return Signals(
        rate_hz=RATE_HZ,
        start_s=0.0,
        channels=channels,
        working_point=point,
        calibration=line,
        dc_scale=1.0,
        dc_scale_std=0.01,
        strips=(),
        step_delays=(),
        repairs=(),
        legs=(LegState(name="M1", start_s=10.0, period_s=leg.period_s, periods=periods, working_point=point),),
        mode="shaftprint",
        recording_sha256="",
        recording_name="made",
    )


def _expected(response):
    omega = response.omega_rad_s
    speed = speed_over_set_point(omega)
    return np.stack([speed, (2.0 + 1j * omega * INERTIA_S) * speed])


@pytest.mark.parametrize("clock_ratio", [0.0, 5e-5, -3e-4])
def test_each_line_has_the_response_of_the_line_with_a_linear_propeller(clock_ratio):
    signals = made_leg(clock_ratio=clock_ratio)
    # so far that its square is as large as the slowest line
    assert np.ptp(signals.engine_speed.values) > 0.15 * SPEED_REV_S
    response = estimate_legs(signals, CAMPAIGN)["M1"].response
    assert response.lines == tuple(f"M1/{harmonic}" for harmonic in HARMONICS)
    assert response.frequency_hz == pytest.approx(np.array(HARMONICS) / (PERIOD_S * (1.0 + clock_ratio)), rel=1e-7)
    assert np.abs(response.response[:, 0] - _expected(response)).max() < 2e-5
    assert response.used.all()
    assert response.reasons == ()


def test_how_well_the_noise_will_be_known_is_known_beforehand():
    measured = estimate_legs(made_leg(noise=0.02, size=0.05, rng=np.random.default_rng(4)), CAMPAIGN)["M1"].response
    expected = leg_freedom(HARMONICS, PERIODS)
    assert expected == pytest.approx(measured.degrees_of_freedom, rel=0.03)
    # 36 bins of two numbers each, of which the slowest line has few within its octave
    assert expected[-1] == pytest.approx(72.0, rel=0.04)
    assert expected[0] < 0.4 * expected[-1]


def test_a_further_pick_up_is_held_against_the_first_at_the_lines():
    """A shaft behind a coupling on which it swings at 8 Hz with the engine held: 1 / (1 - (f / 8 Hz)^2)."""
    rng = np.random.default_rng(4)
    signals = made_leg(noise=0.02, rng=rng)
    engine = signals.engine_speed
    spectrum = np.fft.rfft(engine.values)
    frequency_hz = np.fft.rfftfreq(engine.values.size, 1.0 / RATE_HZ)
    spectrum[frequency_hz > 5.0] = 0.0
    behind = np.fft.irfft(spectrum / (1.0 - (np.minimum(frequency_hz, 5.0) / 8.0) ** 2), engine.values.size)
    shaft = replace(engine, name="n_s", values=behind + 1e-3 * SPEED_REV_S * rng.standard_normal(behind.size))
    (one,) = estimate_legs(with_channels(signals, n_s=shaft), CAMPAIGN)["M1"].speed_ratios
    assert one.name == "n_s"
    assert one.frequency_hz == pytest.approx(np.array(HARMONICS) / PERIOD_S, rel=1e-4)
    off = np.log(one.size * (1.0 - (one.frequency_hz / 8.0) ** 2)) / one.std
    assert np.abs(off).max() < 3.5
    # at 2.6 Hz the twist is 12 %
    assert one.std[-1] < 0.01


@pytest.mark.slow
def test_the_stated_covariance_is_the_scatter_over_repeats():
    rng = np.random.default_rng(5)
    distances = []
    for _ in range(60):
        response = estimate_legs(made_leg(noise=0.02, rng=rng), CAMPAIGN)["M1"].response
        error = response.response[:, 0] - _expected(response)
        real = np.concatenate([error.real, error.imag]).T
        distances.append(np.einsum("ka,kab,kb->k", real, np.linalg.inv(response.covariance), real))
    # r^T C^-1 r has the mean 4 at every line; 60 repeats know the mean of six lines to 0.15
    assert np.mean(distances) == pytest.approx(4.0, abs=0.5)
    # 8 complex samples at least; at the slowest line, whose neighbours reach far in octaves, they count less
    assert response.degrees_of_freedom[1:].min() > 16.0


@pytest.mark.slow
def test_the_noise_of_a_surge_is_stated_under_the_line_that_it_meets():
    """A surge of 0.09 Hz as a tug has it at its mooring, under a line of 0.1 Hz, in five periods of 30 s."""
    rng = np.random.default_rng(7)
    leg = LEG.model_copy(update={"period_s": 30.0, "stop_s": 10.0 + 5 * 30.0})
    campaign = CAMPAIGN.model_copy(update={"duration_s": 170.0, "multisines": (leg,)})
    samples = round((leg.stop_s + 8.0) * RATE_HZ)
    frequency = np.fft.rfftfreq(samples, 1.0 / RATE_HZ) / 0.09
    hump = 1.0 / np.abs(1.0 - frequency**2 + 0.3j * frequency)
    squares, stated = [], []
    for _ in range(60):
        surge = 2e-3 * np.fft.irfft(hump * np.fft.rfft(rng.standard_normal(samples)), samples)
        response = estimate_legs(made_leg(noise=0.002, added=surge, leg=leg, periods=5, rng=rng), campaign)[
            "M1"
        ].response
        error = (response.response[:, 0] - _expected(response))[1]
        squares.append(np.abs(error) ** 2)
        std = np.sqrt(np.diagonal(response.covariance, axis1=1, axis2=2))
        stated.append(std[:, 1] ** 2 + std[:, 3] ** 2)
    ratio = np.mean(stated, axis=0) / np.mean(squares, axis=0)
    assert 0.6 < ratio[1] < 1.6, ratio


def test_the_wander_of_the_load_is_no_noise_under_the_lines():
    rng = np.random.default_rng(6)
    calm, wandering = (
        estimate_legs(made_leg(noise=0.002, wander=wander, rng=rng), CAMPAIGN)["M1"].response for wander in (0.0, 0.02)
    )
    calm_std, std = (np.sqrt(np.diagonal(one.covariance, axis1=1, axis2=2))[:, 1] for one in (calm, wandering))
    # the sidebands of a wander of 2 % would be ten times the noise of the torque
    assert np.all(std[2:] < 2.0 * calm_std[2:])


def test_a_wander_that_carries_one_line_onto_the_next_does_not_move_them():
    # harmonics 3 and 5 are two periods apart: left in, their sidebands change both by up to a per cent
    still, moving = (
        estimate_legs(made_leg(wander=wander, wander_s=PERIOD_S / 2.0), CAMPAIGN)["M1"].response
        for wander in (0.0, 0.01)
    )
    ratio = [one.response[1, 0] / one.response[0, 0] for one in (still, moving)]
    assert np.abs(ratio[1] / ratio[0] - 1.0).max() < 2e-4


def test_what_the_pick_up_takes_from_fast_lines_is_given_back():
    # the cardinal cubic spline shows a quarter of the pulse rate 0.9809 times too small: sinc^4 over its images
    signals = made_leg(pulse_rate_hz=4.0 * HARMONICS[-1] / PERIOD_S)
    response = estimate_legs(signals, CAMPAIGN)["M1"].response
    images = np.sinc(0.25 + np.arange(-60, 61)) ** 4
    seen = _expected(response)[0, -1] / (images[60] / images.sum())
    assert response.response[0, 0, -1] == pytest.approx(seen, rel=1e-4)


def test_lines_above_half_the_pulse_rate_are_not_used():
    spectra = estimate_legs(made_leg(pulse_rate_hz=4.0), CAMPAIGN)["M1"]
    assert spectra.response.used.tolist() == [True] * 5 + [False]
    assert "half the pulse rate of n_e: aliased" in spectra.remarks["M1/21"]


def test_a_set_point_that_is_smaller_than_asked_is_remarked_and_used():
    spectra = estimate_legs(made_leg(size=0.8), CAMPAIGN)["M1"]
    assert spectra.response.used.all()
    # 0.2 V of 240 rpm/V
    assert "set point has an amplitude of 38.4 rpm where the campaign asks for 48 rpm" in spectra.remarks["M1/1"]


def test_a_line_that_was_not_put_out_is_left_out():
    asked = LEG.model_copy(
        update={"harmonics": (1, 3, 5, 7, 9, 15, 21), "amplitudes_v": (0.2, 0.15, 0.15, 0.1, 0.1, 0.1, 0.2)}
    )
    asked = asked.model_copy(update={"phases_rad": (0.0,) * 7})
    spectra = estimate_legs(made_leg(), CAMPAIGN.model_copy(update={"multisines": (asked,)}))["M1"]
    assert "M1/7" not in spectra.response.lines
    assert spectra.remarks["M1/7"].startswith("left out: set point has an amplitude of")


def test_a_set_point_that_is_cut_off_is_named():
    signals = made_leg()
    cut_v = 0.5 * float(signals.channels["n_set"].values.max() / SPEED_REV_S - 1.0)
    (reason,) = (
        one
        for one in estimate_legs(made_leg(cut_v=cut_v), CAMPAIGN)["M1"].response.reasons
        if one.kind == "set-point shape"
    )
    assert "check whether its channel is cut off" in reason.sentence


def test_a_clock_that_is_a_thousandth_off_is_named():
    reasons = estimate_legs(made_leg(clock_ratio=1e-3), CAMPAIGN)["M1"].response.reasons
    assert [reason.kind for reason in reasons] == ["recording clock"]
    assert "periods of M1 are +0.10 % longer than the campaign file says" in reasons[0].sentence


@pytest.mark.parametrize("share", [0.005, -0.002])
@pytest.mark.parametrize(("channel", "words"), [("n_e", "the speed n_e"), ("M_s", "the shaft torque")])
def test_a_channel_on_a_clock_of_its_own_is_named(channel, words, share):
    """What is shown at the time t happened at (1 + share) t: its lines run faster by the share."""
    signals = made_leg(noise=0.002, rng=np.random.default_rng(5))
    one = signals.channels[channel]
    place = np.arange(one.values.size, dtype=np.float64)
    shown = with_channels(
        signals, **{channel: replace(one, values=np.interp((1.0 + share) * place, place, one.values))}
    )
    against = estimate_legs(shown, CAMPAIGN)["M1"].response.reasons
    (reason,) = (found for found in against if found.kind == "channel clock")
    assert reason.where == words
    stated = float(re.search(r"its sines run ([+-][\d.]+) % beside those of the set point", reason.sentence).group(1))
    assert stated == pytest.approx(100.0 * share, abs=0.02)


@pytest.mark.parametrize("seed", range(4))
def test_channels_of_one_clock_are_not_in_doubt_in_a_leg(seed):
    """Lines as faint as the noise, and a load that wanders, among those that tell."""
    rng = np.random.default_rng(seed)
    signals = made_leg(noise=0.05 * 4.0**seed / 4.0, wander=0.03, rng=rng)
    reasons = estimate_legs(signals, CAMPAIGN)["M1"].response.reasons
    assert not any(reason.kind == "channel clock" for reason in reasons)


def test_a_leg_that_was_cut_off_gives_a_response_of_its_whole_periods():
    spectra = estimate_legs(made_leg(periods=4), CAMPAIGN)["M1"]
    assert spectra.remarks["M1"] == "4 of 9 periods are in the recording"
    assert np.abs(spectra.response.response[:, 0] - _expected(spectra.response)).max() < 2e-5


def test_a_dead_gauge_is_refused():
    signals = made_leg()
    dead = signals.with_channel("M_s", values=np.full(signals.samples, TORQUE_NM))
    with pytest.raises(Exception, match="M1: expected M_s to move, found a constant from 10 to 82 s"):
        estimate_legs(replace(dead), CAMPAIGN)


def test_an_order_that_swings_across_the_lines_is_taken_out_of_them():
    rng = np.random.default_rng(7)
    errors, stds, bare = [], [], []
    for _ in range(20):
        signals = made_leg(order=0.09, noise=0.02, rng=rng)
        tracked, untracked = (
            estimate_legs(replace(signals, orders=orders), CAMPAIGN)["M1"].response for orders in ((ORDER,), ())
        )
        errors.append(abs(tracked.response - _expected(tracked)[:, np.newaxis])[1, 0])
        stds.append(np.sqrt(tracked.covariance[:, 1, 1] + tracked.covariance[:, 3, 3]))
        bare.append(np.sqrt(untracked.covariance[:, 1, 1] + untracked.covariance[:, 3, 3]))
    z = np.sqrt(np.mean(np.square(errors) / np.square(stds), axis=0))
    assert np.all((z > 0.6) & (z < 1.4))
    # white noise of 0.02 over 7200 samples at a line of 0.2 V is all that is left at the fastest line
    left = 0.02 * np.sqrt(4.0 / (PERIODS * PERIOD_S * RATE_HZ)) / (0.2 * abs(PER_VOLT) / SPEED_REV_S)
    assert np.median(stds, axis=0)[-1] == pytest.approx(left, rel=0.2)
    assert np.median(bare, axis=0)[-1] > 4.0 * left


def test_the_square_of_the_speed_is_a_load_of_the_line():
    # n = a cos(w t) + b cos(2 w t): of n^2 there is a b cos(w t) at the line, half of b is added to its load
    leg = LEG.model_copy(update={"harmonics": (3,), "amplitudes_v": (0.2,), "phases_rad": (1.0,)})
    campaign = CAMPAIGN.model_copy(update={"multisines": (leg,)})
    response = estimate_legs(made_leg(leg=leg, second=0.03), campaign)["M1"].response
    speed = speed_over_set_point(response.omega_rad_s)
    assert response.load == pytest.approx(1.015, abs=1e-4)
    assert np.abs(response.response[0, 0] - speed).max() < 1e-4
    torque = (2.0 * 1.015 + 1j * response.omega_rad_s * INERTIA_S) * speed
    assert np.abs(response.response[1, 0] - torque).max() < 2e-4


def test_a_share_of_the_speed_in_the_torque_brings_the_noise_of_the_speed():
    rng = np.random.default_rng(4)
    root = rng.standard_normal((3, 3)) + 1j * rng.standard_normal((3, 3))
    noise = LineNoise(covariance=root @ root.conj().T, complex_samples=36.0)
    drawn = root @ (rng.standard_normal((3, 200_000)) + 1j * rng.standard_normal((3, 200_000))) / np.sqrt(2.0)
    drawn[2] += (0.3 - 0.8j) * drawn[1]
    sampled = drawn @ drawn.conj().T / 200_000
    mixed = noise.with_share_of(1, 2, 0.3 - 0.8j).covariance
    assert np.abs(sampled - mixed).max() < 0.02 * np.abs(mixed).max()


@pytest.mark.parametrize("late_s", [-5e-3, 8e-3])
def test_an_order_may_come_late_and_repeat_with_the_leg(late_s):
    # 21 turns a period: nothing of the order is between the harmonics, where the noise is measured
    order = replace(ORDER, per_turn=21.0 / PERIOD_S / SPEED_REV_S)
    made = [made_leg(order=size, order_late_s=late_s, tracked=order) for size in (0.09, 0.0)]
    with_order, without = (
        estimate_legs(replace(signals, orders=(order,)), CAMPAIGN)["M1"].response.response[1, 0] for signals in made
    )
    untouched = estimate_legs(made[0], CAMPAIGN)["M1"].response.response[1, 0]
    assert np.abs(with_order - without).max() < 1e-3 * np.abs(untouched - without).max()


def test_a_leg_without_orders_keeps_its_response():
    signals = made_leg(noise=0.02, rng=np.random.default_rng(8))
    searched, plain = (
        estimate_legs(replace(signals, orders=orders), CAMPAIGN)["M1"].response for orders in ((ORDER,), ())
    )
    std = np.sqrt(plain.covariance[:, 1, 1] + plain.covariance[:, 3, 3])
    assert np.all(abs(searched.response - plain.response)[1, 0] < 0.3 * std)
    assert np.array_equal(searched.response[0], plain.response[0])
    assert np.all(searched.degrees_of_freedom <= plain.degrees_of_freedom)
