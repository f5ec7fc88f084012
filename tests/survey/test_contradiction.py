"""A joint fit that its own sines contradict: two lines of known truth, and the same one twice."""

import numpy as np
import pytest

from shaftprint.identify import Prior, Settings, identify, identify_jointly
from shaftprint.models import FirstOrderLag, Gain, Parameter, Structure
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey._everything import contradiction

S = 2j * np.pi * np.array([0.05, 0.1, 0.2, 0.5, 1.0])
LINE = Structure(
    name="LAG",
    title="gain and lag",
    input="u",
    outputs={
        "y": Gain(Parameter("k", "-", 0.1, 10.0, 2.0, "gain"))
        * FirstOrderLag(Parameter("tau", "s", 0.01, 10.0, 1.0, "time"))
    },
)
GAIN, TIME_S, STD = 2.0, 0.8, 0.02


def response_of_line(rng, *, gain=GAIN, time_s=TIME_S, std=STD):
    """Response with noise of a standard deviation in real and imaginary part."""
    noise = std * (rng.standard_normal(S.size) + 1j * rng.standard_normal(S.size))
    return FrequencyResponse(
        frequency_hz=S.imag / (2.0 * np.pi),
        response=(gain / (time_s * S + 1.0) + noise)[None, None, :],
        covariance=np.broadcast_to(std**2 * np.eye(2), (S.size, 2, 2)),
        inputs=("u",),
        outputs=("y",),
    )


def fits(seed, *, settings, **other):
    """Fit to the sines alone, and to sines and a better record."""
    rng = np.random.default_rng(seed)
    sines, record = response_of_line(rng), response_of_line(rng, std=0.3 * STD, **other)
    alone = identify(LINE, sines, rng=rng, settings=settings)
    return alone, identify_jointly([(LINE, sines), (LINE, record)], rng=rng, settings=settings)


FREE = Settings(starts=3)


@pytest.mark.slow
def test_one_line_hardly_ever_contradicts_itself():
    said = [bool(contradiction(*fits(seed, settings=FREE))) for seed in range(150)]
    # at most 1 % by the bound, of 150
    assert sum(said) <= 4


@pytest.mark.parametrize("other", [{"gain": 1.9}, {"time_s": 0.9}])
def test_two_lines_contradict_each_other(other):
    # the sines know the gain to 1 % and the time to 2 %: the lines are five to six deviations apart
    said = [contradiction(*fits(seed, settings=FREE, **other)) for seed in range(20)]
    assert sum(map(bool, said)) >= 18
    (moved,) = other
    symbol = {"gain": "k", "time_s": "tau"}[moved]
    assert f" {symbol} " in said[0]


def test_what_was_known_before_is_contradicted_too():
    known = Settings(starts=3, priors={"k": Prior(GAIN, 0.001)})
    assert not contradiction(*fits(1, settings=known))
    assert contradiction(*fits(1, settings=known, gain=GAIN * 1.05))
