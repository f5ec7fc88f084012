"""Signals and windows with known content."""

import numpy as np
import pytest
from scipy.special import stdtrit
from tests.made_signals import made_channels

from shaftprint.campaign import Campaign, Sine
from shaftprint.signals import SetPointCalibration, Signals, WorkingPoint
from shaftprint.spectra.lines._line_fit import WindowSamples
from shaftprint.spectra.lines._windows import Window

SPEED_REV_S = 20.0
TORQUE_NM = 1700.0
SLOPE_REV_S_PER_V = -4.0
POINT = WorkingPoint(
    engine_speed_rev_s=SPEED_REV_S,
    shaft_torque_nm=TORQUE_NM,
    engine_speed_std_rev_s=0.01,
    shaft_torque_std_nm=1.0,
    set_point_v=-5.0,
    load_std=0.0,
)


@pytest.fixture
def make_window():
    """A window with given channels, as functions of the time since its start."""

    def make(*channels, frequency_hz, periods, rate_hz, first_s=0.0):
        window = Window(line="S1", frequency_hz=frequency_hz, start_s=100.0, periods=periods)
        count = int(np.ceil((window.duration_s - first_s) * rate_hz - 1e-6))
        time_s = first_s + np.arange(count) / rate_hz
        values = np.stack([np.broadcast_to(channel(time_s), time_s.shape) for channel in channels])
        names = ("n_set", *(f"n_{place}" for place in range(1, len(channels) - 1)), "M_s")[-len(channels) :]
        return WindowSamples(
            window=window, rate_hz=rate_hz, time_s=time_s, channels=names, values=np.ascontiguousarray(values)
        )

    return make


@pytest.fixture
def make_campaign():
    """A campaign of sines given as (name, frequency, settled, stop), 0.6 V each."""

    def make(*sines, amplitude_v=0.6):
        return Campaign(
            name="test",
            duration_s=1e5,
            offset_v=-5.0,
            sines=tuple(
                Sine(name=name, frequency_hz=hz, amplitude_v=amplitude_v, start_s=start, settled_s=start, stop_s=stop)
                for name, hz, start, stop in sines
            ),
        )

    return make


@pytest.fixture
def make_signals():
    """Signals from deviations over the working point: set point, torque and speeds by name."""

    def make(
        set_point, torque, speeds, *, rate_hz=20.0, pulse_rate_hz=np.inf, mode="shaftprint", scale_std=0.0, **changes
    ):
        given = {
            "rate_hz": rate_hz,
            "start_s": 0.0,
            "channels": made_channels(
                POINT,
                SPEED_REV_S * (1.0 + set_point),
                TORQUE_NM * (1.0 + torque),
                {
                    name: {
                        "channel": f"PTM_{name}",
                        "values": SPEED_REV_S * (1.0 + speed),
                        "pulse_rate_hz": pulse_rate_hz,
                    }
                    for name, speed in speeds.items()
                },
                per_volt=SLOPE_REV_S_PER_V,
                scale_std=scale_std,
            ),
            "working_point": POINT,
            "calibration": SetPointCalibration(
                slope_rev_s_per_v=SLOPE_REV_S_PER_V,
                intercept_rev_s=0.0,
                covariance=np.zeros((2, 2)),
                level_v=np.array([-6.0, -4.0]),
                level_rev_s=np.array([24.0, 16.0]),
                level_std_rev_s=np.array([0.01, 0.01]),
            ),
            "dc_scale": 1.0,
            "dc_scale_std": 0.0,
            "strips": (),
            "step_delays": (),
            "repairs": (),
            "mode": mode,
            "recording_sha256": "0" * 64,
            "recording_name": "test.h5",
        }
        return Signals(**(given | changes))

    return make


@pytest.fixture
def coloured():
    """Two channels of correlated Gaussian noise whose density falls with a power of the frequency."""

    def draw(rng, count, *, slope, correlation=0.8):
        # four times the length, so that a record is not a period of itself
        frequency = np.fft.rfftfreq(4 * count)
        frequency[0] = 0.25 * frequency[1]
        shape = (2, frequency.size)
        first, second = rng.standard_normal(shape) + 1j * rng.standard_normal(shape)
        second = correlation * np.exp(0.5j) * first + np.sqrt(1.0 - correlation**2) * second
        shaped = np.stack([first, second]) * frequency ** (-0.5 * slope)
        return np.fft.irfft(shaped, axis=1)[:, count : 2 * count]

    return draw


@pytest.fixture
def expect_honest():
    """Check over repeats that covariances are right as weights and that 95 % intervals cover the truth."""

    def check(responses, truth):
        distances, covered = [], []
        for found in responses:
            used = found.used
            size = len(found.outputs) * len(found.inputs)
            error = (found.response - truth(found.frequency_hz)).reshape(size, -1)[:, used]
            error = np.concatenate([error.real, error.imag]).T
            covariance = found.covariance[used]
            distances.append(np.einsum("li,lij,lj->l", error, np.linalg.inv(covariance), error).mean() / (2 * size))
            # the covariance is n / (n - outputs) larger than the mean square of the errors
            samples = 0.5 * found.degrees_of_freedom[used]
            plain = np.diagonal(covariance, axis1=1, axis2=2) * ((samples - len(found.outputs)) / samples)[:, None]
            half = stdtrit(2.0 * samples, 0.975)[:, None] * np.sqrt(plain)
            covered.append(np.mean(np.abs(error) < half))
        for values, expected in ((np.array(distances), 1.0), (np.array(covered), 0.95)):
            assert abs(values.mean() - expected) < 3.0 * values.std() / np.sqrt(values.size), (expected, values.mean())
            # the check must be sharp enough to find a wrong factor
            assert values.std() / np.sqrt(values.size) < 0.025

    return check
