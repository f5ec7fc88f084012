"""Intervals of the margins: each has a profile of its own."""

import numpy as np
import pytest

from shaftprint.fingerprint._margin_numbers import margin_numbers
from shaftprint.fingerprint._margins import margin_quantities
from shaftprint.identify import Settings, identify, profile
from shaftprint.models import Delay, Gain, Integrator, Parameter, Structure, feedback, margins

DELAY_S = 0.2
GAIN = Parameter("K", "1/s", 0.0, 7.0, 2.0, "gain")


def one_gain():
    """A gain, an integrator and a known delay under feedback: ``L = K exp(-s T) / s``."""
    delay = Parameter("T", "s", 0.0, 1.0, DELAY_S, "delay", held=True)
    loop = Gain(GAIN) * Integrator() * Delay(delay)
    return Structure(name="ONE-GAIN", title="integrator with delay", input="u", outputs={"y": feedback(loop)})


def of(identification):
    numbers = margin_numbers(identification.structure, identification.values)
    return {q.name: q for q in margin_quantities(identification, profile(identification, numbers))}


@pytest.fixture(scope="module")
def profiled(gauge_fit):
    return profile(gauge_fit, margin_numbers(gauge_fit.structure, gauge_fit.values))


def test_ends_of_a_loop_of_one_gain_follow_from_those_of_the_gain(respond):
    """By hand: gain margin ``pi / (2 K T)``, crossover at ``K``, phase ``pi / 2 - K T``, delay ``pi / (2 K) - T``."""
    response = respond(one_gain(), {"K": 2.0}, share=0.1, seed=3)
    found = identify(one_gain(), response, rng=np.random.default_rng(1), settings=Settings(starts=10))
    gain = profile(found).intervals["K"]
    ends = np.array([gain.upper, gain.lower])
    stated = of(found)
    assert stated["gain margin"].interval_95 == pytest.approx(np.pi / (2.0 * ends * DELAY_S), rel=1e-3)
    assert stated["phase margin"].interval_95 == pytest.approx(90.0 - np.degrees(ends * DELAY_S), rel=1e-3)
    assert stated["delay margin"].interval_95 == pytest.approx(np.pi / (2.0 * ends) - DELAY_S, rel=1e-3)
    std = found.parameters[0].std
    assert stated["phase margin"].std == pytest.approx(np.degrees(std * DELAY_S), rel=1e-4)


def test_each_end_lies_on_the_contour_that_belongs_to_95_percent(gauge_fit, profiled):
    free = list(gauge_fit.objective.free)
    residuals, _ = gauge_fit.objective.residuals(profiled.points[-6:, free])
    rise = np.sum(residuals**2, axis=1) - 2.0 * gauge_fit.cost
    np.testing.assert_allclose(rise, 1.959964**2, rtol=0.012)
    reached = [margins(gauge_fit.structure, point) for point in profiled.points[-6:]]
    stated = {q.name: q for q in margin_quantities(gauge_fit, profiled)}
    assert stated["gain margin"].interval_95 == pytest.approx([m.gain_margin for m in reached[:2]], rel=1e-4)
    phases = [np.degrees(m.phase_margin_rad) for m in reached[2:4]]
    assert stated["phase margin"].interval_95 == pytest.approx(phases, rel=1e-4)
    assert stated["delay margin"].interval_95 == pytest.approx([m.delay_margin_s for m in reached[4:]], rel=1e-4)


@pytest.mark.slow
def test_no_set_that_the_data_allow_lies_outside(gauge_fit, profiled):
    """The ends of all other intervals are on the same contour: their margins are inside."""
    stated = {q.name: q for q in margin_quantities(gauge_fit, profiled)}
    for point in profiled.points[:-6]:
        found = margins(gauge_fit.structure, point)
        for name, value in (
            ("gain margin", found.gain_margin),
            ("phase margin", np.degrees(found.phase_margin_rad)),
            ("delay margin", found.delay_margin_s),
        ):
            lower, upper = stated[name].interval_95
            room = 0.01 * (upper - lower)
            assert lower - room <= value <= upper + room


def test_many_sets_at_once_have_the_margins_of_each_alone(gauge_fit):
    model = gauge_fit.structure
    rng = np.random.default_rng(5)
    table = np.tile(gauge_fit.values, (30, 1))
    for name, low, high in (("K_p", 2.0, 9.0), ("K_i", 1.0, 9.0), ("t_d", 0.0, 0.2), ("zeta", 0.2, 1.5)):
        table[:, model.names.index(name)] = rng.uniform(low, high, 30)
    alone = [margins(model, row) for row in table]
    for number, value in zip(
        margin_numbers(model, gauge_fit.values),
        (
            [m.gain_margin for m in alone],
            [np.degrees(m.phase_margin_rad) for m in alone],
            [m.delay_margin_s for m in alone],
        ),
        strict=True,
    ):
        np.testing.assert_allclose(number.of(model.named(table)), value, rtol=1e-5)


def test_a_margin_that_vanishes_is_infinite(fit):
    """Without delay and lag no gain makes the loop hunt."""
    model = one_gain()
    number = margin_numbers(model, model.vector({"K": 2.0}))[0]
    named = {"K": np.array([2.0, 2.0]), "T": np.array([DELAY_S, 0.0])}
    assert number.of(named) == pytest.approx([np.pi / (4.0 * DELAY_S), np.inf])


def test_without_a_profile_there_is_no_interval(gauge_fit):
    assert all(quantity.interval_95 is None for quantity in margin_quantities(gauge_fit))
