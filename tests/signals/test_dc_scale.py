import numpy as np
import pytest

from shaftprint.campaign import Campaign
from shaftprint.signals import dc_scale
from shaftprint.signals.levels._dc_scale import LowLines, low_lines, zero_frequency_ratio

RATE_HZ = 20.0
LINES_HZ = (0.0044, 0.0092, 0.0193, 0.0275, 0.0405, 0.06, 0.0848, 0.11)


def loop(omega):
    """Speed over set point of a PI-governed shaft: K_p 5.7, K_i 4.27, tau 1.336 s, propeller slope 2."""
    s = 1j * np.asarray(omega)
    forward = (5.7 + 4.27 / s) / (1.336 * s + 2.0)
    return forward / (1.0 + forward)


@pytest.fixture(scope="module")
def sines() -> Campaign:
    start, found = 20.0, []
    for number, frequency in enumerate(LINES_HZ):
        stop = start + 10.0 + np.ceil(220.0 * frequency + 1.0) / frequency + 0.1
        found.append(
            {
                "name": f"S{number + 1}",
                "frequency_hz": frequency,
                "amplitude_v": 0.6,
                "start_s": start,
                "settled_s": start + 10.0,
                "stop_s": stop,
            }
        )
        start = stop + 20.0
    return Campaign.model_validate({"name": "sines", "duration_s": start, "offset_v": -5.0, "sines": found})


def responses(campaign, scale=1.0, *, noise=0.0, harmonic=0.0, seed=0):
    """Set point and speed of steady sines, the set point too large by 1 / scale."""
    rng = np.random.default_rng(seed)
    time = np.arange(round(campaign.duration_s * RATE_HZ)) / RATE_HZ
    asked, found = np.full(time.size, 20.0), np.full(time.size, 20.0)
    for sine in campaign.sines:
        inside = (time >= sine.start_s) & (time < sine.stop_s)
        omega = 2 * np.pi * sine.frequency_hz
        phase = omega * (time[inside] - sine.start_s)
        answer = loop(omega)
        asked[inside] += 2.5 / scale * np.sin(phase)
        found[inside] += 2.5 * abs(answer) * np.sin(phase + np.angle(answer))
        found[inside] += 2.5 * harmonic * np.sin(2.0 * phase + 0.7)
    return asked, found + noise * rng.standard_normal(time.size)


def test_ratio_of_each_line(sines):
    asked, found = responses(sines, harmonic=0.05)
    lines = low_lines(asked, found, sines, rate_hz=RATE_HZ, start_s=0.0)
    omega = 2 * np.pi * np.array(LINES_HZ)
    departure = np.abs(loop(omega) - 1.0)
    near = int(np.argmax(departure > 0.2))
    assert lines.omega_rad_s == pytest.approx(omega[:near])
    # a second harmonic of 5 % leaves no trace
    assert lines.ratio == pytest.approx(loop(omega[:near]), abs=1e-9)


def test_zero_frequency_ratio_is_exact_for_its_own_form():
    omega = 2 * np.pi * np.array(LINES_HZ[:5])
    lines = LowLines(omega_rad_s=omega, ratio=1.0034 * loop(omega), std=np.full(5, 1e-3))
    value, std = zero_frequency_ratio(lines)
    assert value == pytest.approx(1.0034, abs=1e-9)
    assert 1e-4 < std < 5e-3


def test_delays_of_the_loop_cost_little():
    omega = 2 * np.pi * np.array(LINES_HZ[:6])
    s = 1j * omega
    forward = (5.7 + 4.27 / s) / (1.336 * s + 2.0) * np.exp(-0.07 * s) / (s**2 / 10.3**2 + 2 * 0.47 * s / 10.3 + 1.0)
    ratio = forward / (1.0 + forward) * np.exp(-0.05 * s)
    value, _ = zero_frequency_ratio(LowLines(omega_rad_s=omega, ratio=ratio, std=np.full(6, 1e-3)))
    assert value == pytest.approx(1.0, abs=3e-4)


@pytest.mark.parametrize("scale", [0.995, 1.0, 1.004])
def test_wrong_scale_is_found(sines, scale):
    asked, found = responses(sines, scale, noise=0.05)
    result = dc_scale(asked, found, sines, rate_hz=RATE_HZ, start_s=0.0, slope_std=1e-2)
    assert result.value == pytest.approx(scale, abs=4.0 * result.std)
    assert result.std < 1.5e-3
    assert result.findings == ()


def test_stated_deviation_is_the_scatter(sines):
    results = [
        dc_scale(*responses(sines, noise=0.1, seed=seed), sines, rate_hz=RATE_HZ, start_s=0.0, slope_std=10.0)
        for seed in range(25)
    ]
    errors = np.array([(result.value - 1.0) / result.std for result in results])
    # chi-square of 25
    assert 0.5 < np.mean(errors**2) < 1.7


def test_levels_and_lines_are_weighted(sines):
    asked, found = responses(sines, 1.0005, noise=0.05)
    free = dc_scale(asked, found, sines, rate_hz=RATE_HZ, start_s=0.0, slope_std=10.0)
    both = dc_scale(asked, found, sines, rate_hz=RATE_HZ, start_s=0.0, slope_std=free.std)
    assert both.value == pytest.approx(0.5 * (free.value + 1.0), abs=1e-6)
    assert both.std == pytest.approx(free.std / np.sqrt(2.0), rel=1e-4)


def test_contradiction_is_a_finding_and_the_lines_decide(sines):
    asked, found = responses(sines, 1.02, noise=0.02)
    result = dc_scale(asked, found, sines, rate_hz=RATE_HZ, start_s=0.0, slope_std=1e-4)
    assert result.value == pytest.approx(1.02, abs=1e-3)
    assert result.findings[0].startswith("the slow sines ask for a set-point scale of 1.")


def test_without_slow_sines_the_levels_stand_alone(sines):
    few = sines.model_copy(update={"sines": sines.sines[:2]})
    asked, found = responses(sines)
    result = dc_scale(asked, found, few, rate_hz=RATE_HZ, start_s=0.0, slope_std=2e-3)
    assert (result.value, result.std) == (1.0, 2e-3)
    assert "found 2" in result.findings[0]
    none = sines.model_copy(update={"sines": ()})
    assert "found 0" in dc_scale(asked, found, none, rate_hz=RATE_HZ, start_s=0.0, slope_std=2e-3).findings[0]


def test_sine_of_a_single_period_is_passed_over(sines):
    first = sines.sines[0].model_copy(update={"stop_s": sines.sines[0].settled_s + 1.5 / LINES_HZ[0]})
    short = sines.model_copy(update={"sines": (first, *sines.sines[1:])})
    asked, found = responses(sines)
    lines = low_lines(asked, found, short, rate_hz=RATE_HZ, start_s=0.0)
    assert lines.omega_rad_s[0] == pytest.approx(2 * np.pi * LINES_HZ[1])


def test_sine_before_the_first_sample_is_passed_over(sines):
    asked, found = responses(sines)
    late = sines.sines[1].settled_s - 1.0
    skipped = round(late * RATE_HZ)
    lines = low_lines(asked[skipped:], found[skipped:], sines, rate_hz=RATE_HZ, start_s=late)
    assert lines.omega_rad_s[0] == pytest.approx(2 * np.pi * LINES_HZ[1])
    assert lines.ratio[0] == pytest.approx(loop(lines.omega_rad_s[0]), abs=1e-7)
