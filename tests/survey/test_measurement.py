"""Which response of a recording a structure is fitted to, by the names of its input and outputs."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import StructureError
from shaftprint.models import Gain, Parameter, Structure
from shaftprint.spectra import FrequencyResponse
from shaftprint.survey._measurement import response_of, responses_of

S = 2j * np.pi * np.array([0.1, 0.4, 1.5])
# a governor 3 + 4 / s, an engine 0.9 / (0.1 s + 1) and a line 1 / (1.3 s + 2) with 0.3 s + 2 behind the gauge
RACK, ENGINE, SPEED, LOAD = 3.0 + 4.0 / S, 0.9 / (0.1 * S + 1.0), 1.0 / (1.3 * S + 2.0), 0.3 * S + 2.0
ERROR = 1.0 / (1.0 + RACK * ENGINE * SPEED)


def measured(outputs=("n", "M_s", "X")):
    all_of_them = {"n": 1.0 - ERROR, "M_s": (1.0 - ERROR) * LOAD, "X": RACK * ERROR}
    size = 2 * len(outputs)
    return FrequencyResponse(
        frequency_hz=S.imag / (2.0 * np.pi),
        response=np.stack([all_of_them[name] for name in outputs])[:, None, :],
        covariance=np.broadcast_to(1e-6 * np.eye(size), (3, size, size)),
        inputs=("n_set",),
        outputs=outputs,
    )


@pytest.mark.parametrize(
    ("name", "expected"),
    [
        ("GAUGE-CLOSED", [1.0 - ERROR, (1.0 - ERROR) * LOAD]),
        ("GAUGE-ECU", [1.0 - ERROR, (1.0 - ERROR) * LOAD, RACK * ERROR]),
        ("OL2", [RACK * ENGINE * SPEED * LOAD]),
        ("GAUGE-CORE", [1.0 / LOAD]),
        ("GOVERNOR", [1.0 - ERROR, (1.0 - ERROR) * LOAD, RACK * ERROR]),
        ("ENGINE", [ENGINE * SPEED, ENGINE * SPEED * LOAD]),
    ],
)
def test_every_shipped_structure_finds_its_response(name, expected):
    chosen = structure(name)
    found = response_of(chosen, responses_of(measured()))
    assert found.inputs == chosen.inputs[:1]
    rows = [found.outputs.index(output) for output in (found.outputs if name == "GOVERNOR" else chosen.outputs)]
    np.testing.assert_allclose(found.response[rows, 0], expected, rtol=1e-9)


@pytest.mark.parametrize("name", ["GAUGE-ECU", "GOVERNOR", "ENGINE", "INITIAL"])
def test_without_the_rack_logged_it_is_said_what_there_is(name):
    with pytest.raises(
        StructureError, match=r"recording does not give; it gives n_set to n, M_s; e to M_s; M_s to n\."
    ):
        response_of(structure(name), responses_of(measured(("n", "M_s"))))


def test_with_the_rack_there_is_more():
    own = Structure(name="MINE", title="m", input="X", outputs={"e": Gain(Parameter("k", "-", 0.0, 1.0, 0.5, "gain"))})
    there = "n_set to n, M_s, X; e to M_s; M_s to n; e to X; X to n, M_s"
    with pytest.raises(
        StructureError, match=f"MINE goes from X to e, which this recording does not give; it gives {there}"
    ):
        response_of(own, responses_of(measured()))


def test_a_structure_of_several_inputs_is_refused():
    gain = Gain(Parameter("k", "-", 0.0, 1.0, 0.5, "gain"))
    two = Structure(name="TWO", title="t", inputs=("n_set", "theta"), outputs={"n": {"n_set": gain, "theta": gain}})
    with pytest.raises(StructureError, match="TWO goes from n_set, theta to n, which this recording does not give"):
        response_of(two, responses_of(measured()))


def test_an_error_is_formed_with_the_latency_that_the_vessel_file_knows():
    """With 0.05 s before the governor its error is ``exp(-0.05 s) n_set - n``."""
    late = np.exp(-0.05 * S)
    seen = FrequencyResponse(
        frequency_hz=S.imag / (2.0 * np.pi),
        response=measured().response * late,
        covariance=measured().covariance,
        inputs=("n_set",),
        outputs=("n", "M_s", "X"),
    )
    gain = Gain(Parameter("k", "-", 0.0, 1.0, 0.5, "gain"))
    mine = Structure(name="MINE", title="m", input="e", outputs={"X": gain})
    found = responses_of(seen, set_point_latency_s=0.05)
    np.testing.assert_allclose(response_of(mine, found).response[0, 0], RACK, rtol=1e-9)
    plain = response_of(mine, responses_of(seen)).response[0, 0]
    assert np.abs(plain / RACK - 1.0).max() > 0.05
