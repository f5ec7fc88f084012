"""A line that is not the model is told from one that is, by segments that are simulated with what the model lacks."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

from shaftprint.service._fit import fit_segments
from shaftprint.service._misfit import Misfit, Trend
from shaftprint.service._model import FREE, service_model
from shaftprint.service._score import simulated
from shaftprint.service._segment import LeverLine, Segment
from shaftprint.vessel import load_vessel

RATE_HZ = 20.0
NOISE = 0.003


@cache
def model():
    return service_model(load_vessel("stan-tug-1205-service"))


def changed(**shares):
    """Return the true numbers with some of them changed by a share."""
    return np.array([model().values[name] * (1.0 + shares.get(name, 0.0)) for name in FREE])


def segment(drive, speed_rev_s, torque_nm):
    """Return a move of the lever, which asks for shares of the speed, and what was measured."""
    return Segment(
        log="log", start_s=0.0, move_s=2.0, move_end_s=2.0, rate_hz=RATE_HZ, every=1, lever_v=np.asarray(drive),
        speed_rev_s=speed_rev_s, torque_nm=torque_nm, state="ahead",
    )  # fmt: skip


def records(rng, truth, *, sees=lambda torque: torque, count=60):
    """Return segments of moves from and to many speeds, each of the line that ``truth(level, swing)`` says.

    ``sees``: what the channel shows of the torque, shape (samples,).
    """
    n_0, m_0 = model().engine_speed_rev_s, model().shaft_torque_nm
    line = LeverLine(slope_rev_s_per_v=n_0, middle_v=0.0, middle_rev_s=n_0, spread_rpm=0.1, stretches=20)
    samples, made = round(15.0 * RATE_HZ), []
    for _ in range(count):
        first, swing = rng.uniform(-0.25, 0.15), rng.uniform(0.02, 0.12) * rng.choice([-1.0, 1.0])
        drive = first + swing * (np.arange(samples) >= 2.0 * RATE_HZ)
        # at the speed and torque of the working point what is left is the simulation itself
        at_rest = model().records([segment(drive, np.full(samples, n_0), np.full(samples, m_0))], line)
        (run,) = simulated(at_rest, model(), truth(np.log1p(first + 0.5 * swing), abs(swing)))
        speed = -run.residuals[:, 0] / run.weight
        torque = (1.0 + speed) ** 2 - 1.0 - run.residuals[:, 1] / run.weight
        noise = NOISE * rng.standard_normal((2, samples))
        made.append(segment(drive, n_0 * (1.0 + speed + noise[0]), m_0 * (1.0 + sees(torque) + noise[1])))
    return model().records(made, line)


def found(seed, truth, *, line=None, **options):
    """Return what is found of a fit to segments."""
    return fit_segments(records(np.random.default_rng(seed), truth, **options), line or model()).misfit


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(3))
def test_nothing_speaks_against_a_line_that_is_the_model(seed):
    assert found(seed, lambda level, swing: changed()).reason == ""


def test_numbers_that_are_not_those_of_the_start_are_no_other_line():
    assert found(1, lambda level, swing: changed(K_p=0.03, t_d=-0.05, tau_dn=0.01)).reason == ""


@pytest.mark.slow
@pytest.mark.parametrize(
    ("truth", "words"),
    [
        (lambda level, swing: changed(K_p=0.3 * level, K_i=0.3 * level), "the gains of the governor hang on the speed"),
        (lambda level, swing: changed(t_d=-level), "the delay of the governor hangs on the speed"),
        (
            lambda level, swing: changed(K_p=0.1 * np.log(swing / 0.06), K_i=0.1 * np.log(swing / 0.06)),
            "the gains of the governor hang on the size of the move",
        ),
    ],
)
def test_numbers_that_hang_on_speed_or_move_are_named(truth, words):
    assert found(2, truth).reason.startswith(words)


@pytest.mark.slow
def test_how_gains_go_with_the_speed_is_measured():
    trend = found(3, lambda level, swing: changed(K_p=0.2 * level, K_i=0.2 * level)).trends[0]
    assert trend.size == pytest.approx(0.2, abs=4.0 * trend.std)
    assert trend.std < 0.05


@pytest.mark.slow
def test_what_a_trend_does_to_other_numbers_is_in_their_deviations():
    """A delay that goes with the speed draws the gain along, whose scatter does not show it."""
    truth = changed()
    fit = fit_segments(records(np.random.default_rng(100), lambda level, swing: changed(t_d=-0.3 * level)), model())
    place = FREE.index("K_p")
    off, variance = fit.theta[place] - truth[place], fit.covariance[place, place]
    assert abs(off) < 2.5 * np.sqrt(variance)
    assert abs(off) > 5.0 * np.sqrt(variance - fit.misfit.spread[place, place])


def test_a_torque_behind_a_filter_is_no_gauge_that_is_late_by_a_stated_time():
    def filtered(torque):
        shown = torque.copy()
        for k in range(1, shown.size):
            shown[k] = shown[k - 1] + (torque[k] - shown[k - 1]) * (1.0 - np.exp(-1.0 / (RATE_HZ * 0.1)))
        return shown

    misfit = found(4, lambda *_: changed(), sees=filtered)
    assert misfit.reason.startswith("the latency of the gauge would be")
    assert misfit.torque > 3.0 > misfit.chance


@pytest.mark.slow
def test_an_inertia_far_from_that_of_the_vessel_file_is_named():
    std = model().prior_std["tau_up"]
    off = replace(model(), known={**model().known, "tau_up": model().known["tau_up"] + 8.0 * std})
    reason = found(5, lambda *_: changed(), line=off).reason
    assert "the inertia ahead of the gauge would be" in reason
    assert "below what is known of it, as with a rate limit of the demand" in reason


def test_what_is_too_small_to_matter_is_no_reason_however_long_the_service():
    trend = Trend(what="the gains", along="hang on the speed", by="a table", size=0.01, std=1e-4, gain=1e4, least=0.04)
    misfit = Misfit(
        speed=1.0, torque=1.0, chance=1.0, gain=0.0, hanging=1.0, trends=(trend,), pulled=(), spread=np.zeros((1, 1))
    )
    assert misfit.reason == ""
    assert replace(misfit, trends=(replace(trend, size=0.05),)).reason.startswith("the gains hang on the speed")


@pytest.mark.parametrize(
    ("deviations", "gain", "is_there"), [(2.5, 57.0, True), (2.6, 18.0, False), (1.4, 60.0, False)]
)
def test_a_trend_that_leaves_scatter_of_its_own_is_told_by_what_the_likelihood_gains(deviations, gain, is_there):
    """A launch whose delay counts in turns: 2.5 deviations, 57 more likelihood, the sum of the delays 32 % long."""
    trend = Trend(what="it", along="hangs", by="a", size=-0.01 * deviations, std=0.01, gain=gain, least=0.001)
    assert trend.is_there is is_there
