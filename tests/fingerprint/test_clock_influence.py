"""What the uncertainty of a logger's clock does, against a hand calculation and against fits of a moved response."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from shaftprint.clocks import Alignment, ClockMap, LoggerClock
from shaftprint.fingerprint._clock_influence import clock_findings, clock_influences
from shaftprint.identify import identify
from shaftprint.spectra import FrequencyResponse

CHANNELS = {"n_set": "U", "n": "PTM_e", "M_s": "M_s"}
SIGNALS = SimpleNamespace(
    channels={"n_e" if name == "n" else name: SimpleNamespace(channel=channel) for name, channel in CHANNELS.items()}
)


def clock(channels, std_s):
    line = ClockMap(offset_s=0.4, drift=0.0, middle_s=0.0, covariance=np.diag([std_s**2, 0.0]))
    return LoggerClock(
        logger="shaft.nc",
        sha256="ab" * 32,
        reference="bridge.nc",
        reference_sha256="cd" * 32,
        channels=channels,
        alignment=Alignment(map=line, span_s=(0.0, 100.0)),
    )


def two_lines(used=(True, True)):
    """1 and 2 rad/s, |n| = 3 and |M_s| = 4 with standard deviations 0.3 and 0.8 of each part."""
    response = np.array([[3.0, 3.0j], [-4.0, 4.0]])[:, None, :]
    covariance = np.broadcast_to(np.diag([0.09, 0.64, 0.09, 0.64]), (2, 4, 4))
    return FrequencyResponse(
        frequency_hz=np.array([1.0, 2.0]) / (2.0 * np.pi),
        response=response,
        covariance=covariance,
        inputs=("n_set",),
        outputs=("n", "M_s"),
        used=np.array(used),
    )


@pytest.mark.parametrize(
    ("channels", "moved", "information"),
    [
        # omega |H| / std, squared and summed: 10^2 (1 + 4) of n, 5^2 (1 + 4) of M_s
        (("M_s",), ("M_s",), 125.0),
        (("PTM_e", "PTM_1"), ("n",), 500.0),
        (("M_s", "PTM_e"), ("n", "M_s"), 625.0),
        (("U",), ("n", "M_s"), 625.0),
        (("U", "M_s"), ("n",), 500.0),
    ],
)
def test_two_lines_by_hand(channels, moved, information):
    spectra = SimpleNamespace(response=two_lines(), speed="n_e")
    (found,) = clock_influences([clock(channels, 0.01)], spectra=spectra, signals=SIGNALS)
    assert found.moved == moved
    assert found.delay_std_s == pytest.approx(information**-0.5)
    assert found.shift == pytest.approx(0.01 * information**0.5)
    assert (found.line, found.phase_rad) == ("line 2", pytest.approx(0.02))


def test_lines_that_are_not_used_tell_nothing():
    spectra = SimpleNamespace(response=two_lines((True, False)), speed="n_e")
    (found,) = clock_influences([clock(("M_s",), 0.01)], spectra=spectra, signals=SIGNALS)
    assert (found.line, found.delay_std_s) == ("line 1", pytest.approx(0.2))


def test_a_test_without_a_line_to_use_is_said_nothing_of():
    spectra = SimpleNamespace(response=two_lines((False, False)), speed="n_e")
    assert clock_influences([clock(("M_s",), 0.01)], spectra=spectra, signals=SIGNALS) == ()


@pytest.mark.parametrize("channels", [("U", "PTM_e", "M_s"), ("PTM_1",)])
def test_a_clock_that_moves_nothing_against_the_set_point(channels):
    spectra = SimpleNamespace(response=two_lines(), speed="n_e")
    (found,) = clock_influences([clock(channels, 10.0)], spectra=spectra, signals=SIGNALS)
    assert (found.moved, found.shift, found.phase_rad) == ((), 0.0, 0.0)
    assert clock_findings([found]) == ()


def test_a_bad_clock_is_remarked():
    spectra = SimpleNamespace(response=two_lines(), speed="n_e")
    good, bad = clock_influences([clock(("M_s",), 1e-4), clock(("M_s",), 0.2)], spectra=spectra, signals=SIGNALS)
    (sentence,) = clock_findings([good, bad])
    assert "shaft.nc is known to 200 ms only" in sentence
    assert "up to 2.2 of their standard deviations" in sentence


def test_no_parameter_of_a_fit_moves_further(gauge_fit):
    """The torque 50 us late: every parameter, fitted anew, stays within the bound, and one comes near."""
    late_s, response = 5e-5, gauge_fit.response
    turn = np.stack([np.ones(response.frequency_hz.size), np.exp(-1j * response.omega_rad_s * late_s)])
    moved = replace(response, response=response.response * turn[:, None, :])
    again = identify(gauge_fit.structure, moved, rng=np.random.default_rng(7), settings=gauge_fit.settings)
    spectra = SimpleNamespace(response=response, speed="n_e")
    (found,) = clock_influences([clock(("M_s",), late_s)], spectra=spectra, signals=SIGNALS)
    moves = [abs(b.value - a.value) / a.std for a, b in zip(gauge_fit.parameters, again.parameters, strict=True)]
    assert max(moves) < found.shift
    assert max(moves) > 0.3 * found.shift
