"""The search of a drive: what several starts agree on, what one found alone, and optima that only widths hide."""

import numpy as np
import pytest

from shaftprint.bench import equipped, identify_drive
from shaftprint.bench._structures import compare_in_time, without
from shaftprint.drive import load_drive
from shaftprint.time_domain import record_from_arrays

RATE_HZ = 50.0

RECTIFIED = """\
name = "rectified"
[[inputs]]
name = "u"
channel = "u"
unit = "V"
[[outputs]]
name = "z"
channel = "z"
unit = "V"
[[blocks]]
output = "y"
kind = "first-order-lag"
inputs = ["u"]
parameters = {{ gain = "k", time = "T" }}
[[blocks]]
output = "above"
kind = "limit"
inputs = ["y"]
parameters = {{ lowest = 0.0, highest = 1e6 }}
[[blocks]]
output = "below"
kind = "limit"
inputs = ["y"]
parameters = {{ lowest = -1e6, highest = 0.0 }}
[[blocks]]
output = "folded"
kind = "gain"
inputs = ["below"]
parameters = {{ gain = {folded} }}
[[blocks]]
output = "z"
kind = "sum"
inputs = ["above", "-folded"]
[[parameters]]
name = "k"
unit = "-"
lower = {lower}
upper = {upper}
value = 1.0
meaning = "gain"
[[parameters]]
name = "T"
unit = "s"
lower = 0.01
upper = 100.0
value = 0.2
meaning = "time constant"
[[start]]
name = "y"
value = 0.0
[fit]
start = "known"
offset = "none"
inputs_hold = true
"""

ROTOR = """\
name = "rotor"
[[inputs]]
name = "T"
channel = "T"
unit = "N m"
[[outputs]]
name = "omega"
channel = "omega"
unit = "rad/s"
[[blocks]]
output = "viscous"
kind = "gain"
inputs = ["omega"]
parameters = { gain = "B" }
[[blocks]]
output = "dry"
kind = "coulomb-friction"
inputs = ["omega"]
parameters = { size = "T_C", yielding = 0.02 }
[[blocks]]
output = "omega"
kind = "integrator"
inputs = ["T", "-viscous", "-dry"]
parameters = { gain = "a" }
[[parameters]]
name = "a"
unit = "1/kg m2"
lower = 10.0
upper = 10000.0
value = 500.0
meaning = "one over inertia"
[[parameters]]
name = "B"
unit = "N m s/rad"
lower = 0.0
upper = 0.1
value = 0.001
meaning = "viscous friction"
[[parameters]]
name = "T_C"
unit = "N m"
lower = 0.0
upper = 1.0
value = 0.05
meaning = "dry friction"
[fit]
start = "steady"
offset = "constant"
inputs_hold = true
"""

A, B, T_C = 800.0, 2e-3, 0.1


def equipped_of(folder, text):
    path = folder / "drive.toml"
    path.write_text(text, encoding="utf-8")
    return equipped(load_drive(path))


def rectified_record(rng, *, gain, folded, time_constant=0.15, noise=0.05):
    """The lag by its exact step from sample to sample, then folded up below zero."""
    u = np.repeat(rng.choice([-1.0, 1.0], 40), 10)
    fade, y = np.exp(-1.0 / (RATE_HZ * time_constant)), np.zeros(u.size)
    for k in range(u.size - 1):
        y[k + 1] = fade * y[k] + (1.0 - fade) * gain * u[k]
    z = np.where(y > 0.0, y, -folded * y) + noise * rng.standard_normal(u.size)
    return record_from_arrays("z", {"u": u}, {"z": z}, rate_hz=RATE_HZ, hold=True)


def one_way_record(name, rng, direction):
    """The rotor in steady motion that steps make faster and slower: sign of the motion and its law by hand."""
    torque = direction * np.repeat([0.3, 0.4, 0.35, 0.42], 100)
    fade, speed = np.exp(-A * B / RATE_HZ), np.zeros(400)
    speed[0] = (abs(torque[0]) - T_C) / B
    for k in range(399):
        speed[k + 1] = fade * speed[k] + (1.0 - fade) * (abs(torque[k]) - T_C) / B
    omega = direction * speed + 0.5 * rng.standard_normal(400)
    return record_from_arrays(name, {"T": torque}, {"omega": omega}, rate_hz=RATE_HZ, hold=True)


@pytest.mark.long
@pytest.mark.parametrize("width", [5.0, 1000.0])
def test_both_signs_are_found_whatever_the_bounds(tmp_path, width):
    """What is folded at zero alike tells the size of a gain, not its sign."""
    one = equipped_of(tmp_path, RECTIFIED.format(folded=1.001, lower=-width, upper=width))
    record = rectified_record(np.random.default_rng(1), gain=2.0, folded=1.0)
    for seed in (1, 2, 3):
        fit = identify_drive(one, [record], rng=np.random.default_rng(seed))
        assert not fit.verdict.trustworthy
        assert fit.verdict.reason.startswith("The result is not unique: another optimum, with k = ")
        assert abs(abs(fit.identification.value("k")) - 2.0) < 0.05


def test_signs_that_the_record_tells_apart_are_no_rivals(tmp_path):
    one = equipped_of(tmp_path, RECTIFIED.format(folded=1.3, lower=-1000.0, upper=1000.0))
    record = rectified_record(np.random.default_rng(1), gain=2.0, folded=1.3)
    fit = identify_drive(one, [record], rng=np.random.default_rng(1))
    assert fit.verdict.trusted == ("k", "T")
    assert abs(fit.identification.value("k") - 2.0) < 0.05
    assert "the optimum is the only one" in fit.verdict.reason
    assert 2 <= fit.agreeing < fit.identification.settings.starts


def test_a_single_start_is_not_the_end_of_the_search(tmp_path):
    one = equipped_of(tmp_path, RECTIFIED.format(folded=1.3, lower=0.0, upper=1000.0))
    record = rectified_record(np.random.default_rng(1), gain=2.0, folded=1.3)
    fit = identify_drive(one, [record], rng=np.random.default_rng(1), starts=1)
    assert fit.agreeing >= 2
    assert fit.identification.settings.starts >= 2
    assert fit.verdict.trustworthy


def test_where_no_other_start_arrives_nothing_is_trusted(tmp_path, monkeypatch):
    """No start more may be made: then nobody knows of other optima."""
    monkeypatch.setattr("shaftprint.bench._search.MOST", 1)
    one = equipped_of(tmp_path, RECTIFIED.format(folded=1.3, lower=0.0, upper=1000.0))
    record = rectified_record(np.random.default_rng(1), gain=2.0, folded=1.3)
    fit = identify_drive(one, [record], rng=np.random.default_rng(1), starts=1)
    assert not fit.verdict.trusted
    assert "was not examined: of 1 starts 1 ended there" in fit.verdict.reason
    assert [reason.kind for reason in fit.verdict.reasons] == ["not unique"]


@pytest.fixture(scope="module")
def one_way(tmp_path_factory):
    rng = np.random.default_rng(5)
    one = equipped_of(tmp_path_factory.mktemp("rotor"), ROTOR)
    return one, [one_way_record("up", rng, 1.0), one_way_record("down", rng, -1.0)]


@pytest.mark.long
def test_friction_that_an_offset_hides_leaves_the_other_numbers_right(one_way):
    """In motion that never turns dry friction is a constant: each record's offset takes it."""
    one, records = one_way
    for seed in (1, 2):
        fit = identify_drive(one, records, rng=np.random.default_rng(seed))
        assert fit.verdict.trusted == ("a", "B")
        found = {estimate.name: estimate for estimate in fit.identification.parameters}
        assert np.isinf(found["T_C"].std)
        assert abs(found["a"].value - A) < 4.0 * found["a"].std < 0.1 * A
        assert abs(found["B"].value - B) < 4.0 * found["B"].std < 0.1 * B
        assert fit.agreeing >= 4


@pytest.mark.long
def test_a_structure_that_holds_another_fits_no_worse(one_way):
    one, records = one_way
    compared = compare_in_time([one, without(one, ["T_C"])], records, rng=np.random.default_rng(1), starts=1)
    small, large = sorted(compared.candidates, key=lambda candidate: len(candidate.fit.parameters))
    assert large.fit.cost <= small.fit.cost * (1.0 + 1e-9)
    assert [ratio.statistic >= 0.0 for ratio in compared.ratios] == [True]
    text = " ".join(compared.sentences)
    assert "the records cannot tell T_C from the offset of a sensor" in text
    assert "can do without" not in text
    assert "worse" not in text
