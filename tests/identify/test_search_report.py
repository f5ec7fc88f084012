"""What a search tells of its optima: how many starts reached which, rivals, wrong basins, unstable ones, bounds."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Draw, Settings, Unweighted, assess, identify, scan
from shaftprint.identify.fit._identification import Cluster
from shaftprint.identify.judgement._search_report import report_search
from shaftprint.models import Delay, Gain, Parameter, PIGovernor, Sensitivity, Shaft, Structure
from shaftprint.spectra import FrequencyResponse


def late(upper=0.95):
    """A pure delay: an optimum at every turn of its lines."""
    time = Parameter("t", "s", 0.0, upper, 0.1, "test")
    return Structure(name="late", title="", input="u", outputs={"y": Delay(time)})


def two_lines(std, wrong=0.0):
    """Lines at 2 and 3 Hz of a delay of 0.1 s; at 3 Hz out by an angle."""
    frequency = np.array([2.0, 3.0])
    angle = np.array([0.0, wrong])
    return FrequencyResponse(
        frequency_hz=frequency,
        response=np.exp(-2j * np.pi * frequency * 0.1 + 1j * angle)[None, None],
        covariance=np.stack([np.eye(2) * s**2 for s in std]),
        inputs=("u",),
        outputs=("y",),
    )


class Given(Draw):
    """Starts at given values of one parameter."""

    __slots__ = ("at",)

    def __init__(self, *at):
        self.at = at

    def starts(self, lower, upper, count, rng):
        return np.array(self.at)[:, None]


def searched(response, at, made_of=None, **settings):
    chosen = Settings(draw=Given(*at), starts=len(at), stability="ignored", **settings)
    return identify(made_of or late(), response, rng=np.random.default_rng(1), settings=chosen)


def test_all_starts_in_one_optimum():
    found = report_search(searched(two_lines([0.1, 0.1]), [0.08, 0.1, 0.12]))
    assert found.sentences == ("All 3 starts reached the same optimum.",)
    assert [(o.starts, o.distance) for o in found.optima] == [(3, 0.0)]
    assert found.rivals == ()


def test_starts_are_counted_for_every_optimum():
    """Next to 0.1 s the cost has optima near 0.47 s and 0.73 s, mirror images of each other."""
    found = report_search(searched(two_lines([0.1, 0.1]), [0.05, 0.1, 0.15, 0.45, 0.48, 0.74]))
    assert [o.starts for o in found.optima] in ([3, 2, 1], [3, 1, 2])
    text = "3 of 6 starts reached the optimum of cost 0; the others ended in 2 more: cost "
    assert found.sentences[0].startswith(text)
    # 100 (2 - cos(4 pi 0.372) - cos(6 pi 0.372)) is half the sum of squares
    expected = 200.0 * (2.0 - np.cos(4 * np.pi * 0.37201317) - np.cos(6 * np.pi * 0.37201317))
    assert [o.distance for o in found.optima[1:]] == pytest.approx([expected, expected], rel=1e-6)


def test_a_wrong_basin_that_attracts_more_starts_than_the_best_is_told():
    fit = searched(two_lines([0.1, 0.1]), [0.1, 0.45, 0.46, 0.48])
    assert any("attracted 3 starts, more than the best one with 1" in s for s in report_search(fit).sentences)
    # the best one was found: nothing of it for whoever asks whether to trust the numbers
    assert not any("attracted" in sentence for sentence in assess(fit).sentences)


def test_a_rival_within_the_noise_makes_the_result_not_unique():
    """The 3 Hz line is known to 1.5 only: half a second later the model fits nearly as well."""
    found = report_search(searched(two_lines([0.05, 1.5]), [0.1, 0.12, 0.6]))
    rival = found.rivals[0]
    assert rival.values[0] == pytest.approx(0.6, abs=1e-3)
    # at 0.6 s only the 3 Hz line is opposite: 4 / 1.5^2
    assert rival.distance == pytest.approx(4.0 / 1.5**2, rel=1e-2)
    assert any("not unique" in s and "t = 0.6 s instead of 0.1 s" in s for s in found.sentences)
    assert report_search(searched(two_lines([0.05, 0.5]), [0.1, 0.12, 0.6])).rivals == ()


def test_without_weights_a_rival_is_judged_by_the_ratio_of_the_costs():
    """4 data: a cost 1.5 times as large is ``4 ln 1.5 = 1.6`` of deviance, three times as large 4.4."""
    response = two_lines([1.0, 1.0], wrong=2.0)
    fit = searched(response, [0.05, 0.45, 0.7], weighting=Unweighted())
    found = report_search(fit)
    gap = [o.distance for o in found.optima[1:]]
    curve = scan(fit, "t").minima
    expected = [4.0 * np.log(m.cost / curve[0].cost) for m in curve[1:3]]
    assert gap == pytest.approx(expected[: len(gap)], rel=1e-5)


def test_the_two_ends_of_a_valley_are_one_optimum():
    """Only ``v K_p`` and ``v K_i`` are in the data: every start ends elsewhere on one curve of equal cost."""
    v = Parameter("v", "-", 0.2, 5.0, 1.0, "test")
    k_p, k_i = structure("OL2").parameters
    own = Structure(name="own", title="", input="e", outputs={"M_s": PIGovernor(k_p, k_i) * Gain(v)})
    frequency = np.geomspace(0.05, 3.0, 9)
    truth = own.response(own.vector({"K_p": 2.0, "K_i": 3.0, "v": 1.0}), 2j * np.pi * frequency)
    std = 0.02 * np.abs(truth[0])
    rng = np.random.default_rng(2)
    noise = std * (rng.normal(size=9) + 1j * rng.normal(size=9))
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=(truth + noise)[:, None],
        covariance=std[:, None, None] ** 2 * np.eye(2),
        inputs=("e",),
        outputs=("M_s",),
    )
    found = report_search(identify(own, response, rng=np.random.default_rng(1)))
    assert len(found.optima) > 5
    assert all(o.connected for o in found.optima)
    assert found.rivals == ()
    valley = "All 50 starts reached the same optimum, which is a valley: see what the data cannot tell apart."
    assert found.sentences[0] == valley


def delayed_loop():
    """OL1 and OL3 in one loop: PI governor, delay, shaft; no lag."""
    fields = {"tau_n": (0.0, 5.0), "K_p": (0.0, 10.0), "K_i": (0.0, 10.0), "t_d": (0.0, 0.5)}
    tau, p, i, t = (Parameter(n, "-", *bounds, sum(bounds) / 2.0, "test") for n, bounds in fields.items())
    slope = Parameter("k_q", "-", 1.0, 3.0, 2.0, "test", held=True)
    engine = PIGovernor(p, i) * Delay(t)
    core = Shaft((tau,), slope)
    torque = engine * Sensitivity(engine * core)
    return Structure(name="OL1+OL3", title="", input="n_set", outputs={"n": core * torque, "M_s": torque})


UNSTABLE = {"tau_n": 0.3897, "K_p": 3.4363, "K_i": 4.2639, "t_d": 0.4022}


def test_an_unstable_optimum_of_lower_cost_that_was_passed_over_is_told(make_response):
    own = delayed_loop()
    fit = identify(own, make_response(own, UNSTABLE, noise=0.05), rng=np.random.default_rng(3))
    found = report_search(fit)
    assert found.passed_over
    assert all(o.stable is False and o.cost < fit.cost for o in found.passed_over)
    assert any("unstable" in s and "passed over" in s for s in found.sentences)
    assert not any("not unique" in s for s in found.sentences)


def test_an_optimum_at_a_bound_is_told(make_response):
    fit = identify(structure("OL2"), make_response("OL2", {"K_p": -0.3, "K_i": 4.0}), rng=np.random.default_rng(1))
    found = report_search(fit)
    assert found.optima[0].at_bound == ("K_p",)
    assert any(s.startswith("K_p stopped at its bound 0") for s in found.sentences)


def test_starts_that_had_not_arrived_are_led_to_their_optimum():
    """Two iterations are few: what looks like several optima is one."""
    response = two_lines([0.1, 0.1])
    fit = searched(response, [0.02, 0.1, 0.17], max_iterations=60)
    early = replace(fit, clusters=(*fit.clusters, Cluster(values=np.array([0.15]), cost=60.0, starts=4, stable=None)))
    found = report_search(early)
    assert len(found.optima) == 1
    assert found.optima[0].starts == 7


def test_a_start_that_was_stopped_too_early_to_win_is_told():
    fit = searched(two_lines([0.1, 0.1]), [0.45, 0.46])
    early = replace(fit, clusters=(*fit.clusters, Cluster(values=np.array([0.15]), cost=900.0, starts=1, stable=None)))
    found = report_search(early)
    assert found.optima[1].cost == pytest.approx(0.0, abs=1e-20)
    assert any("leads to a lower cost" in s and "more iterations" in s for s in found.sentences)


def test_many_optima_are_listed_in_short():
    fit = searched(two_lines([0.1, 0.1]), np.linspace(0.01, 4.9, 60), late(5.0))
    text = report_search(fit).sentences[0]
    assert text.count("starts)") + text.count("start)") == 4
    assert "more" in text
