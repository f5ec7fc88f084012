"""How a record of a drive was taken: what is wrong is refused and named, and what is not stays trusted."""

from dataclasses import replace

import numpy as np
import pytest
from tests.bench.drawn_lags import GAIN, LAG_TOML, TIME_S, identified, lag, levels, written

from shaftprint.bench._record_reasons import large_offsets

pytestmark = pytest.mark.slow

INTERVAL = 0.02
TRUTH = {"K": GAIN, "T": TIME_S}
# Standard deviations within which each number lies: 1 of 10,000 is further.
FAR = 4.0


def noisy(values, seed, std=0.5):
    return values + std * np.random.default_rng(seed).standard_normal(values.size)


def fit_of(folder, seed, *, fit="", hold=True, start=0.0, zero=0.0, dry=0.0, up=False, kept=1, samples=1000):
    """Return the fit to one drawn record."""
    u = levels(np.random.default_rng(seed), samples, 20)
    u = 1.2 + 0.5 * u if up else u
    y = noisy(lag(u, INTERVAL, hold=hold, start=start, dry=dry), seed + 1) + zero
    y = y[(np.arange(samples) // kept) * kept]
    return identified(folder, written(folder, "steps", {"u": u, "y": y}, INTERVAL), text=LAG_TOML + fit)


def expect_trusted(fit):
    assert fit.verdict.trustworthy, fit.verdict.sentences
    for parameter in fit.identification.parameters:
        assert abs(parameter.value - TRUTH[parameter.name]) < FAR * parameter.std


def named(fit):
    """Return the first reason that says how a record was taken."""
    assert not fit.verdict.trustworthy
    assert fit.verdict.reasons[0].kind == "record"
    return fit.verdict.reason


@pytest.mark.parametrize("kept", [2, 5, 10])
def test_values_that_are_kept_are_named_with_their_time(tmp_path, kept):
    reason = named(fit_of(tmp_path, 10 * kept, kept=kept, fit="inputs_hold = true"))
    assert f"y keeps each value for {kept * INTERVAL:.3g} s ({kept} samples)" in reason
    assert "use one sample of each value" in reason


def test_start_in_motion_is_named_and_found(tmp_path):
    moving = fit_of(tmp_path, 3, start=60.0, fit="inputs_hold = true")
    reason = named(moving)
    assert [one.kind for one in moving.verdict.reasons] == ["record"]
    assert not any("do not follow the same numbers" in sentence for sentence in moving.verdict.sentences)
    assert "Record steps does not begin in steady running" in reason
    assert 'start = "found"' in reason
    found = fit_of(tmp_path, 3, start=60.0, fit='inputs_hold = true\nstart = "found"')
    expect_trusted(found)
    (part,) = found.identification.parts
    # the state of a lag is what comes out of it, with its gain: the speed
    assert part.initial_states[0].value == pytest.approx(60.0, abs=2.0)


def test_dry_friction_of_a_motion_one_way_is_no_zero_of_the_sensor(tmp_path):
    """What holds back by 0.3 V in one direction stands 30 rad/s beside the sensor."""
    fit = fit_of(tmp_path, 4, up=True, dry=0.3, start=0.9 * GAIN, fit='inputs_hold = true\nstart = "found"')
    reason = named(fit)
    (offset,) = fit.identification.parts[0].offsets
    assert abs(offset.value + 0.3 * GAIN) < FAR * offset.std
    assert offset.std < 0.5
    assert "the motion of steps goes one way, in which dry friction is a constant too" in reason
    assert "zero_std of y" in reason


def test_offset_that_another_end_of_the_search_does_not_need_is_none(tmp_path):
    """A load of 0.3 V, stated too well, stands 30 rad/s beside the sensor; with none the model stands where it is."""
    block = '[[blocks]]\noutput = "load"\nkind = "constant"\nparameters = { value = "F" }\n\n[[parameters]]'
    text = LAG_TOML.replace("[[parameters]]", block, 1).replace('inputs = ["u"]', 'inputs = ["u", "load"]')
    load = '[[parameters]]\nname = "F"\nunit = "V"\nlower = -1.0\nupper = 1.0\nvalue = 0.3\nmeaning = "load"'
    known = '[[known]]\nname = "F"\nvalue = 0.3\nstd = 0.001'
    text = text.replace("[fit]", f"{load}\n\n{known}\n\n[fit]")
    u = levels(np.random.default_rng(11), 400, 20)
    record = written(tmp_path, "steps", {"u": u, "y": noisy(lag(u, INTERVAL, hold=True), 12)}, INTERVAL)
    fit = identified(tmp_path, record, text=f"{text}inputs_hold = true")
    assert "y stands -29.9" in named(fit)

    found = fit.identification
    values = np.array([found.value(name) if name != "F" else 0.0 for name in found.objective.names])
    for further, reasons in ((1.9, 0), (2.0, 1)):  # 95 % of a number ends where the cost is higher by 1.92
        other = replace(found.clusters[0], values=values, cost=found.cost + further)
        elsewhere = replace(found, clusters=(*found.clusters, other))
        assert len(list(large_offsets(fit.equipped, elsewhere))) == reasons


def test_zero_of_a_sensor_is_found_with_its_deviation_and_trusted(tmp_path):
    fit = fit_of(tmp_path, 5, zero=4.0, fit="inputs_hold = true")
    expect_trusted(fit)
    (offset,) = fit.identification.parts[0].offsets
    assert abs(offset.value - 4.0) < FAR * offset.std
    # gain and time known it is a mean of 1000 samples of noise of 0.5, 0.0158; they are known less well
    assert 0.0155 < offset.std < 0.03


def test_stated_zero_of_a_sensor_takes_the_place_of_a_share_of_the_level(tmp_path):
    text = LAG_TOML.replace('unit = "rad/s"\n\n[[blocks]]', 'unit = "rad/s"\nzero_std = 20.0\n\n[[blocks]]')
    u = levels(np.random.default_rng(6), 1000, 20)
    speed = noisy(lag(u, INTERVAL, hold=True), 7)
    far, near = (
        written(tmp_path, name, {"u": u, "y": speed + zero}, INTERVAL) for name, zero in (("a", 90.0), ("b", 40.0))
    )
    hold = "inputs_hold = true"
    assert "zero_std of y" in named(identified(tmp_path, far, text=text + hold))
    assert "zero_std of y" in named(identified(tmp_path, near, text=LAG_TOML + hold))
    expect_trusted(identified(tmp_path, near, text=text + hold))


@pytest.mark.parametrize("hold", [True, False])
def test_what_inputs_do_between_samples_is_found(tmp_path, hold):
    fit = fit_of(tmp_path, 8, hold=hold)
    expect_trusted(fit)
    assert fit.inputs_hold is hold
    words = "hold from sample to sample" if hold else "go straight from sample to sample"
    assert fit.verdict.assumptions[0].startswith(f"the inputs {words}, which explains the records better")


@pytest.mark.parametrize("hold", [True, False])
def test_inputs_that_the_file_has_the_other_way_are_named(tmp_path, hold):
    reason = named(fit_of(tmp_path, 9, hold=hold, fit=f"inputs_hold = {str(not hold).lower()}"))
    assert f"write inputs_hold = {str(hold).lower()} in [fit]" in reason


ANGLE_TOML = LAG_TOML.replace('output = "y"\nkind', 'output = "w"\nkind').replace("rad/s", "deg").replace(
    "[[parameters]]", '[[blocks]]\noutput = "y"\nkind = "integrator"\ninputs = ["w"]\n\n[[parameters]]', 1
)  # fmt: skip


@pytest.mark.parametrize("start", ["steady", "found"])
def test_angle_that_begins_again_after_a_turn_goes_on(tmp_path, start):
    """The integral of the speed, exact: ``y`` gains ``K u t`` less what the speed lags behind."""
    u = np.abs(levels(np.random.default_rng(11), 800, 40))
    speed = lag(u, INTERVAL, hold=True)
    angle = 300.0 + np.cumsum(np.concatenate([[0.0], GAIN * u[:-1] * INTERVAL])) - TIME_S * speed
    path = written(tmp_path, "turns", {"u": u, "y": np.mod(noisy(angle, 12, std=0.05), 360.0)}, INTERVAL)
    fit = identified(tmp_path, path, text=ANGLE_TOML + f'inputs_hold = true\nstart = "{start}"\n')
    expect_trusted(fit)
    assert "in record turns y is an angle that begins again after 360 deg" in fit.verdict.assumptions[0]
    # both ends of both intervals are found, although the zero of the angle and its start are one constant
    assert not any(one.lower_open or one.upper_open or one.lower_failed for one in fit.intervals.values())
