"""What the error of the working point does to what is reported: against fits of data divided by another one."""

from dataclasses import replace

import numpy as np
import pytest
from tests.known_fits import exact_response, known_signals, taken

from shaftprint.catalogue import structure
from shaftprint.fingerprint import physical_quantities
from shaftprint.fingerprint._joint_numbers import joint_numbers
from shaftprint.fingerprint._leg_records import leg_record
from shaftprint.fingerprint._physical import physical_numbers
from shaftprint.fingerprint._working_point_share import (
    GAIN,
    LOAD_WANDER,
    RACK,
    SPEED,
    shifts_of_working_point,
    std_beside_fit,
    widened,
    widened_covariance,
)
from shaftprint.identify import Prior, Settings, budget, identify, identify_jointly, priors_from_vessel
from shaftprint.models import at_working_point
from shaftprint.signals import LegState

MORE = 0.01


@pytest.fixture(scope="module")
def known(vessel, working_point):
    return priors_from_vessel(structure("GAUGE-CLOSED"), vessel, working_point)


@pytest.fixture(scope="module")
def found(fit, truth, known):
    return fit("GAUGE-CLOSED", truth, share=0.0005, settings=Settings(starts=20, priors=known))


@pytest.fixture(scope="module")
def stated(found, working_point, vessel):
    numbers = physical_numbers(found, working_point, vessel)
    direct = {item.number.name: item.direct for item in numbers}
    shifts = shifts_of_working_point(found, working_point)
    return budget(found, [item.number for item in numbers], direct=direct, shifts=shifts)


@pytest.fixture(scope="module")
def divided_by_more(found, working_point, vessel):
    """The fit of the same test, whose mean load was found 1 % too high: responses, loads and prior are 1 % smaller."""
    response = found.response
    sizes = np.array([1.0, 1.0 / (1.0 + MORE)])
    halves = np.tile(sizes, 2)
    smaller = replace(
        response,
        response=response.response * sizes[:, None, None],
        covariance=response.covariance * np.outer(halves, halves),
        load=response.load / (1.0 + MORE),
    )
    more = replace(working_point, shaft_torque_nm=(1.0 + MORE) * working_point.shaft_torque_nm)
    priors = priors_from_vessel(structure("GAUGE-CLOSED"), vessel, more) | {"g": Prior(0.0, 0.1 / (1.0 + MORE))}
    settings = Settings(starts=20, priors=priors)
    return identify(found.structure, smaller, rng=np.random.default_rng(7), settings=settings)


def test_numbers_move_with_the_load_as_their_part_of_the_budget_says(found, stated, divided_by_more, working_point):
    before = {e.name: e for e in (*found.parameters, *found.combinations)}
    for after in (*divided_by_more.parameters, *divided_by_more.combinations):
        moved = abs(after.value - before[after.name].value) / MORE * working_point.load_std
        part = stated.row(after.name).variances[LOAD_WANDER] ** 0.5
        # what is not to first order: a hundredth of it
        assert moved == pytest.approx(part, rel=0.02, abs=2e-3 * before[after.name].std)


def test_physical_values_do_not_know_of_it_but_the_torque_coefficient_does(stated, found, working_point, vessel):
    for name in ("I_dn", "I_up", "governor proportional action", "governor integral action"):
        row = stated.row(name)
        assert std_beside_fit(stated, name) < 1e-6 * row.value
    assert std_beside_fit(stated, "K_Q") == pytest.approx(working_point.load_std * stated.row("K_Q").value)
    wandering = replace(working_point, load_std=0.05)
    calm = {q.name: q for q in physical_quantities(found, working_point, vessel)}
    for quantity in physical_quantities(found, wandering, vessel):
        assert (quantity.std == pytest.approx(calm[quantity.name].std)) == (quantity.name != "K_Q")


def test_an_inertia_time_has_the_share_of_load_and_speed(found, stated, working_point):
    """Load known to 0.5 %, speed to 0.01 of 19.73 rev/s; ratios of two such numbers have neither."""
    value = found.value("tau_dn")
    assert stated.row("tau_dn").variances[LOAD_WANDER] == pytest.approx((0.005 * value) ** 2)
    assert stated.row("tau_dn").variances[SPEED] == pytest.approx((0.01 / 19.73 * value) ** 2)
    for name in ("K_p / K_i", "v K_p / (tau_up + tau_dn)", "t_d", "k_q", "c_set"):
        assert std_beside_fit(stated, name) < 1e-6 * abs(stated.row(name).value)


def test_covariance_grows_by_the_same(found, stated, working_point):
    grown = widened_covariance(found.covariance, found, shifts_of_working_point(found, working_point))
    variances = np.diag(grown)
    for place, estimate in enumerate(found.parameters):
        assert variances[place] == pytest.approx(stated.row(estimate.name).std ** 2, rel=1e-6)
    names = [estimate.name for estimate in found.parameters]
    up, down = names.index("tau_up"), names.index("tau_dn")
    share = 0.005**2 + (0.01 / 19.73) ** 2
    expected = share * found.value("tau_up") * found.value("tau_dn")
    assert grown[up, down] - found.covariance[up, down] == pytest.approx(expected)


def test_numbers_move_with_the_rack_as_their_part_of_the_budget_says(fit, truth, vessel, working_point):
    """The same test, whose mean rack was found 1 % too high: the rack's response is 1 % smaller."""
    settings = Settings(starts=20, priors=priors_from_vessel(structure("GAUGE-ECU"), vessel, working_point))
    found = fit("GAUGE-ECU", truth, share=0.0005, settings=settings)
    size = np.where(np.array(found.response.outputs) == "X", 1.0 / (1.0 + MORE), 1.0)
    smaller = replace(
        found.response,
        response=found.response.response * size[:, None, None],
        covariance=found.response.covariance * np.outer(np.tile(size, 2), np.tile(size, 2)),
    )
    after = identify(found.structure, smaller, rng=np.random.default_rng(7), settings=settings)
    stated = budget(found, shifts=shifts_of_working_point(found, working_point, rack_share=MORE))
    before = {e.name: e.value for e in (*found.parameters, *found.combinations)}
    for estimate in (*after.parameters, *after.combinations):
        moved = abs(estimate.value - before[estimate.name])
        part = stated.row(estimate.name).variances.get(RACK, 0.0) ** 0.5
        assert part == pytest.approx(moved, rel=0.02, abs=1e-5 * abs(before[estimate.name]) + 1e-7), estimate.name
    for name in ("K_p", "K_i", "v"):
        assert std_beside_fit(stated, name) == pytest.approx(
            np.sqrt(MORE**2 + (name != "v") * (0.005**2 + (0.01 / 19.73) ** 2)) * before[name], rel=1e-3
        )


def test_a_rack_that_is_not_in_the_structure_moves_nothing(found, working_point):
    assert shifts_of_working_point(found, working_point, rack_share=MORE) == shifts_of_working_point(
        found, working_point
    )


def test_a_gain_that_changed_between_two_legs_moves_what_their_fit_finds(found, truth, known, working_point):
    def fit_of(gain):
        """Return the fit to two legs, the second of which is tied by a torque that is shown so much too large."""
        first = structure("GAUGE-CLOSED")
        tied = at_working_point(first, speed_share=0.7, torque_share=0.49 * (1.0 + gain), shown_share=0.49)
        rng, settings = np.random.default_rng(7), Settings(starts=20, priors=known)
        return identify_jointly(list(zip((first, tied), data, strict=True)), rng=rng, settings=settings)

    gain = 0.0002
    at_slow = at_working_point(structure("GAUGE-CLOSED"), speed_share=0.7, torque_share=0.49, shown_share=0.49)
    data = [exact_response(one, truth, 0.0005) for one in (structure("GAUGE-CLOSED"), at_slow)]
    before, after = fit_of(0.0), fit_of(gain)
    legs = [working_point, replace(working_point, unseen_gain=gain)]
    shift = shifts_of_working_point(before, working_point, legs=legs)[GAIN]
    for one, other in zip(before.parameters, after.parameters, strict=True):
        moved = other.value - one.value
        assert shift[one.name] == pytest.approx(moved, rel=0.01, abs=1e-4 * one.std), one.name
    # 0.05 % of K_p for 0.02 % between the legs
    assert shift["K_p"] / truth["K_p"] == pytest.approx(-2.3 * gain, rel=0.05)
    # a gain that is off alike in both is a scale of the gauge
    alike = [replace(leg, unseen_gain=gain) for leg in legs]
    assert shifts_of_working_point(before, working_point, legs=alike)[GAIN] == pytest.approx(dict.fromkeys(shift, 0.0))
    assert GAIN not in shifts_of_working_point(found, working_point)


def test_the_gain_between_those_legs_of_a_test_that_were_chosen_is_in_their_budget(truth, known, working_point):
    """Three legs were sailed, and two of them are fitted."""
    first = structure("GAUGE-CLOSED")
    pairs = [
        (one, exact_response(one, truth, 0.0005))
        for one in (first, at_working_point(first, speed_share=0.7, torque_share=0.49, shown_share=0.49))
    ]
    fit = identify_jointly(pairs, rng=np.random.default_rng(7), settings=Settings(starts=20, priors=known))
    points = {
        name: replace(working_point, engine_speed_rev_s=share * working_point.engine_speed_rev_s, unseen_gain=gain)
        for name, share, gain in (("M1", 1.0, 0.001), ("M2", 0.85, 0.003), ("M3", 0.7, -0.004))
    }
    states = [
        LegState(name=name, start_s=400.0 * place, period_s=30.0, periods=10, working_point=point)
        for place, (name, point) in enumerate(points.items())
    ]
    fitted = [leg_record(state, main=points["M1"], p_value=0.5) for state in states if state.name != "M2"]
    kept = taken(fit, signals=replace(known_signals(points["M1"]), legs=tuple(states)), legs=fitted)
    shift = shifts_of_working_point(fit, points["M1"], legs=[points["M1"], points["M3"]])[GAIN]["K_p"]
    assert kept.budget.row("K_p").variances[GAIN] == pytest.approx(shift**2)
    # 0.5 % between the two, see above
    assert abs(shift) / truth["K_p"] == pytest.approx(2.3 * 0.005, rel=0.05)


def test_the_gain_of_a_leg_that_is_fitted_alone_is_no_error_that_two_tests_share(found, working_point, vessel):
    shifts = shifts_of_working_point(found, working_point)
    known, unseen = (
        joint_numbers(found, replace(working_point, unseen_gain=gain), vessel, shifts) for gain in (0.0, 0.002)
    )
    assert unseen.loadings == known.loadings
    value = next(item.number for item in physical_numbers(found, working_point, vessel) if item.number.name == "K_Q")
    of_gain = unseen.covariance_of(("K_Q",)) - known.covariance_of(("K_Q",))
    named = found.structure.named(found.structure_values())
    assert of_gain[0, 0] == pytest.approx((0.002 * float(value.of(named))) ** 2)


def test_half_widths_add_in_quadrature_and_bounds_stay():
    # 3 and 1.96 * 2.0408 = 4 give 5
    assert widened((7.0, 13.0), 10.0, 4.0 / 1.959963985, (False, False)) == pytest.approx((5.0, 15.0))
    assert widened((7.0, 13.0), 10.0, 4.0 / 1.959963985, (True, False)) == pytest.approx((7.0, 15.0))
    assert widened((7.0, 13.0), 10.0, 0.0, (False, False)) == (7.0, 13.0)
