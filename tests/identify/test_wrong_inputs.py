"""What a newcomer hands to a fit by mistake is said in a sentence."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import IdentificationError
from shaftprint.identify import Settings, identify, identify_jointly
from shaftprint.models import Gain, Integrator, Parameter, Structure
from shaftprint.spectra import FrequencyResponse

K = Parameter("K", "-", 0.1, 10.0, 1.0, "gain")


def alone(parameter=K, input="u", output="y"):
    return Structure(name="S", title="s", input=input, outputs={output: Gain(parameter) * Integrator()})


def data(inputs=("u",), outputs=("y",)):
    frequency_hz = np.array([0.1, 0.2, 0.4])
    return FrequencyResponse(
        frequency_hz=frequency_hz,
        response=np.tile(2.0 / (2j * np.pi * frequency_hz), (len(outputs), 1, 1)),
        covariance=np.broadcast_to(1e-4 * np.eye(2 * len(outputs)), (3, 2 * len(outputs), 2 * len(outputs))),
        inputs=inputs,
        outputs=outputs,
    )


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda rng: identify(data(), alone(), rng=rng),
            "fit: expected a Structure and a FrequencyResponse, found FrequencyResponse and Structure",
        ),
        (
            lambda rng: identify("CL4", data(), rng=rng),
            "found str and FrequencyResponse; catalogue.structure.. gives a shipp",
        ),
        (lambda rng: identify(alone(), data(), rng=1), r"rng: expected numpy\.random\.default_rng\(seed\), found 1"),
        (
            lambda rng: identify_jointly([alone(), data()], rng=rng),
            r"joint fit: expected pairs \(structure, response\), found Structure",
        ),
        (
            lambda rng: identify(alone(Parameter("K", "-", 0.0, np.inf, 1.0, "gain")), data(), rng=rng),
            r"parameter K of structure S: expected finite bounds of a free parameter, found 0\.0 to inf; starts",
        ),
        (
            lambda rng: identify(alone(), data(), rng=rng, settings=Settings(priors={"K": (1.0, 0.1)})),
            r"prior of K: expected Prior\(mean, std\), found \(1\.0, 0\.1\)",
        ),
        (
            lambda rng: identify(alone(input="v"), data(), rng=rng),
            r"structure S goes from v to y, the response from u to y: give both the same names\.",
        ),
        (
            lambda rng: identify(structure("OL2"), data(("n_set",), ("n", "M_s")), rng=rng),
            r"structure OL2 goes from e to M_s, the response from n_set to n, M_s: .* or convert .* open_loop\(\)\.",
        ),
    ],
)
def test_a_sentence(call, message):
    with pytest.raises(IdentificationError, match=message):
        call(np.random.default_rng(1))


def test_a_held_parameter_may_have_no_bounds():
    # K is 1, so the sensor makes up for the 2 of the data
    held = Parameter("K", "-", -np.inf, np.inf, 1.0, "gain", held=True)
    two = Structure(
        name="S",
        title="s",
        input="u",
        outputs={"y": Gain(held) * Gain(Parameter("k", "-", 0.0, 5.0, 1.0, "sensor")) * Integrator()},
    )
    assert identify(two, data(), rng=np.random.default_rng(1)).value("k") == pytest.approx(2.0)
