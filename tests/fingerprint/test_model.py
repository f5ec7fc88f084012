"""The model of a fingerprint: the structure as it was then, with numbers that lie where they belong."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import Fingerprint
from shaftprint.fingerprint._model import identified_model
from shaftprint.identify import Estimate


@pytest.fixture
def fingerprint():
    # in another order than the structure, which begins with the governor's gain
    found = [
        Estimate(name=name, unit=unit, value=value, std=std)
        for name, unit, value, std in (("t_d", "s", 0.12, 0.02), ("K_p", "-", 4.6, 0.4))
    ]
    return Fingerprint.model_construct(
        structure="OL3", parameters=tuple(found), held={"K_i": 3.5}, covariance=((4e-4, 0.002), (0.002, 0.16))
    )


def test_values_and_covariance_lie_in_the_order_of_the_structure(fingerprint):
    model = identified_model(fingerprint, structure("OL3"))
    named = dict(zip(model.structure.names, model.values, strict=True))
    assert named == {"K_p": 4.6, "K_i": 3.5, "t_d": 0.12}
    free = [parameter.name for parameter in model.structure.free]
    assert sorted(free) == ["K_p", "t_d"]
    place = {name: number for number, name in enumerate(free)}
    assert model.covariance[place["K_p"], place["K_p"]] == 0.16
    assert model.covariance[place["t_d"], place["t_d"]] == 4e-4
    assert model.covariance[0, 1] == model.covariance[1, 0] == 0.002
    assert model.not_known == ()


def test_what_the_test_says_nothing_of_is_named(fingerprint):
    lost = fingerprint.model_copy(update={"covariance": ((np.inf, 0.0), (0.0, 0.16))})
    assert identified_model(lost, structure("OL3")).not_known == ("t_d",)


def test_a_parameter_that_a_structure_usually_holds_is_free_where_it_was_identified(fingerprint):
    held = structure("OL3").held_at(t_d=0.1)
    assert [p.name for p in identified_model(fingerprint, held).structure.free] == [
        p.name for p in identified_model(fingerprint, structure("OL3")).structure.free
    ]


def test_another_structure_is_refused(fingerprint):
    with pytest.raises(
        FingerprintError, match=r"expected the parameters of structure OL1, found a difference in .*K_i"
    ):
        identified_model(fingerprint, structure("OL1"))


def test_covariance_of_some_parameters(fingerprint):
    assert fingerprint.covariance_of(["K_p", "t_d"]).tolist() == [[0.16, 0.002], [0.002, 4e-4]]
    assert fingerprint.covariance_of(["K_p"]).tolist() == [[0.16]]
    assert fingerprint.covariance_of([]).shape == (0, 0)
    with pytest.raises(FingerprintError, match="has no parameter 'K_i'; it has t_d, K_p"):
        fingerprint.covariance_of(["K_i"])
