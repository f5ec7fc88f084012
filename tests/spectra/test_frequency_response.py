"""Parts of a response, and responses of which only a standard deviation or a coherence is known."""

import numpy as np
import pytest

from shaftprint.errors import ResponseError
from shaftprint.spectra import FrequencyResponse, circular_covariance, coherence_covariance


def two_by_two(**changes):
    """A response of two outputs to two inputs at three lines, whose covariance differs from element to element."""
    rows = np.arange(8)
    labelled = 0.01 * (np.add.outer(rows, rows) + np.multiply.outer(rows, rows)) + 10.0 * np.eye(8)
    given = {
        "frequency_hz": np.array([1.0, 2.0, 3.0]),
        "response": np.arange(12.0).reshape(2, 2, 3) + 1j,
        "covariance": labelled + np.arange(3)[:, np.newaxis, np.newaxis] * np.eye(8),
        "inputs": ("a", "b"),
        "outputs": ("y", "z"),
        "lines": ("S1", "S2", "S3"),
        "remarks": {"S1": "first", "S3": "third"},
        "used": np.array([False, True, True]),
        "load": np.array([1.0, 1.1, 1.2]),
        "hold_s": 0.25,
    }
    return FrequencyResponse(**(given | changes))


def test_the_covariance_of_some_outputs_is_that_of_their_elements_for_every_input():
    whole = two_by_two()
    # real parts of (y a, y b, z a, z b) are rows 0 to 3, imaginary parts 4 to 7
    found = whole.of_outputs("z")
    assert found.outputs == ("z",)
    assert found.response.tolist() == [whole.response[1].tolist()]
    kept = [2, 3, 6, 7]
    for line in range(3):
        assert found.covariance[line].tolist() == [[whole.covariance[line, i, j] for j in kept] for i in kept]
    assert (found.inputs, found.lines, found.hold_s) == (("a", "b"), whole.lines, 0.25)
    assert found.remarks == whole.remarks


def test_outputs_can_change_places_and_back():
    whole = two_by_two(degrees_of_freedom=np.array([6.0, 20.0, np.inf]))
    turned = whole.of_outputs("z", "y")
    assert turned.covariance[1, 0, 1] == whole.covariance[1, 2, 3]
    assert turned.covariance[1, 2, 7] == whole.covariance[1, 0, 5]
    back = turned.of_outputs("y", "z")
    assert back.covariance.tolist() == whole.covariance.tolist()
    assert back.response.tolist() == whole.response.tolist()


def test_the_covariance_of_one_output_of_two_stays_right_as_a_weight():
    # the inverse of a Wishart matrix of n = 10 complex samples is too large, by 10/8 for two outputs, by 10/9 for one
    rng = np.random.default_rng(1)
    drawn = np.sqrt(0.5) * (rng.standard_normal((4000, 2, 10)) + 1j * rng.standard_normal((4000, 2, 10)))
    error = np.sqrt(0.5) * (rng.standard_normal((4000, 2)) + 1j * rng.standard_normal((4000, 2)))
    spread = drawn @ drawn.conj().swapaxes(1, 2) / 10.0 * (10.0 / 8.0)
    real = 0.5 * np.block([[spread.real, -spread.imag], [spread.imag, spread.real]])
    response = FrequencyResponse(
        frequency_hz=np.arange(1.0, 4001.0),
        response=error.T[:, np.newaxis],
        covariance=real,
        inputs=("u",),
        outputs=("y", "z"),
        degrees_of_freedom=np.full(4000, 20.0),
    )
    for part, size in ((response, 4.0), (response.of_outputs("z"), 2.0)):
        r = np.concatenate([part.response[:, 0].real, part.response[:, 0].imag]).T
        distance = np.einsum("li,lij,lj->l", r, np.linalg.inv(part.covariance), r)
        assert abs(distance.mean() - size) < 3.0 * distance.std() / np.sqrt(4000)
    assert response.of_outputs("z").covariance[0, 0, 0] == pytest.approx(real[0, 1, 1] * (10.0 / 9.0) / (10.0 / 8.0))


def test_lines_are_taken_with_all_that_belongs_to_them():
    whole = two_by_two(degrees_of_freedom=np.array([6.0, 20.0, np.inf]))
    for found in (whole.of_lines("S3", "S1"), two_by_two(degrees_of_freedom=[6.0, 20.0, np.inf]).of_lines("S1", "S3")):
        assert found.lines == ("S1", "S3")
        assert found.frequency_hz.tolist() == [1.0, 3.0]
        assert found.response.tolist() == whole.response[:, :, [0, 2]].tolist()
        assert found.covariance.tolist() == whole.covariance[[0, 2]].tolist()
        assert found.degrees_of_freedom.tolist() == [6.0, np.inf]
        assert found.used.tolist() == [False, True]
        assert found.load.tolist() == [1.0, 1.2]
        assert found.remarks == {"S1": "first", "S3": "third"}
    assert whole.between(2.0, 2.9).lines == ("S2",)
    assert whole.between(2.0, 2.9).remarks == {}
    assert whole.between(0.0, 2.0).lines == ("S1", "S2")


@pytest.mark.parametrize(
    ("part", "message"),
    [
        (lambda r: r.of_outputs("x"), "output 'x': the response has y, z"),
        (lambda r: r.of_outputs(), "output not given: the response has y, z"),
        (lambda r: r.of_outputs("y", "y"), "outputs: expected different names, found y, y"),
        (lambda r: r.of_lines("S4", "S1"), "line 'S4': the response has S1, S2, S3"),
        (lambda r: r.between(3.5, 9.0), "between 3.5 and 9 Hz: found no line; the response has lines from 1 to 3 Hz"),
    ],
)
def test_parts_that_are_not_there_are_told(part, message):
    with pytest.raises(ResponseError, match=message):
        part(two_by_two())


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"outputs": ("y", "y")}, "outputs: expected different names, found y, y"),
        ({"inputs": "voltage"}, r'inputs: expected a tuple of names such as \("voltage",\), found the text'),
        ({"inputs": ()}, "inputs: expected at least one name, found none"),
        ({"lines": ("S1", "S1", "S2")}, "lines: expected different names, found S1, S1, S2"),
        ({"degrees_of_freedom": [1.0, 0.0, 3.0]}, "degrees_of_freedom: expected positive numbers"),
        ({"degrees_of_freedom": [1.0, np.nan, 3.0]}, "degrees_of_freedom: expected positive numbers"),
        ({"covariance": np.eye(4)}, r"covariance: expected shape \(3, 8, 8\), found \(4, 4\)"),
    ],
)
def test_mistakes_in_a_response_of_several_inputs_are_told(change, message):
    with pytest.raises(ResponseError, match=message):
        two_by_two(**change)


def test_few_fields_are_enough():
    # a spectrum analyser that gives the response and a standard deviation of 2 % of it
    values = np.array([2.0 + 0.0j, 1.0 - 1.0j])
    found = FrequencyResponse(
        frequency_hz=[1.0, 2.0],
        response=[[values]],
        covariance=circular_covariance(0.02 * np.abs([[values]])),
        inputs=["force"],
        outputs=["position"],
    )
    # the variance of 0.04^2 is shared by real and imaginary part
    assert found.covariance[0].tolist() == pytest.approx(np.diag([0.0008, 0.0008]))
    assert found.covariance[1] == pytest.approx(np.diag([0.0004, 0.0004]))
    assert (found.inputs, found.outputs) == (("force",), ("position",))


def test_standard_deviations_stand_in_the_order_of_outputs_and_inputs():
    std = np.array([[[1.0], [2.0]], [[3.0], [4.0]]])
    assert circular_covariance(std)[0].diagonal().tolist() == [0.5, 2.0, 4.5, 8.0, 0.5, 2.0, 4.5, 8.0]


@pytest.mark.parametrize("averages", [5, 40])
def test_the_covariance_from_a_coherence_is_right_as_a_weight(averages):
    # cross spectra of Gaussian input and noise, averaged: H = 2 - j, noise with the variance of the output's signal
    rng = np.random.default_rng(averages)
    lines = 6000
    u, v = rng.standard_normal((2, averages, lines)) + 1j * rng.standard_normal((2, averages, lines))
    y = (2.0 - 1.0j) * u + np.sqrt(5.0) * v
    cross, power_u, power_y = (y * u.conj()).mean(0), (abs(u) ** 2).mean(0), (abs(y) ** 2).mean(0)
    response, coherence = cross / power_u, abs(cross) ** 2 / (power_u * power_y)
    covariance = coherence_covariance(
        response[np.newaxis, np.newaxis], coherence[np.newaxis, np.newaxis], averages=averages
    )
    error = np.stack([(response - 2.0 + 1.0j).real, (response - 2.0 + 1.0j).imag], axis=1)
    distance = np.einsum("li,lij,lj->l", error, np.linalg.inv(covariance), error)
    assert abs(distance.mean() - 2.0) < 3.0 * distance.std() / np.sqrt(lines)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: circular_covariance([0.1, 0.2]), r"std: expected shape \(outputs, inputs, lines\), found \(2,\)"),
        (lambda: circular_covariance([[[0.1, 0.0]]]), "std: expected positive, finite"),
        (lambda: coherence_covariance([[[1j, 1.0]]], [[[0.5]]], averages=9), r"as of the response \(1, 1, 2\), found"),
        (
            lambda: coherence_covariance([[[1j], [1.0]]], [[[0.5], [0.5]]], averages=9),
            "for several inputs give standard",
        ),
        (lambda: coherence_covariance([[[1j]]], [[[1.0]]], averages=9), "coherence: expected values between 0 and 1"),
        (lambda: coherence_covariance([[[1j]]], [[[0.9]]], averages=2), "averages = 2: expected at least 3"),
    ],
)
def test_plain_covariances_refuse_what_they_cannot_use(make, message):
    with pytest.raises(ResponseError, match=message):
        make()
