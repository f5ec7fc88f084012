"""The line with its limits in a fingerprint: what was written comes back, and what cannot be a model is refused."""

import json

import numpy as np
import pytest

from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint, write_fingerprint
from shaftprint.fingerprint._line_with_limits import LineWithLimits
from shaftprint.fingerprint._model import model_with_limits
from shaftprint.identify import Estimate
from shaftprint.limits import Kind
from shaftprint.limits._levels_beside import Levels
from shaftprint.survey._line_with_limits import line_with_limits

CURVE = ((-0.5, 0.6), (0.0, 1.0), (0.5, 1.1))


@pytest.fixture(scope="module")
def with_limits(fingerprint):
    levels = (
        Estimate(name="m_max", unit="-", value=2.8, std=0.05),
        Estimate(name="T_aw", unit="s", value=0.5, std=0.02),
    )
    size = len(fingerprint.parameters)
    covariance = np.zeros((size + 2, size + 2))
    covariance[:size, :size] = fingerprint.covariance
    covariance[size:, size:] = np.diag([0.05**2, 0.02**2])
    line = LineWithLimits(
        found_by="limits",
        limits=("torque",),
        curve=CURVE,
        numbers=(
            Estimate(
                limit="torque limit", name="M_max", unit="N m", value=1300.0, std=30.0,
                interval_95=(1240.0, float("inf")), interval_open=(False, True),
                meaning="highest torque", doubt="the data set no upper end",
            ),
        ),
        not_seen=("deadband: not seen, none wider than d_e_rpm = 2 rpm",),
        parameters=(*fingerprint.parameters, *levels),
        held=fingerprint.held | {"m_min": -0.6, "droop": 0.0},
        covariance=tuple(map(tuple, covariance.tolist())),
    )  # fmt: skip
    return fingerprint.model_copy(update={"with_limits": line})


def test_what_was_written_comes_back(with_limits, tmp_path):
    path = tmp_path / "fingerprint.json"
    write_fingerprint(with_limits, path)
    assert read_fingerprint(path) == with_limits


def test_the_model_has_every_value_in_the_order_of_its_structure(with_limits):
    line = with_limits.with_limits
    model = model_with_limits(line)
    named = dict(zip(model.structure.names, model.values, strict=True))
    assert (named["m_max"], named["T_aw"], named["m_min"]) == (2.8, 0.5, -0.6)
    for quantity in with_limits.parameters:
        assert named[quantity.name] == quantity.value
    std = dict(zip((p.name for p in model.structure.free), np.sqrt(np.diag(model.covariance)), strict=True))
    assert std["T_aw"] == pytest.approx(0.02)
    assert std["K_p"] == pytest.approx(with_limits.quantity("K_p").std)


@pytest.mark.parametrize(
    ("change", "words"),
    [
        (lambda line: line.update(limits=["torque", "wind"]), "with_limits.limits.1: Input should be 'torque'"),
        (lambda line: line.update(limits=["smoke"]), "limits: a smoke limit needs the torque limit"),
        (lambda line: line["held"].pop("droop"), "parameters: expected each of the model once, found a difference in"),
        (lambda line: line["held"].update(m_max=1.0), "parameters: expected each of the model once"),
        (lambda line: line["curve"].reverse(), "curve: expected two or more corners whose speeds ascend"),
        (lambda line: line["covariance"].pop(), "covariance: expected"),
        (lambda line: line["held"].update(m_min="NaN"), "with_limits.held.m_min: Input should be a finite number"),
    ],
)
def test_what_cannot_be_a_model_is_refused_in_a_sentence(with_limits, tmp_path, change, words):
    content = json.loads(with_limits.model_dump_json())
    change(content["with_limits"])
    path = tmp_path / "fingerprint.json"
    path.write_text(json.dumps(content), encoding="utf-8")
    with pytest.raises(FingerprintError) as error:
        read_fingerprint(path)
    assert words in str(error.value)


def test_levels_share_the_errors_of_the_governor_that_they_stand_beside(fingerprint, vessel, working_point):
    """Drawn errors: a level is off by what its own noise and the errors of the governor make of it."""
    slopes = np.array([[0.3, -2.0], [0.0, 4.0]])
    alone = np.array([[0.04, 0.01], [0.01, 0.09]]) * 1e-2
    levels = Levels(
        kinds=(Kind.TORQUE, Kind.MOTORING),
        values={"m_max": 2.8, "m_min": -0.6, "T_aw": 0.5},
        names=("m_max", "m_min", "T_aw"),
        covariance=np.block([[alone, np.zeros((2, 1))], [np.zeros((1, 2)), np.array([[np.inf]])]]),
        governor=("K_p", "t_d"),
        slopes=np.vstack([slopes, [[1.0, 1.0]]]),
    )
    line = line_with_limits(fingerprint, levels, vessel=vessel, working_point=working_point)
    assert line.limits == ("torque",)
    names = [quantity.name for quantity in line.parameters]
    joint = np.array(line.covariance)
    rng = np.random.default_rng(3)
    linear = [quantity.name for quantity in fingerprint.parameters]
    errors = rng.multivariate_normal(np.zeros(len(linear)), fingerprint.covariance_of(linear), size=200_000)
    governor = errors[:, [linear.index(name) for name in levels.governor]]
    of_levels = governor @ slopes.T + rng.multivariate_normal(np.zeros(2), alone, size=200_000)
    drawn = np.cov(np.column_stack([errors, of_levels]).T)
    places = [names.index(name) for name in (*linear, "m_max", "m_min")]
    std = np.sqrt(np.diag(drawn))
    np.testing.assert_allclose(
        joint[np.ix_(places, places)] / np.outer(std, std), drawn / np.outer(std, std), atol=0.02
    )
    # of what the data do not show nothing is said
    lost = names.index("T_aw")
    assert np.isinf(joint[lost, lost])
    assert not np.delete(joint[lost], lost).any()
