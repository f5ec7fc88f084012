"""Differences of two fingerprints against numbers worked out by hand and against simulated pairs."""

import math
from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import ShipRole
from shaftprint.fingerprint import SourceFile
from shaftprint.identify import Budget, BudgetRow
from shaftprint.report import differences
from shaftprint.report.sections._comparison_cover import change_in_words


def quantity(fingerprint, **changes):
    usual = {"name": "I_dn", "unit": "kg m2", "interval_95": None, "interval_open": (False, False)}
    return replace(fingerprint.physical[0], **usual | changes)


SCALE, STD = "sensors.shaft_torque.scale_nm_per_unit", "sensors.shaft_torque.scale_std_fraction"
GAUGE = {SCALE: 300.0, STD: 0.02}


def deviation(difference):
    """Standard deviation of a difference, from its interval."""
    return (difference.interval_95[1] - difference.interval_95[0]) / 2.0 / 1.95996


def with_quantities(fingerprint, *quantities, variances=None, vessel="ab", stated=GAUGE):
    """A fingerprint with nothing but the given physical values."""
    rows = tuple(
        BudgetRow(
            name=q.name, unit=q.unit, value=q.value, variances=(variances or {}).get(q.name, {"noise of n": q.std**2})
        )
        for q in quantities
    )
    sources = (SourceFile(role="vessel", name="tug.toml", sha256=vessel * 32),)
    return fingerprint.model_copy(
        update={
            "physical": quantities,
            "parameters": (),
            "combinations": (),
            "margins": (),
            "budget": Budget(sources=("noise of n", "gauge scale", "TVC"), rows=rows),
            "sources": sources,
            "vessel_fields": stated,
        }
    )


def test_noise_of_two_tests_adds_up(fingerprint):
    """13 +/- 1 against 10 +/- 1: 3 +/- 1.414, two-sided p = erfc(3 / 1.414 / 1.414) = 0.0339."""
    first = with_quantities(fingerprint, quantity(fingerprint, value=10.0, std=1.0))
    other = with_quantities(fingerprint, quantity(fingerprint, value=13.0, std=1.0))
    (found,) = differences(first, other)
    assert found.value == pytest.approx(3.0)
    assert found.interval_95 == pytest.approx((3.0 - 2.7718, 3.0 + 2.7718), abs=1e-3)
    assert found.p_value == pytest.approx(0.033895, abs=1e-5)
    assert found.outcome == "differs"


def test_what_both_were_told_alike_cannot_make_a_difference(fingerprint):
    """Of a standard deviation of 1.005, 1 is the gauge's scale: alike in both, it leaves 0.1 times root two."""
    variances = {"I_dn": {"noise of n": 0.01, "gauge scale": 1.0}}
    values = [quantity(fingerprint, value=value, std=math.sqrt(1.01)) for value in (10.0, 10.5)]
    same = [with_quantities(fingerprint, q, variances=variances) for q in values]
    (found,) = differences(*same)
    assert deviation(found) == pytest.approx(0.1 * math.sqrt(2.0), rel=1e-3)
    assert found.outcome == "differs"
    recalibrated = with_quantities(
        fingerprint, values[1], variances=variances, vessel="cd", stated={SCALE: 301.0, STD: 0.02}
    )
    (found,) = differences(same[0], recalibrated)
    assert deviation(found) == pytest.approx(math.sqrt(2.02), rel=1e-3)
    assert found.outcome == "no difference seen"


@pytest.mark.parametrize(
    "change", [{"sensors.shaft_torque.zero_nm": 12.0}, {"name": "another name"}, {"water_density_kg_m3": 1000.0}]
)
def test_another_zero_or_name_is_no_other_gauge(fingerprint, change):
    """The hash of the vessel file is another, the scale of the gauge is the same: its error cancels all the same."""
    variances = {"I_dn": {"noise of n": 0.01, "gauge scale": 1.0}}
    first, other = (
        with_quantities(
            fingerprint,
            quantity(fingerprint, value=value, std=math.sqrt(1.01)),
            variances=variances,
            vessel=vessel,
            stated=GAUGE | more,
        )
        for value, vessel, more in ((10.0, "ab", {}), (10.5, "cd", change))
    )
    (found,) = differences(first, other)
    assert deviation(found) == pytest.approx(0.1 * math.sqrt(2.0), rel=1e-3)
    assert found.outcome == "differs"


@pytest.mark.parametrize(("second", "std"), [("ab", 0.1 * math.sqrt(2.0)), ("cd", math.sqrt(2.02))])
def test_of_a_file_without_fields_the_hash_decides(fingerprint, second, std):
    """A fingerprint of an earlier version: alike where the hash is, in full where it is not."""
    variances = {"I_dn": {"noise of n": 0.01, "gauge scale": 1.0}}
    first, other = (
        with_quantities(
            fingerprint,
            quantity(fingerprint, value=10.0, std=math.sqrt(1.01)),
            variances=variances,
            vessel=file,
            stated=stated,
        )
        for file, stated in (("ab", {}), (second, GAUGE))
    )
    assert deviation(differences(first, other)[0]) == pytest.approx(std, rel=1e-3)


def test_the_load_of_another_day_is_in_the_torque_coefficient_alone(fingerprint):
    """0.0500 +/- 0.0003 twice: with 1 % from day to day sqrt(2) times the root of 0.0003^2 + 0.0005^2."""
    names = ("K_Q", "I_dn")
    pair = [
        with_quantities(fingerprint, *(quantity(fingerprint, name=n, value=0.05, std=0.0003) for n in names))
        for _ in range(2)
    ]
    found = differences(*pair, load_repeatability=0.01)
    expected = [math.sqrt(2.0 * (9e-8 + 25e-8)), math.sqrt(2.0) * 3e-4]
    assert [deviation(one) for one in found] == pytest.approx(expected, rel=1e-3)


def test_where_nothing_can_be_compared_nothing_is_said_of_the_ship(fingerprint):
    first = with_quantities(
        fingerprint, quantity(fingerprint, value=10.0, std=1.0, interval_95=(9.0, 10.5), interval_open=(False, True))
    )
    other = with_quantities(fingerprint, quantity(fingerprint, value=30.0, std=1.0))
    for found in (differences(first, other), ()):
        assert change_in_words(found).startswith("It cannot be told")
    assert change_in_words(differences(other, other)).startswith("No: one number stands for it")


def test_the_sides_that_face_each_other_count(fingerprint):
    """Zou and Donner: of 10 (9 to 14) and 13 (12.5 to 20), the lower end is 3 - sqrt(0.5^2 + 4^2), the upper
    3 + sqrt(7^2 + 1^2)."""
    first = with_quantities(fingerprint, quantity(fingerprint, value=10.0, std=1.0, interval_95=(9.0, 14.0)))
    other = with_quantities(fingerprint, quantity(fingerprint, value=13.0, std=1.0, interval_95=(12.5, 20.0)))
    (found,) = differences(first, other)
    assert found.interval_95 == pytest.approx((3.0 - math.sqrt(16.25), 3.0 + math.sqrt(50.0)))
    assert found.outcome == "no difference seen"


def test_an_open_end_that_faces_the_other_forbids_a_comparison(fingerprint):
    first = with_quantities(
        fingerprint,
        quantity(fingerprint, value=10.0, std=1.0, interval_95=(9.0, 10.5), interval_open=(False, True)),
    )
    other = with_quantities(fingerprint, quantity(fingerprint, value=30.0, std=1.0))
    (found,) = differences(first, other)
    assert found.outcome == "cannot be compared"
    assert found.p_value is None
    (turned,) = differences(other, first)
    assert turned.outcome == "cannot be compared"


def test_many_numbers_make_chance_more_likely(fingerprint):
    """Holm: of p = 0.010, 0.030 and 0.040 the smallest is asked to be below 0.05 / 3, the next below 0.05 / 2."""
    normal = {0.010: 2.5758, 0.030: 2.1701, 0.040: 2.0537}
    names = ("I_dn", "I_up", "K_Q")
    first = with_quantities(fingerprint, *(quantity(fingerprint, name=n, value=1.0, std=1e-9) for n in names))
    other = with_quantities(
        fingerprint,
        *(quantity(fingerprint, name=n, value=1.0 + z, std=1.0) for n, z in zip(names, normal.values(), strict=True)),
    )
    found = differences(first, other)
    assert [round(d.p_value, 3) for d in found] == [0.010, 0.030, 0.040]
    assert [d.outcome for d in found] == ["differs", "perhaps", "perhaps"]


def test_equal_lines_differ_by_chance_in_one_of_twenty_tests(fingerprint):
    """2,000 pairs of tests of one line: one common error of the gauge, one error of noise each."""
    rng = np.random.default_rng(5)
    variances = {"I_dn": {"noise of n": 0.04, "gauge scale": 0.25}}
    rejected = 0
    for _ in range(2000):
        common = 0.5 * rng.standard_normal()
        pair = [
            with_quantities(
                fingerprint,
                quantity(fingerprint, value=17.0 + common + 0.2 * rng.standard_normal(), std=math.sqrt(0.29)),
                variances=variances,
            )
            for _ in range(2)
        ]
        rejected += differences(*pair)[0].p_value < 0.05
    assert 0.035 < rejected / 2000 < 0.065


def test_only_what_both_have_in_one_unit_is_compared(fingerprint):
    first = with_quantities(fingerprint, quantity(fingerprint, value=1.0, std=1.0), quantity(fingerprint, name="I_up"))
    other = with_quantities(fingerprint, quantity(fingerprint, value=1.0, std=1.0, unit="t m2"))
    assert differences(first, other) == ()


def test_what_moves_with_the_working_point_is_told_by_what_does_not(fingerprint):
    """At a torque 6 % less an inertia time is 6 % longer, by a hundred of its deviations: the inertia is as it was."""
    inertia = [with_quantities(fingerprint, quantity(fingerprint, value=value, std=1.0)) for value in (17.0, 17.2)]
    times = [quantity(fingerprint, name="tau_dn", unit="s", value=value, std=0.0001) for value in (0.31, 0.33)]
    pair = [f.model_copy(update={"parameters": (time,)}) for f, time in zip(inertia, times, strict=True)]
    found = {one.first.name: one for one in differences(*pair)}
    assert found["tau_dn"].normalised
    assert (found["tau_dn"].outcome, found["tau_dn"].p_value) == ("cannot be compared", None)
    assert found["tau_dn"].because == "moving with the working point; see I_dn"
    assert found["I_dn"].outcome == "no difference seen"
    alone = differences(*(f.model_copy(update={"physical": ()}) for f in pair))
    assert alone[0].because == "moving with the working point"


def test_delays_and_ratios_of_gains_stand_for_the_ship(fingerprint):
    """A delay 20 ms longer is judged together with the inertia; a factor on the set point is not."""
    names, roles = ("t_d + t_sp", "c_set"), (ShipRole.TOTAL_DELAY, ShipRole.SET_POINT_SCALE)
    pair = []
    for delay, factor in ((0.120, 1.00), (0.140, 1.01)):
        parts = [
            quantity(fingerprint, name=name, value=value, std=0.001, role=role)
            for name, value, role in zip(names, (delay, factor), roles, strict=True)
        ]
        alone = with_quantities(fingerprint, quantity(fingerprint, value=17.0, std=1.0))
        pair.append(alone.model_copy(update={"combinations": tuple(parts)}))
    found = {one.first.name: one for one in differences(*pair)}
    assert [found[name].normalised for name in ("I_dn", *names)] == [False, False, True]
    assert [found[name].outcome for name in ("I_dn", *names)] == ["no difference seen", "differs", "differs"]
    assert change_in_words(tuple(found.values())).startswith("Yes: t_d + t_sp by 16.7 %")


def test_zero_of_the_gauge_may_drift_as_far_as_the_vessel_file_says(fingerprint):
    """Two zeros, each 0 +/- 1.4 % and found to 0.1 %: 3.9 % apart is two deviations of 1.985 %, 6 % is three."""
    first, near, far = (
        with_quantities(
            fingerprint,
            quantity(
                fingerprint, name="gauge zero share", unit="%", value=value, std=0.1, expected=0.0, expected_std=1.4
            ),
        )
        for value in (0.0, 3.89, 6.0)
    )
    (found,) = differences(first, near)
    assert found.interval_95[1] - found.interval_95[0] == pytest.approx(2.0 * 1.96 * 1.98494, rel=1e-4)
    assert found.p_value == pytest.approx(0.05, abs=1e-3)
    assert differences(first, far)[0].outcome == "differs"


COUNT, PAIRS = 8, 2000


def simulated_pairs(fingerprint, change, correlation, seed):
    """Yield differences of pairs whose numbers are normal with known covariance; the first has changed by so much.

    Each number errs by a common 1 that both were told alike, and by 1 / sqrt(2) of its own: a difference has the
    standard deviation 1; all numbers of one test are correlated.
    """
    rng = np.random.default_rng(seed)
    root = np.linalg.cholesky(np.full((COUNT, COUNT), correlation) + (1.0 - correlation) * np.eye(COUNT))
    variances = {f"q{i}": {"noise of n": 0.5, "TVC": 1.0} for i in range(COUNT)}
    for _ in range(PAIRS):
        told = rng.standard_normal(COUNT)
        pair = []
        for shift in (0.0, change):
            values = 100.0 + told + root @ rng.standard_normal(COUNT) / math.sqrt(2.0)
            values[0] += shift
            numbers = [
                quantity(fingerprint, name=f"q{i}", value=float(value), std=math.sqrt(1.5))
                for i, value in enumerate(values)
            ]
            pair.append(with_quantities(fingerprint, *numbers, variances=variances))
        yield differences(*pair)


@pytest.mark.slow
@pytest.mark.parametrize(("correlation", "least"), [(0.0, 0.0395), (0.8, 0.005)])
def test_an_unchanged_ship_is_called_changed_in_one_of_twenty_comparisons(fingerprint, correlation, least):
    """Of eight independent numbers 1 - (1 - 0.05 / 8)^8 = 0.0489, within 0.0095 in 19 of 20 runs of 2000 pairs; of
    correlated ones less."""
    alarms = sum(
        change_in_words(found).startswith("Yes") for found in simulated_pairs(fingerprint, 0.0, correlation, seed=8)
    )
    assert least < alarms / PAIRS < 0.0584


@pytest.mark.slow
@pytest.mark.parametrize(("change", "power"), [(4.0, 0.8972), (4.5, 0.9613), (5.0, 0.9883)])
def test_a_change_is_named_as_often_as_its_size_allows(fingerprint, change, power):
    """One of eight: the normal distribution leaves 0.05 / 16 beyond 2.7344, and the change is that much further out.

    Once it is out, the others are asked 0.05 / 7; chance names one of them in less than one of twenty pairs.
    """
    named = others = 0
    for found in simulated_pairs(fingerprint, change, 0.0, seed=9):
        outcomes = [one.outcome == "differs" for one in found]
        named += outcomes[0]
        others += any(outcomes[1:])
    spread = math.sqrt(power * (1.0 - power) / PAIRS)
    assert named / PAIRS == pytest.approx(power, abs=3.0 * spread)
    assert others / PAIRS < 0.065


def test_a_physical_value_is_as_lopsided_as_its_parameter(fingerprint):
    """K_p of 5 lies between 4.5 and 8, so an action of 10 lies between 9 and 16; 14 +/- 1 is no surprise then."""
    gain_role = ShipRole.PROPORTIONAL_GAIN
    gain = quantity(fingerprint, name="K_p", unit="-", value=5.0, std=0.2, interval_95=(4.5, 8.0), role=gain_role)
    actions = [
        quantity(fingerprint, name="governor proportional action", value=value, std=std, role=gain_role)
        for value, std in ((10.0, 0.4), (14.0, 1.0))
    ]
    first, other = (with_quantities(fingerprint, action) for action in actions)
    (found, *_) = differences(first.model_copy(update={"parameters": (gain,)}), other)
    assert found.interval_95[0] == pytest.approx(4.0 - math.hypot(1.96, 6.0), abs=1e-3)
    assert found.outcome == "no difference seen"
    (surer,) = differences(first, other)
    assert surer.outcome == "differs"
    # where the bound of the search ends the interval of K_p, it ends nothing of the action's
    bounded = replace(gain, interval_open=(False, True))
    (unknown, *_) = differences(first.model_copy(update={"parameters": (bounded,)}), other)
    assert unknown.outcome == "cannot be compared"
    less = with_quantities(fingerprint, replace(actions[0], value=5.0))
    (known, *_) = differences(first.model_copy(update={"parameters": (bounded,)}), less)
    assert known.outcome == "differs"
