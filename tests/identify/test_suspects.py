"""What a failing fit may miss: each cause built into the data is the first suspect, with its size."""

from dataclasses import replace

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Prior, Settings, assess, identify, identify_jointly
from shaftprint.identify.judgement._suspects import suspects_of
from shaftprint.models import Delay, Gain, Parameter, Structure
from shaftprint.spectra import FrequencyResponse

GAUGE = {
    "tau_dn": 0.32, "tau_up": 1.016, "k_q": 2.0, "g": 0.0, "K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "omega_n": 10.3,
    "zeta": 0.47, "t_sp": 0.05, "c_set": 1.0, "t_gauge": 0.0,
}  # fmt: skip
PRIORS = {"g": Prior(0.0, 0.1), "tau_up": Prior(1.016, 0.03), "t_gauge": Prior(0.0, 0.002)}


def changed(response, change):
    """The response with each output multiplied by a function of ``s``."""
    s = 2j * np.pi * response.frequency_hz
    factor = np.stack([np.broadcast_to(change.get(output, lambda s: 1.0)(s), s.shape) for output in response.outputs])
    return replace(response, response=response.response * factor[:, None])


def cl4(response, **settings):
    return identify(structure("CL4"), response, rng=np.random.default_rng(1), settings=Settings(starts=15, **settings))


@pytest.fixture
def data(make_response):
    return make_response("CL4", noise=0.005, correlation=0.2, rng=np.random.default_rng(7))


def test_a_good_fit_has_no_suspects(data):
    assert suspects_of(cl4(data)) == ()


@pytest.mark.parametrize(
    ("change", "words", "size"),
    [
        ({"n": lambda s: np.exp(-0.03 * s)}, "the speed pick-up comes late", 0.03),
        ({"M_s": lambda s: np.exp(-0.02 * s)}, "the torque gauge comes late", 0.02),
        ({"M_s": lambda s: 1.04}, "k_q (slope of the propeller torque, d ln M / d ln n) is not 2", 0.08),
        ({"n": lambda s: 1.02, "M_s": lambda s: 1.02}, "the set point has a wrong scale", 0.02),
    ],
    ids=["pick-up", "telemetry", "gauge", "set point"],
)
def test_what_was_built_in_is_the_first_suspect_with_its_size(data, change, words, size):
    found = suspects_of(cl4(changed(data, change)))
    assert found[0].words == words
    assert found[0].estimate == pytest.approx(size, rel=0.25)
    assert found[0].share > 0.5


def test_a_cause_that_is_not_of_first_order_has_no_size(data):
    """A pick-up that is 0.1 s late turns the fastest line by two radians."""
    found = suspects_of(cl4(changed(data, {"n": lambda s: np.exp(-0.1 * s)})))
    assert found[0].words == "the speed pick-up comes late"
    assert found[0].rough
    assert found[0].sentence.endswith("% of the misfit would disappear if the speed pick-up comes late.")


def test_a_late_set_point_is_the_first_suspect(data):
    """0.1 s of it: the delay inside the loop takes a part, so that the size is too small."""
    late = changed(data, {"n": lambda s: np.exp(-0.1 * s), "M_s": lambda s: np.exp(-0.1 * s)})
    found = suspects_of(cl4(late))
    assert found[0].words == "the set point comes late"
    assert 0.03 < found[0].estimate < 0.1


def test_a_parameter_that_is_held_too_low_is_the_first_suspect(make_response):
    """``k_q`` is 2.2, CL4 holds it at 2: of what looks alike the structure's own parameter is named."""
    truth = structure("CL4").free_between(k_q=(1.0, 3.0))
    values = {"tau_n": 0.329, "K_p": 1.6, "K_i": 4.44, "t_d": 0.116, "omega_n": 9.77, "zeta": 0.5, "k_q": 2.2}
    response = make_response(truth, values, noise=0.005, rng=np.random.default_rng(7))
    found = suspects_of(cl4(response))
    assert found[0].words == "k_q (slope of the propeller torque, d ln M / d ln n) is not 2"
    assert found[0].estimate == pytest.approx(0.2, rel=0.2)


def test_dynamic_inflow_is_the_first_suspect_of_the_plain_gauge_structure(make_response):
    inflow = structure("GAUGE-INFLOW")
    values = {**GAUGE, "kappa": 1.0, "tau_i": 0.12}
    response = make_response(inflow, values, noise=0.005, rng=np.random.default_rng(7), frequency_hz=BETTER, names=())
    settings = Settings(starts=20, priors=PRIORS)
    plain = identify(structure("GAUGE-CLOSED"), response, rng=np.random.default_rng(1), settings=settings)
    assert plain.p_value < 0.01
    assert suspects_of(plain)[0].words == "there is dynamic inflow: the slipstream follows the propeller late"
    right = identify(inflow, response, rng=np.random.default_rng(1), settings=settings)
    assert suspects_of(right) == ()


BETTER = np.geomspace(0.0044, 3.4, 24)


INFLOW = "there is dynamic inflow: the slipstream follows the propeller late"


@pytest.mark.parametrize(
    ("name", "values", "extra", "words"),
    [
        # (tau_dn s + 2) / ((tau_up + tau_dn) s + 2) on governor and engine
        ("OL2", {"K_p": 2.0, "K_i": 4.0}, lambda s: (0.3 * s + 2.0) / (0.4 * s + 2.0), "inertia between engine and"),
        ("OL1", {"tau_n": 0.3}, lambda s: (0.3 * s + 2) / (0.3 * s + 2 + 0.3 * 0.12 * s / (0.12 * s + 1)), INFLOW),
    ],
    ids=["upstream", "inflow"],
)
def test_what_an_open_loop_lacks_is_the_first_suspect(make_response, name, values, extra, words):
    own = structure(name)
    output = next(iter(own.outputs))
    exact = make_response(own, values, noise=0.002, rng=np.random.default_rng(7), frequency_hz=BETTER, names=())
    data = changed(exact, {output: extra})
    found = suspects_of(identify(own, data, rng=np.random.default_rng(1)))
    assert words in " ".join(s.words for s in found)
    assert found[0].share > 0.5


def test_a_missing_lag_is_the_first_suspect_of_a_loop_without_one(make_response):
    truth = structure("CL4").free_between(omega_n=(7.0, 500.0))
    values = {"tau_n": 0.3, "K_p": 4.0, "K_i": 4.0, "t_d": 0.05, "omega_n": 500.0, "zeta": 1.0}
    response = make_response(truth, values, noise=0.002, rng=np.random.default_rng(7), frequency_hz=BETTER, names=())
    found = suspects_of(identify(structure("CL1"), response, rng=np.random.default_rng(1)))
    assert found[0].words == "there is more delay or lag in the loop"
    # without the torque a late pick-up looks the same
    alone = suspects_of(identify(structure("CL1").of_outputs("n"), response, rng=np.random.default_rng(1)))
    assert alone[0].words == "the speed pick-up comes late"


def test_a_pick_up_whose_delay_is_held_is_the_suspect_of_a_structure_that_knows_it(make_response):
    """With the rack logged too, where a delay of the pick-up cannot hide."""
    ecu = structure("GAUGE-ECU")
    values = {**GAUGE, "v": 1.0, "t_rack": 0.0, "t_pickup": 0.03}
    response = make_response(ecu, values, noise=0.005, rng=np.random.default_rng(7), frequency_hz=BETTER, names=())
    fit = identify(ecu, response, rng=np.random.default_rng(1), settings=Settings(starts=20, priors=PRIORS))
    found = suspects_of(fit)
    assert found[0].words == "t_pickup (delay of the pick-up's value) is not 0 s"
    assert found[0].estimate == pytest.approx(0.03, rel=0.3)


def test_the_sensor_of_one_input_of_several_is_the_suspect():
    """Two inputs drive one output; the first input's values come late."""
    gains = [Parameter(f"k_{i}", "-", 0.1, 5.0, 1.0, "test") for i in (1, 2)]
    own = Structure(
        name="own", title="", inputs=("u", "w"), outputs={"y": {"u": Gain(gains[0]), "w": Gain(gains[1])},
                                                          "z": {"u": Gain(gains[0]), "w": Gain(gains[1])}}
    )  # fmt: skip
    frequency = np.array([0.1, 0.5, 1.0, 2.0])
    late = np.exp(-2j * np.pi * frequency * 0.01)
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=np.array([[2.0 * late, 3.0 * np.ones(4)], [2.0 * late, 3.0 * np.ones(4)]]),
        covariance=np.tile(1e-4 * np.eye(8), (4, 1, 1)),
        inputs=("u", "w"),
        outputs=("y", "z"),
    )
    found = suspects_of(identify(own, response, rng=np.random.default_rng(1)))
    assert found[0].words == "u comes late"
    assert found[0].estimate == pytest.approx(0.01, rel=0.01)


def test_a_sensor_that_would_have_to_be_early_is_no_suspect():
    gain = Parameter("k", "-", 0.1, 5.0, 1.0, "test")
    own = Structure(name="own", title="", input="u", outputs={"y": Gain(gain)})
    frequency = np.array([0.1, 0.5, 1.0, 2.0])
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=(2.0 * np.exp(2j * np.pi * frequency * 0.01))[None, None],
        covariance=np.tile(1e-4 * np.eye(2), (4, 1, 1)),
        inputs=("u",),
        outputs=("y",),
    )
    assert not any("late" in s.words for s in suspects_of(identify(own, response, rng=np.random.default_rng(1))))


def test_other_drives_have_suspects_too():
    """A response of any names: a delay that the structure does not have."""
    gain = Parameter("k", "-", 0.1, 5.0, 1.0, "test")
    own = Structure(name="own", title="", input="u", outputs={"y": Gain(gain)})
    frequency = np.array([0.1, 0.5, 1.0, 2.0])
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=(2.0 * np.exp(-2j * np.pi * frequency * 0.01))[None, None],
        covariance=np.tile(1e-4 * np.eye(2), (4, 1, 1)),
        inputs=("u",),
        outputs=("y",),
    )
    found = suspects_of(identify(own, response, rng=np.random.default_rng(1)))
    deviation = 0.01 / 2.0 / np.linalg.norm(2 * np.pi * frequency)
    assert found[0].words == "y comes late"
    assert found[0].estimate == pytest.approx(0.01, rel=0.01)
    assert (found[0].unit, found[0].std) == ("s", pytest.approx(deviation, rel=0.01))
    time = Parameter("t", "s", 0.0, 1.0, 0.0, "test")
    late = Structure(name="late", title="", input="u", outputs={"y": Gain(gain) * Delay(time)})
    assert suspects_of(identify(late, response, rng=np.random.default_rng(1))) == ()


def test_a_joint_fit_is_asked_as_a_whole(data):
    late = changed(data, {"n": lambda s: np.exp(-0.03 * s)})
    cl = structure("CL4")
    both = identify_jointly([(cl, late), (cl, late)], rng=np.random.default_rng(1), settings=Settings(starts=15))
    alone = suspects_of(cl4(late))[0]
    together = suspects_of(both)[0]
    assert together.words == alone.words
    assert together.estimate == pytest.approx(alone.estimate, rel=1e-3)
    assert together.std == pytest.approx(alone.std / np.sqrt(2.0), rel=1e-3)


def test_the_suspect_may_be_in_the_second_of_two_responses_with_fewer_lines():
    """As on a line whose speed and whose machine are moved in turn, at other lines."""
    parts = []
    for name, given, late_s, frequency in (("y", "u", 0.0, [0.1, 0.5, 1.0, 2.0]), ("z", "w", 0.01, [0.2, 0.8, 1.5])):
        gain = Parameter(f"k_{name}", "-", 0.1, 5.0, 1.0, "test")
        omega = 2.0 * np.pi * np.array(frequency)
        response = FrequencyResponse(
            frequency_hz=np.array(frequency),
            response=(2.0 * np.exp(-1j * omega * late_s))[None, None],
            covariance=np.tile(1e-4 * np.eye(2), (omega.size, 1, 1)),
            inputs=(given,),
            outputs=(name,),
        )
        parts.append((Structure(name=name, title="", input=given, outputs={name: Gain(gain)}), response))
    (found,) = suspects_of(identify_jointly(parts, rng=np.random.default_rng(1)))
    assert found.words == "z comes late"
    assert found.estimate == pytest.approx(0.01, rel=0.01)
    assert not found.rough


@pytest.mark.parametrize(
    ("scatter", "kinds"), [(0.0, ["prior", "misfit", "suspect"]), (0.3, ["misfit", "prior", "suspect"])]
)
def test_a_misfit_that_no_linear_cause_explains_comes_before_the_priors_that_it_pulls(scatter, kinds):
    """A gain of 1.1 where 1 is assumed; as a limit bends large lines, every second one is 0.3 too small."""
    gain = Parameter("k", "-", 0.1, 5.0, 1.0, "test")
    own = Structure(name="own", title="", input="u", outputs={"y": Gain(gain)})
    frequency = np.geomspace(0.1, 2.0, 12)
    response = FrequencyResponse(
        frequency_hz=frequency,
        response=(1.1 + 0.5 * scatter * (-1.0) ** np.arange(12) + 0j)[None, None],
        covariance=np.tile(1e-4 * np.eye(2), (12, 1, 1)),
        inputs=("u",),
        outputs=("y",),
    )
    settings = Settings(priors={"k": Prior(1.0, 0.01)})
    verdict = assess(identify(own, response, rng=np.random.default_rng(1), settings=settings))
    assert [reason.kind for reason in verdict.reasons] == kinds
    said = "such as a limit of torque or rack or of their rate, play or dry friction" in verdict.reasons[-1].sentence
    assert said == (scatter > 0.0)
