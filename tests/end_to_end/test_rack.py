"""The fuel rack from its message on the bus to governor and engine apart, through a raw recording."""

import numpy as np
import pytest
from tests.measured_outputs import measured
from tests.tug.linearised import linearised_response

from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_spectra
from shaftprint.spectra._open_loop import governor_and_engine
from shaftprint.tug import Noise, Tug, sail
from shaftprint.vessel import Vessel, load_vessel

QUIET = Noise().without(process=True, measurement=True, faults=True)


@pytest.fixture(scope="module")
def with_bus():
    return load_vessel("stan-tug-1205-ecu")


@pytest.fixture
def found(short_campaign, tmp_path):
    """Signals and spectra of the short campaign."""

    def find(vessel, tug, *, mode="shaftprint"):
        sail(vessel, short_campaign, tmp_path / "bus.nc", tug=tug, seed=3, overwrite=True)
        with read_recording(tmp_path / "bus.nc") as recording:
            signals = prepare_signals(recording, vessel, short_campaign, mode=mode)
        return signals, estimate_spectra(signals, short_campaign)

    return find


def fine(vessel, **changes):
    """The same ship with a bus that resolves a hundredth of a per cent."""
    content = vessel.model_dump()
    content["sensors"]["rack"] |= {"resolution_percent": 0.01} | changes
    return Vessel.model_validate(content)


@pytest.mark.slow
@pytest.mark.parametrize("sensor", [{}, {"cycle_s": 0.1, "latency_s": 0.043}, {"cycle_s": 0.02}])
def test_without_noise_the_rack_is_that_of_the_linear_line(found, with_bus, sensor):
    ship, tug = fine(with_bus, **sensor), Tug(noise=QUIET)
    signals, spectra = found(ship, tug)
    # 465.54 of 1172.44 N m
    assert signals.channels["X"].reference == pytest.approx(0.39707, abs=5e-5)
    response = spectra.response
    truth = linearised_response(tug, ship, response.frequency_hz, outputs=("n", "M_s", "X"))
    assert measured(response).all()
    assert np.abs(response.response / truth - 1.0).max() < 2e-3
    governor, _ = governor_and_engine(response, set_point_latency_s=tug.set_point_latency_s)
    s = 1j * governor.omega_rad_s
    ratio = governor.response[0, 0] / (5.7 + 4.27 / s)
    assert np.abs(ratio - 1.0).max() < 3e-3
    # the message is known to be late to a tenth of a millisecond: half a millisecond a cycle would show
    assert np.abs(np.angle(ratio[-2:]) / governor.omega_rad_s[-2:]).max() < 1e-4


@pytest.mark.slow
def test_latency_that_the_vessel_does_not_know_of_stays_in_the_rack(found, with_bus):
    ship, tug = fine(with_bus), Tug(noise=QUIET, rack_latency_s=0.018)
    _, spectra = found(ship, tug)
    governor, _ = governor_and_engine(spectra.response, set_point_latency_s=tug.set_point_latency_s)
    ratio = governor.response[0, 0] / (5.7 + 4.27 / (1j * governor.omega_rad_s))
    late_s = -np.angle(ratio[-3:]) / governor.omega_rad_s[-3:]
    assert late_s == pytest.approx(np.full(3, 0.008), abs=2e-4)


@pytest.mark.slow
def test_thesis_mode_leaves_all_of_the_latency_in(found, with_bus):
    ship, tug = fine(with_bus), Tug(noise=QUIET)
    signals, spectra = found(ship, tug, mode="thesis")
    with_latency, _ = found(ship, tug)
    assert signals.channels["X"].start_s - with_latency.channels["X"].start_s == pytest.approx(0.01)
    speed, torque, rack = spectra.response.response[:, 0]
    assert spectra.response.outputs == ("n", "M_s", "X")
    # the speed is late by about a revolution there: the engine shows the latency alone
    truth = linearised_response(tug, ship, spectra.response.frequency_hz, outputs=("M_s", "X"))[:, 0]
    late_s = np.angle(torque / rack / (truth[0] / truth[1]))[-2:] / spectra.response.omega_rad_s[-2:]
    # 5 ms of the gauge against 10 ms of the bus
    assert late_s == pytest.approx(np.full(2, 0.005), abs=2e-3)
    assert np.isfinite(speed).all()


@pytest.mark.slow
def test_governor_is_found_as_well_as_stated(found, with_bus):
    """All noise, steps of 1 %: the line from ``e`` to ``X`` holds whatever the load does."""
    tug = Tug()
    signals, spectra = found(with_bus, tug)
    governor, engine = governor_and_engine(spectra.response, set_point_latency_s=tug.set_point_latency_s)
    s = 1j * governor.omega_rad_s
    # normalised with what was measured, not with the truth
    scale = 0.39707 / signals.channels["X"].reference * signals.working_point.engine_speed_rev_s / 19.73
    error = governor.response[0, 0] - scale * (5.7 + 4.27 / s)
    parts = np.stack([error.real, error.imag], axis=1)
    weighed = np.einsum("li,lij,lj->l", parts, np.linalg.inv(governor.covariance), parts)
    assert weighed.max() < 16.0
    assert 0.2 < weighed.mean() / 2.0 < 1.8
    # where the loop crosses over the gain is known to better than a percent
    crossing = governor.omega_rad_s > 3.0
    std = np.sqrt(0.5 * np.trace(governor.covariance, axis1=1, axis2=2))
    assert (std[crossing] < 0.01 * np.abs(governor.response[0, 0, crossing])).all()
    assert engine.used.all()
    ratios = spectra.signal_to_noise
    assert ratios.channels[-1] == "X"
    assert (ratios.local_db[:, -1] > 15.0).all()
