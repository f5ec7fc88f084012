"""Campaigns from recorded set points alone: nothing is told of what was asked."""

import numpy as np
import pytest
from benchmarks.recorded_campaigns import RATE_HZ, Chain, drawn_campaign, drawn_chain, kinds, wrong_samples

from shaftprint.campaign import Campaign, load_campaign, setpoint
from shaftprint.errors import SignalError
from shaftprint.signals.description._describe import described


def grid(campaign):
    return np.arange(int(campaign.duration_s * RATE_HZ)) / RATE_HZ


def of_recorded(volts):
    return described(volts, rate_hz=RATE_HZ, start_s=0.0, name="recorded")


def numbers_of(one):
    """What makes an excitation, times aside."""
    seldom = ("name", "start_s", "settled_s", "stop_s", "phase_rad", "phases_rad")
    return {key: value for key, value in one.model_dump().items() if key not in seldom}


@pytest.mark.slow
@pytest.mark.parametrize("name", ["short", "5min", "12min", "two-speeds"])
def test_shipped_campaigns_come_back(name):
    campaign = load_campaign(name)
    time = grid(campaign)
    chain = Chain()
    shown = of_recorded(chain.recorded_volts(campaign, time, np.random.default_rng(0)))
    assert shown.unexplained_s == ()
    assert kinds(shown.campaign) == kinds(campaign)
    assert setpoint(shown.campaign, time) == pytest.approx(setpoint(campaign, time), abs=0.01)
    for found, asked in zip(shown.campaign.excitations, campaign.excitations, strict=True):
        assert found.start_s == pytest.approx(asked.start_s, abs=0.01)
        assert found.stop_s == pytest.approx(asked.stop_s, abs=0.03)
        for key, value in numbers_of(asked).items():
            if key in ("name", "input", "harmonics"):
                assert getattr(found, key) == value
            else:
                assert getattr(found, key) == pytest.approx(value, rel=2e-3, abs=3e-4)


@pytest.mark.long
def test_drawn_campaigns_of_all_kinds_come_back():
    """Thirty drawn ones: another clock, gain, offset, steps and cycles of the generator, any order, phase and sign."""
    with_something_named = []
    for seed in range(30):
        rng = np.random.default_rng(seed)
        campaign, chain = drawn_campaign(rng), drawn_chain(rng)
        time = grid(campaign)
        shown = of_recorded(chain.recorded_volts(campaign, time, rng))
        wrong = wrong_samples(shown.campaign, chain, campaign, time)
        named = np.zeros(wrong.size, dtype=bool)
        for begin_s, end_s in shown.unexplained_s:
            named |= (wrong > begin_s - 0.5) & (wrong < end_s + 0.5)
        assert np.count_nonzero(~named) <= 0.0005 * time.size, f"seed {seed}: {wrong[~named]}"
        assert kinds(shown.campaign) == kinds(campaign), f"seed {seed}"
        if shown.unexplained_s:
            with_something_named.append(seed)
    assert len(with_something_named) <= 1


def test_a_sine_of_any_phase_between_others():
    campaign = Campaign.model_validate(
        {
            "name": "three",
            "duration_s": 100.0,
            "offset_v": -4.0,
            "sines": [
                {"name": "A", "frequency_hz": 0.2, "amplitude_v": 0.5, "start_s": 10, "settled_s": 15, "stop_s": 40},
                {
                    "name": "B", "frequency_hz": 0.75, "amplitude_v": 0.3, "phase_rad": 2.0,
                    "start_s": 40, "settled_s": 45, "stop_s": 60,
                },
                {
                    "name": "C", "frequency_hz": 2.5, "amplitude_v": 0.4, "phase_rad": 3.14159265,
                    "start_s": 65, "settled_s": 70, "stop_s": 90,
                },
            ],
        }
    )  # fmt: skip
    shown = of_recorded(Chain().recorded_volts(campaign, grid(campaign), np.random.default_rng(1)))
    for found, asked in zip(shown.campaign.sines, campaign.sines, strict=True):
        assert found.frequency_hz == pytest.approx(asked.frequency_hz, rel=1e-5)
        assert found.amplitude_v == pytest.approx(asked.amplitude_v, rel=1e-3)
        turn = found.phase_rad - asked.phase_rad - 2.0 * np.pi * asked.frequency_hz * (found.start_s - asked.start_s)
        assert np.angle(np.exp(1j * turn)) == pytest.approx(0.0, abs=0.005)
        assert found.start_s == pytest.approx(asked.start_s, abs=0.01)
        assert found.periods >= 1


@pytest.mark.slow
def test_what_is_no_test_is_named():
    """A hand on the lever: the set point wanders for half a minute between two sines."""
    rng = np.random.default_rng(5)
    campaign = load_campaign("short")
    time = grid(campaign)[: int(560 * RATE_HZ)]
    volts = Chain().recorded_volts(campaign, time, rng)
    hand = (time >= 446.0) & (time < 528.0)
    volts[hand] = -5.0 + 0.5 * np.cumsum(rng.standard_normal(hand.sum())) / np.sqrt(hand.sum())
    shown = of_recorded(volts)
    assert {one.frequency_hz for one in shown.campaign.sines} >= {0.02, 0.035, 0.15}
    assert any(begin_s < 460.0 and end_s > 515.0 for begin_s, end_s in _joined(shown.unexplained_s, 15.0))
    assert all(begin_s > 440.0 and end_s < 535.0 for begin_s, end_s in shown.unexplained_s)


def _joined(stretches, within_s):
    joined = [stretches[0]]
    for begin_s, end_s in stretches[1:]:
        if begin_s - joined[-1][1] < within_s:
            joined[-1] = (joined[-1][0], end_s)
        else:
            joined.append((begin_s, end_s))
    return joined


def test_a_set_point_that_stands_is_refused():
    with pytest.raises(SignalError, match="expected a set point that moves, found -5 V"):
        of_recorded(-5.0 + 0.001 * np.random.default_rng(0).standard_normal(20_000))
