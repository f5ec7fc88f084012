"""Begin, phase, sign and frequency of every test, from set points that were made otherwise than planned."""

import numpy as np
import pytest

from shaftprint.campaign import Campaign, load_campaign, setpoint
from shaftprint.errors import ForeignCampaignError, SignalError
from shaftprint.signals import proposed_campaign
from shaftprint.signals.excitation._found_test import common_shift_s
from shaftprint.signals.excitation._found_tests import found_tests
from shaftprint.signals.excitation._match import expect_campaign

RATE_HZ = 200.0
SHORT = load_campaign("short")


def grid(duration_s=900.0):
    return np.arange(round(duration_s * RATE_HZ)) / RATE_HZ


def logged(volts, seed=0):
    """What a logger makes of it: noise of a millivolt."""
    return volts + 0.001 * np.random.default_rng(seed).standard_normal(volts.size)


def found_of(volts, campaign=SHORT):
    return found_tests(logged(volts), campaign, rate_hz=RATE_HZ, start_s=0.0)


def findings_of(volts, campaign=SHORT):
    return expect_campaign(logged(volts), campaign, rate_hz=RATE_HZ, start_s=0.0, channel="U")


def changed(campaign, **changes):
    """Return a campaign with changes to tests by their names."""
    tests = {
        kind: [test.model_dump() | changes.get(test.name, {}) for test in getattr(campaign, kind)]
        for kind in ("sines", "chirps", "staircases")
    }
    return Campaign.model_validate(campaign.model_dump() | tests)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["short", "thesis"])
def test_a_test_as_planned_has_nothing_to_be_said(name):
    campaign = load_campaign(name)
    time = grid(campaign.duration_s)
    found = found_of(setpoint(campaign, time), campaign)
    assert all(test.is_found for test in found)
    assert [test.differences for test in found] == [()] * len(campaign.excitations)
    assert common_shift_s(found) == 0.0
    assert findings_of(setpoint(campaign, time), campaign) == ()


@pytest.mark.parametrize(("shift_s", "legs"), [(7.3, 1), (-2.5, 1), (7.3, 2), (25.0, 2)])
def test_a_shift_of_one_or_two_legs_is_told_as_such(shift_s, legs):
    """A course stands at one place alone; of two legs it was so far a clock that runs apart."""
    planned = load_campaign("12min")
    content = planned.model_dump() | {"multisines": planned.multisines[:legs], "staircases": ()}
    campaign = Campaign.model_validate(content | {"duration_s": planned.duration_s + 30.0})
    # in the middle of the recording, whichever way it is shifted
    volts = setpoint(campaign, grid(campaign.duration_s) - shift_s)
    assert common_shift_s(found_of(volts, campaign)) == pytest.approx(shift_s, abs=0.01)
    way = "earlier" if shift_s > 0.0 else "later"
    with pytest.raises(SignalError, match=f"recording starts {abs(shift_s):.2f} s {way} than the campaign says"):
        findings_of(volts, campaign)


@pytest.mark.parametrize("shift_s", [-3.0, 2.5, 60.0])
def test_a_shift_of_all_is_one_number(shift_s):
    """The staircase begins at 10 s: with -3 s it is still there."""
    volts = setpoint(SHORT, grid(930.0) - shift_s)
    found = found_of(volts)
    assert common_shift_s(found) == pytest.approx(shift_s, abs=0.01)
    begins = np.array([test.begin_s for test in found])
    assert begins == pytest.approx([test.start_s + shift_s for test in SHORT.excitations], abs=0.05)
    words = f"the recording starts {abs(shift_s):.2f} s {'earlier' if shift_s > 0 else 'later'} than the campaign says"
    if abs(shift_s) < 10.0:
        (finding,) = findings_of(volts)
        assert words in finding
    else:
        with pytest.raises(SignalError, match=f"found another course in every slow test .*: {words}"):
            findings_of(volts)
    proposed = proposed_campaign(found, SHORT)
    assert [test.name for test in proposed.excitations] == [test.name for test in SHORT.excitations]
    for test, planned in zip(proposed.excitations, SHORT.excitations, strict=True):
        assert test.start_s == pytest.approx(planned.start_s + shift_s, abs=0.002 if hasattr(test, "periods") else 0.02)
    # with it nothing is to be said any more
    assert findings_of(volts, proposed) == ()


def two_legs(seed, level_v=(6.4, 3.7), period_s=33.0, phases=None):
    """A test of two legs about two levels with steps at its end, with phases by chance."""
    rng = np.random.default_rng(seed)
    legs = [
        {
            "name": name, "level_v": level, "start_s": start, "settled_s": start + 10.0,
            "stop_s": start + 10.0 + 9.0 * period_s, "period_s": period_s, "harmonics": [1, 3, 5, 7],
            "amplitudes_v": [0.1, 0.05, 0.05, 0.03], "phases_rad": list(rng.uniform(-3.0, 3.0, 4)),
        }
        for name, level, start in (("M1", level_v[0], 10.0), ("M2", level_v[1], 330.0))
    ]  # fmt: skip
    stairs = {"name": "St1", "levels_v": [6.7, 6.4, 6.1, 6.4], "dwell_s": 10.0, "start_s": 660.0}
    return Campaign.model_validate(
        {
            "name": f"test {seed}", "duration_s": 710.0, "offset_v": level_v[0], "ramp_v_per_s": 0.5,
            "multisines": legs,
            "staircases": [stairs],
        }
    )  # fmt: skip


@pytest.mark.parametrize("other", [two_legs(2), two_legs(3, period_s=33.16), two_legs(4, (5.9, 2.4), 32.8)])
def test_legs_of_another_test_are_told_as_such_although_the_steps_agree(other):
    volts = setpoint(two_legs(1), grid(710.0))
    with pytest.raises(ForeignCampaignError, match=r"this is not the campaign of this recording: .*\(M1, M2\)"):
        findings_of(volts, other)
    assert findings_of(volts, two_legs(1)) == ()


@pytest.mark.parametrize("share", [0.015, -0.01])
def test_legs_on_another_clock_are_of_their_campaign(share):
    volts = setpoint(two_legs(1), (1.0 + share) * grid(710.0))
    with pytest.raises(
        SignalError, match=f"clock that runs {100.0 * abs(share):.2f} % {'slow' if share > 0 else 'fast'}"
    ):
        findings_of(volts, two_legs(1))


def sine_volts(time, volts, name, *, phase_deg=0.0, sign=1.0, frequency_hz=None, begin_s=None, stop_s=None):
    """Put another sine in the place of one."""
    sine = next(sine for sine in SHORT.sines if sine.name == name)
    begin, stop = begin_s or sine.start_s, stop_s or sine.stop_s
    volts = np.where((time >= sine.start_s) & (time < sine.stop_s), SHORT.offset_v, volts)
    turn = 2.0 * np.pi * (frequency_hz or sine.frequency_hz) * (time - begin) + np.radians(phase_deg)
    inside = (time >= begin) & (time < stop)
    return np.where(inside, SHORT.offset_v + sign * sine.amplitude_v * np.sin(turn), volts)


@pytest.mark.slow
@pytest.mark.parametrize("name", ["S1", "S4", "S7", "S10"])
@pytest.mark.parametrize("phase_deg", [90.0, -90.0])
def test_phase_of_slow_and_fast_sines(name, phase_deg):
    time = grid()
    volts = sine_volts(time, setpoint(SHORT, time), name, phase_deg=phase_deg)
    place = [test.name for test in SHORT.excitations].index(name)
    test = found_of(volts)[place]
    assert test.phase_error_deg == pytest.approx(phase_deg, abs=1.0)
    # the instant at which it would rise through its middle
    rising = test.planned.start_s - phase_deg / 360.0 / test.frequency_hz
    assert test.rising_s == pytest.approx(rising, abs=0.003 / test.frequency_hz)
    (finding,) = findings_of(volts)
    assert finding.startswith(f"{name} begins at a phase of {phase_deg:.0f} degrees: start_s = ")
    proposed = proposed_campaign(found_of(volts), SHORT)
    if name == "S1":
        # its next rise through the middle lies in the test before it, or 37 s after its begin: the begin stays
        assert proposed.sines[0].start_s == pytest.approx(230.0, abs=0.05)
        assert np.degrees(proposed.sines[0].phase_rad) == pytest.approx(phase_deg, abs=1.5)
    assert findings_of(volts, proposed) == ()


@pytest.mark.parametrize("name", ["S1", "S6"])
def test_a_sine_whose_phase_the_campaign_states(name):
    time = grid()
    stated = changed(SHORT, **{name: {"phase_rad": 2.0}})
    assert findings_of(setpoint(stated, time), stated) == ()
    (finding,) = findings_of(setpoint(SHORT, time), stated)
    assert finding.startswith(f"{name} begins at a phase of 0 degrees where the campaign says 115: phase_rad = ")
    assert float(finding.split("phase_rad = ")[1].removesuffix(" fits")) == pytest.approx(0.0, abs=0.01)


@pytest.mark.slow
def test_sign_of_one_and_of_all():
    time = grid()
    one = sine_volts(time, setpoint(SHORT, time), "S6", sign=-1.0)
    (finding,) = findings_of(one)
    assert finding.startswith("S6 begins at a phase of")
    assert "180 degrees" in finding
    with pytest.raises(SignalError, match=r"in every slow test .*: every test is upside down; turn the sign"):
        findings_of(2.0 * SHORT.offset_v - setpoint(SHORT, time))
    proposed = proposed_campaign(found_of(2.0 * SHORT.offset_v - setpoint(SHORT, time)), SHORT)
    assert proposed.staircases[0].levels_v == pytest.approx([-7.0, -6.0, -5.0, -4.0, -5.0, -6.0, -7.0])


@pytest.mark.parametrize(("name", "frequency_hz"), [("S3", 0.0725), ("S6", 0.55), ("S9", 2.3)])
def test_frequency_of_a_sine_that_is_another(name, frequency_hz):
    time = grid()
    volts = sine_volts(time, setpoint(SHORT, time), name, frequency_hz=frequency_hz)
    findings = findings_of(volts)
    planned = next(sine for sine in SHORT.sines if sine.name == name)
    assert findings == (f"{name} has {frequency_hz:g} Hz where the campaign says {planned.frequency_hz:g} Hz",)
    proposed = proposed_campaign(found_of(volts), SHORT)
    assert next(s for s in proposed.sines if s.name == name).frequency_hz == pytest.approx(frequency_hz, rel=2e-4)


@pytest.mark.parametrize("seed", range(3))
def test_windows_that_are_given_roughly(seed):
    """Every window is off by up to 2 s of its own: the sheet was written by hand."""
    rng = np.random.default_rng(seed)
    off = {test.name: float(rng.uniform(-2.0, 2.0)) for test in SHORT.excitations}
    rough = changed(
        SHORT,
        **{
            test.name: {
                key: getattr(test, key) + off[test.name]
                for key in ("start_s", "settled_s", "stop_s")
                if key in type(test).model_fields
            }
            for test in SHORT.excitations
        },
    )
    volts = setpoint(SHORT, grid())
    found = found_of(volts, rough)
    assert [test.begin_s for test in found] == pytest.approx([t.start_s for t in SHORT.excitations], abs=0.05)
    assert [test.end_s for test in found] == pytest.approx([t.stop_s for t in SHORT.excitations], abs=0.05)
    assert common_shift_s(found) == 0.0
    assert findings_of(volts, proposed_campaign(found, rough)) == ()


def test_a_sine_that_was_not_made_is_not_proposed():
    time = grid()
    sine = SHORT.sines[4]
    volts = setpoint(SHORT, time)
    volts[(time >= sine.start_s) & (time < sine.stop_s)] = SHORT.offset_v
    found = found_of(volts)
    assert [test.planned.name for test in found if not test.is_found] == [sine.name]
    assert findings_of(volts) == (f"the set point does not follow the campaign during {sine.name}; check its times",)
    assert sine.name not in {test.name for test in proposed_campaign(found, SHORT).excitations}


@pytest.mark.slow
@pytest.mark.parametrize(("ratio", "words"), [(1.005, "0.50 % slow"), (0.9925, "0.75 % fast")])
def test_legs_on_another_clock_name_the_clock(ratio, words):
    campaign = load_campaign("12min")
    # a logger that counts too few seconds is ahead in the campaign
    volts = setpoint(campaign, ratio * grid(740.0))
    with pytest.raises(SignalError, match=f"on a clock that runs {words}: check the sample rate"):
        findings_of(volts, campaign)


def test_no_test_at_all():
    with pytest.raises(SignalError, match=r"expected the tests of campaign .* in the set point, found none of them"):
        proposed_campaign(found_of(np.full(180_000, -5.0)), SHORT)
