"""The flexible model beside a refused structure: a known line with an honest band, and no line where none is."""

from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.identify.comparison._black_box import black_box, black_boxes
from shaftprint.spectra import FrequencyResponse

HERTZ = np.geomspace(0.02, 10.0, 40)
DELAY_S = 0.08


def line(hertz):
    """Two outputs behind one delay: an oscillator at 8 rad/s with damping 0.3, and the same behind a slower one."""
    s = 2j * np.pi * hertz
    quick, slow = 64.0 / (s**2 + 4.8 * s + 64.0), 4.0 / (s**2 + 1.2 * s + 4.0)
    return np.exp(-DELAY_S * s) * np.array([quick * slow * (1.0 + 0.5 * s), quick * (s + 0.5) / (s + 2.0)])


def fitted_part(seed, *, louder=1.0, structure=None):
    """Return lines of that response with noise of 1 %, stated too small by a factor, and a structure beside them."""
    rng = np.random.default_rng(seed)
    exact = line(HERTZ)
    std = 0.01 * np.abs(exact) + 0.001
    noise = louder * std * (rng.standard_normal(exact.shape) + 1j * rng.standard_normal(exact.shape))
    both = np.concatenate([std, std]).T
    response = FrequencyResponse(
        frequency_hz=HERTZ,
        response=(exact + noise)[:, None, :],
        covariance=both[:, :, None] * np.eye(4) * both[:, None, :],
        inputs=("n_set",),
        outputs=("n", "M_s"),
    )
    left = exact + noise - (exact if structure is None else structure)
    return SimpleNamespace(
        response=response,
        fitted=np.ones(HERTZ.size, dtype=bool),
        structure=SimpleNamespace(name="LINE"),
        whitened=np.concatenate([left.real, left.imag]).T / both,
    )


@pytest.fixture(scope="module")
def sound():
    return [black_box("M1", fitted_part(seed)) for seed in range(3)]


def test_the_band_holds_the_true_line_as_often_as_it_says(sound):
    inside = []
    for found in sound:
        off = np.log(found.model / line(found.frequency_hz))
        inside.append(np.abs(off.real) < 1.96 * found.magnitude_std)
        inside.append(np.abs(off.imag) < 1.96 * found.phase_std)
    # three tests, each one draw of some ten independent numbers
    assert 0.85 < np.mean(inside) <= 1.0
    # six poles and a delay, and seven numerators of each output
    assert all((found.order, found.degrees_of_freedom) == (6, 160 - 21) for found in sound)


def test_one_line_is_explained_and_its_residuals_are_of_chance(sound):
    assert min(found.p_value for found in sound) > 0.01
    beyond = [abs(model) > bound for found in sound for _, _, _, model, bound in found.correlations()]
    # the fit itself makes neighbours differ in sign a little
    assert np.mean(beyond) < 0.3


def test_a_structure_that_lacks_a_mode_leaves_residuals_that_go_together():
    lacking = line(HERTZ)
    lacking[1] *= 1.0 + 0.5 * np.exp(-(np.log(HERTZ / 1.2) ** 2) / 0.1)
    found = black_box("M1", fitted_part(1, structure=lacking))
    told = {(what, lag): (structure, bound) for what, lag, structure, _, bound in found.correlations()}
    assert told["M_s", 1][0] > told["M_s", 1][1] > abs(told["n", 1][0])
    output, hertz, decibels, _ = found.furthest
    assert output == "M_s"
    assert 1.0 < hertz < 1.45
    # 20 log10(1.5), where the bump is highest
    assert decibels == pytest.approx(3.4, abs=0.3)
    assert found.record["p_value"] > 0.001


def test_what_no_line_explains_is_not_explained():
    assert black_box("M1", fitted_part(2, louder=2.0)).p_value < 1e-6


def test_too_few_lines_have_no_flexible_model():
    part = fitted_part(3)
    part.fitted, part.whitened = np.arange(HERTZ.size) < 4, part.whitened[:4]
    assert black_box("M1", part) is None


def test_each_of_several_responses_has_a_name_of_its_own():
    """Charts are told apart by it, of two legs as of two inputs."""
    parts = [fitted_part(seed) for seed in range(2)]
    for part in parts:
        part.name = "response of n, M_s"
    assert [one.name for one in black_boxes(SimpleNamespace(experiments=parts), ["sines", "M1"])] == ["sines", "M1"]
    assert len({one.name for one in black_boxes(SimpleNamespace(experiments=parts), [])}) == 2
    (alone,) = black_boxes(SimpleNamespace(experiments=parts[:1]), [])
    assert alone.name == "response of n, M_s"
