"""Starts of an elastic line at the optima of the rigid one."""

from types import SimpleNamespace

import numpy as np

from shaftprint.catalogue import structure
from shaftprint.identify import Settings
from shaftprint.survey._elastic_starts import with_elastic_starts


def _rigid(**values):
    """Return what is looked at of a fit of the rigid line: one optimum, and lines up to 5 Hz."""
    closed = structure("GAUGE-CLOSED")
    objective = SimpleNamespace(names=closed.names, experiments=[SimpleNamespace(s=2j * np.pi * np.array([0.1, 5.0]))])
    return SimpleNamespace(objective=objective, clusters=[SimpleNamespace(values=closed.vector(values))])


def _starts(rigid):
    elastic = structure("GAUGE-ELASTIC")
    found = with_elastic_starts(Settings(), elastic, rigid).draw.values
    return dict(zip([p.name for p in elastic.free], found.T, strict=True))


def test_modes_of_two_bodies_on_their_coupling():
    starts = _starts(_rigid(tau_up=1.0, tau_dn=0.25))
    # omega^2 = k (1 / J_1 + 1 / J_2), here k (1 + 4)
    modes_hz = np.sqrt(5.0 * starts["k_c"]) / (2.0 * np.pi)
    assert np.allclose([modes_hz[0], modes_hz[-1]], [1.0, 7.5])


def test_a_body_that_vanished_at_the_optimum_has_a_hundredth_of_the_line():
    starts = _starts(_rigid(tau_up=0.0, tau_dn=0.5))
    assert np.all(np.isfinite(starts["k_c"]))
    assert np.all(starts["k_c"] > 0.0)
    # bodies of 0.005 and 0.5 s: k (200 + 2)
    assert np.isclose(np.sqrt(202.0 * starts["k_c"][0]) / (2.0 * np.pi), 1.0)
    assert np.all(np.isfinite(_starts(_rigid(tau_up=0.0, tau_dn=0.0))["k_c"]))
