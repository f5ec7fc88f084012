"""The model of a saved fingerprint, held against recordings of the same ship and of others."""

from dataclasses import replace

import pytest

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import structure
from shaftprint.errors import FingerprintError
from shaftprint.fingerprint import read_fingerprint
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.survey._validate import fingerprint_model
from shaftprint.vessel import load_vessel


@pytest.fixture(scope="module")
def signals(demo):
    with read_recording(demo[0] / "recording.nc") as opened:
        return prepare_signals(opened, load_vessel("stan-tug-1205"), load_campaign("short"))


@pytest.fixture(scope="module")
def fingerprint(demo):
    return read_fingerprint(demo[0] / "fingerprint.json")


def test_the_model_of_a_fingerprint(fingerprint, signals):
    model = fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), signals)
    named = dict(zip(model.structure.names, model.values, strict=True))
    for quantity in fingerprint.parameters:
        assert named[quantity.name] == quantity.value
    stds = model.covariance.diagonal() ** 0.5
    assert stds == pytest.approx([fingerprint.quantity(p.name).std for p in model.structure.free])
    assert model.used == fingerprint.conditions.lines_used


def test_a_fingerprint_of_another_recording_has_seen_nothing_of_this_one(fingerprint, signals):
    other = replace(signals, recording_sha256="0" * 64)
    assert fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), other).used == ()


def test_a_fingerprint_of_another_structure(fingerprint, signals):
    with pytest.raises(FingerprintError, match=r"expected the parameters of structure CL4, found a difference in"):
        fingerprint_model(fingerprint, structure("CL4"), signals)


def test_a_fingerprint_of_another_working_point(fingerprint, signals):
    point = replace(signals.working_point, engine_speed_rev_s=1.1 * signals.working_point.engine_speed_rev_s)
    with pytest.raises(FingerprintError, match=r"expected a recording around its working point of 118\d\.\d rpm"):
        fingerprint_model(fingerprint, structure("GAUGE-CLOSED"), replace(signals, working_point=point))
