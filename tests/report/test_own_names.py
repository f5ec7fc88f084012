"""Figures of drives that are no ships: outputs of any name, and several inputs."""

import re

import numpy as np
import pytest
from tests.report.marks import marks, names

from shaftprint.identify import Settings, identify
from shaftprint.models import Gain, Parameter, RationalBlock, Structure
from shaftprint.report import Curve, bode_chart, correlation_chart, residual_chart, sensitivity_chart
from shaftprint.report.charts._marks import Line, Points
from shaftprint.report.charts._text import as_plain
from shaftprint.report.sections._sections import picture_name
from shaftprint.spectra import FrequencyResponse

FREQUENCY_HZ = np.geomspace(0.5, 20.0, 9)


def pair():
    """Two masses on a coupling: x = K^-1 F with K = [[2 + m s^2 + s, -1], [-1, 2 + m s^2 + s]]."""
    mass = Parameter("m_1", "kg", 1e-4, 1.0, 0.01, "mass")
    factor = Parameter("gain of sensor", "-", 0.5, 2.0, 1.0, "gain")
    own = RationalBlock(lambda m: ([m, 1.0, 2.0], _square(m)), (mass,))
    crossed = RationalBlock(lambda m: ([1.0], _square(m)), (mass,))
    return Structure(
        name="PAIR",
        title="two masses",
        inputs=("force_1", "force_2"),
        outputs={
            "position": {"force_1": own * Gain(factor), "force_2": crossed},
            "angle": {"force_1": crossed, "force_2": own},
        },
    )


def _square(m):
    return [m * m, 2.0 * m, 4.0 * m + 1.0, 4.0, 3.0]


@pytest.fixture(scope="module")
def measured():
    model = pair()
    true = model.response([0.01, 1.0], 2j * np.pi * FREQUENCY_HZ)
    rng = np.random.default_rng(2)
    noise = rng.standard_normal((2, *true.shape))
    return FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=(true + 0.01 * (noise[0] + 1j * noise[1])).reshape(2, 2, -1),
        covariance=np.broadcast_to(1e-4 * np.eye(8), (9, 8, 8)),
        inputs=("force_1", "force_2"),
        outputs=("position", "angle"),
    )


@pytest.fixture(scope="module")
def found(measured):
    return identify(pair(), measured, rng=np.random.default_rng(1), settings=Settings(starts=5))


def test_every_channel_has_its_column_with_its_own_data_and_model(found, measured):
    panels = bode_chart([Curve.of(found)], data=measured).panels[:4]
    assert [as_plain(panel.title) for panel in panels] == [
        "position / force_1",
        "position / force_2",
        "angle / force_1",
        "angle / force_2",
    ]
    for panel, (output, cause) in zip(panels, ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True):
        points, (line,) = marks(panel, "data", Points), marks(panel, "PAIR", Line)
        size = np.abs(measured.response[output, cause])
        # those that may be noise alone are drawn for themselves
        drawn = np.concatenate([one.y for one in points])[np.argsort(np.concatenate([one.x for one in points]))]
        np.testing.assert_allclose(drawn, 20.0 * np.log10(size), rtol=1e-12)
        s = 1j * line.x
        m, gain = found.values
        stiffness = m * s**2 + s + 2.0
        expected = (stiffness if output == cause else 1.0) / (stiffness**2 - 1.0)
        expected = expected * gain if (output, cause) == (0, 0) else expected
        np.testing.assert_allclose(line.y, 20.0 * np.log10(np.abs(expected)), atol=1e-9)


def test_error_bars_are_those_of_the_channel(measured):
    # small enough that no point may be noise alone, which would have no bar
    covariance = 1e-4 * measured.covariance
    covariance[:, 3, 3] = covariance[:, 7, 7] = 4e-8
    other = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=measured.response,
        covariance=covariance,
        inputs=measured.inputs,
        outputs=measured.outputs,
    )
    shown = [marks(panel, "data", Points)[0] for panel in bode_chart(data=other).panels[:4]]
    # 1.96 standard deviations outwards along the response: 0.0001, and 0.0002 of the last channel
    for place, std in enumerate((0.0001, 0.0001, 0.0001, 0.0002)):
        size = np.abs(measured.response.reshape(4, -1)[place])
        upper = shown[place].y + shown[place].bars[1]
        np.testing.assert_allclose(upper, 20.0 * np.log10(size + 1.959964 * std), atol=1e-6)


def test_residuals_are_of_every_channel_and_named_after_it(found, measured):
    top, bottom = residual_chart(found).panels
    assert names(top)[1:3] == ["real part of position from force_1", "real part of position from force_2"]
    assert names(top)[8] == "imaginary part of angle from force_2"
    model = found.structure.response(found.values, 2j * np.pi * FREQUENCY_HZ)
    expected = (measured.response[1, 0] - model[2]).imag / 0.01
    np.testing.assert_allclose(top.marks[7].y, expected, rtol=1e-9)
    # eight independent numbers a line
    total = np.concatenate(
        [(measured.response.reshape(4, -1) - model).real, (measured.response.reshape(4, -1) - model).imag]
    )
    np.testing.assert_allclose(bottom.marks[0].y, (total**2).sum(axis=0) / 1e-4, rtol=1e-9)


def test_sensitivity_of_one_channel(found):
    line = sensitivity_chart(pair(), output="angle", cause="force_2", vary=["m_1"]).panels[0].marks[0]
    s = 1j * line.x
    stiffness = 1e-4 * s**2 + s + 2.0
    np.testing.assert_allclose(line.y, 20.0 * np.log10(np.abs(stiffness / (stiffness**2 - 1.0))), atol=1e-9)


def test_a_name_of_words_is_written_as_it_is(found):
    assert "gain of sensor" in correlation_chart(found).panels[0].x.names


@pytest.mark.parametrize(("one", "other"), [("高速", "低速"), ("Fast!", "Fast?"), (f"{'a' * 300}b", f"{'a' * 300}c")])
def test_two_legs_of_any_names_have_a_picture_each(one, other):
    names = {picture_name("leg", name) for name in (one, other)}
    assert len(names) == 2
    assert all(re.fullmatch(r"leg_[a-z0-9-]{8,70}", name) for name in names)
    assert picture_name("leg", "M 1") == "leg_m-1"
