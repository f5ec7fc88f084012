"""Figures of drives that are no ships: outputs of any name, and several inputs."""

import numpy as np
import pytest

from shaftprint.identify import Settings, identify
from shaftprint.models import Gain, Parameter, RationalBlock, Structure
from shaftprint.report import Curve, plot_bode, plot_correlation, plot_residuals, plot_sensitivity
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
    figure = plot_bode([Curve.of(found)], data=measured)
    titles = [axes.get_title(loc="left") for axes in figure.axes[:4]]
    assert titles == [
        "(a) position / $force_{\\mathrm{1}}$",
        "(b) position / $force_{\\mathrm{2}}$",
        "(c) angle / $force_{\\mathrm{1}}$",
        "(d) angle / $force_{\\mathrm{2}}$",
    ]
    for axes, (output, cause) in zip(figure.axes[:4], ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True):
        points = axes.containers[0].lines[0]
        size = np.abs(measured.response[output, cause])
        np.testing.assert_allclose(points.get_ydata(), 20.0 * np.log10(size), rtol=1e-12)
        line = next(line for line in axes.get_lines() if str(line.get_label()).startswith("PAIR"))
        s = 1j * line.get_xdata()
        m, gain = found.values
        stiffness = m * s**2 + s + 2.0
        expected = (stiffness if output == cause else 1.0) / (stiffness**2 - 1.0)
        expected = expected * gain if (output, cause) == (0, 0) else expected
        np.testing.assert_allclose(line.get_ydata(), 20.0 * np.log10(np.abs(expected)), atol=1e-9)


def test_error_bars_are_those_of_the_channel(measured):
    covariance = np.array(measured.covariance)
    covariance[:, 3, 3] = covariance[:, 7, 7] = 4e-4
    other = FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=measured.response,
        covariance=covariance,
        inputs=measured.inputs,
        outputs=measured.outputs,
    )
    axes = plot_bode(data=other).axes
    ends = [np.array(a.containers[0].lines[2][0].get_segments())[:, 1, 1] for a in axes[:4]]
    # 1.96 standard deviations outwards along the response: 0.01, and 0.02 of the last channel
    for place, std in enumerate((0.01, 0.01, 0.01, 0.02)):
        size = np.abs(measured.response.reshape(4, -1)[place])
        np.testing.assert_allclose(ends[place], 20.0 * np.log10(size + 1.959964 * std), atol=1e-6)


def test_residuals_are_of_every_channel_and_named_after_it(found, measured):
    figure = plot_residuals(found)
    labels = [str(line.get_label()) for line in figure.axes[0].get_lines()]
    assert labels[:2] == [
        "real part of position from $force_{\\mathrm{1}}$",
        "real part of position from $force_{\\mathrm{2}}$",
    ]
    assert labels[7] == "imaginary part of angle from $force_{\\mathrm{2}}$"
    model = found.structure.response(found.values, 2j * np.pi * FREQUENCY_HZ)
    expected = (measured.response[1, 0] - model[2]).imag / 0.01
    np.testing.assert_allclose(figure.axes[0].get_lines()[6].get_ydata(), expected, rtol=1e-9)
    # eight independent numbers a line
    total = np.concatenate(
        [(measured.response.reshape(4, -1) - model).real, (measured.response.reshape(4, -1) - model).imag]
    )
    points = figure.axes[1].get_lines()[0]
    np.testing.assert_allclose(points.get_ydata(), (total**2).sum(axis=0) / 1e-4, rtol=1e-9)


def test_sensitivity_of_one_channel(found):
    figure = plot_sensitivity(pair(), output="angle", cause="force_2", vary=["m_1"])
    assert "angle / $force_{\\mathrm{2}}$" in figure.get_suptitle()
    line = figure.axes[0].get_lines()[0]
    s = 1j * line.get_xdata()
    stiffness = 1e-4 * s**2 + s + 2.0
    np.testing.assert_allclose(line.get_ydata(), 20.0 * np.log10(np.abs(stiffness / (stiffness**2 - 1.0))), atol=1e-9)


def test_a_name_of_words_is_drawn_as_words(found):
    labels = [text.get_text() for text in plot_correlation(found).axes[0].get_xticklabels()]
    assert "gain of sensor" in labels
