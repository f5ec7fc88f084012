"""Small nouns with known content, built by hand, for figures and report."""

from datetime import UTC, datetime

import numpy as np
import pytest
from tests.made_signals import made_channels

from shaftprint.campaign import Campaign, setpoint
from shaftprint.catalogue import structure
from shaftprint.fingerprint import SourceFile, take_fingerprint
from shaftprint.identify import Prior, Settings, identify
from shaftprint.identify.search._starts import LatinHypercube
from shaftprint.recording import Channel, Recording
from shaftprint.signals import Repair, SetPointCalibration, Signals, StripAngles, WorkingPoint
from shaftprint.signals._signals import StepDelay
from shaftprint.spectra import FrequencyResponse, Harmonics, SignalToNoise, Spectra, open_loop, plan_windows
from shaftprint.survey import Measurement, Survey, Trial
from shaftprint.vessel import load_vessel

TRUTH = {
    "tau_dn": 0.32,
    "tau_up": 1.016,
    "k_q": 2.0,
    "g": 0.0,
    "v": 1.0,
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.07,
    "t_sp": 0.05,
    "omega_n": 10.3,
    "zeta": 0.47,
    "c_set": 1.0,
}
FREQUENCY_HZ = np.array(
    [
        0.0044,
        0.0092,
        0.0193,
        0.0275,
        0.0405,
        0.06,
        0.0848,
        0.11,
        0.1778,
        0.3728,
        0.7814,
        1.637,
        3.433,
        7.19,
        15.01,
        31.6,
    ]
)
LINES = tuple(f"S{number}" for number in range(1, 17))
USED = np.arange(16) < 14
RATE_HZ = 50.0
START_S = 0.0


def measured_response(seed=1):
    model = structure("GAUGE-CLOSED")
    true = model.response(model.vector(TRUTH), 2j * np.pi * FREQUENCY_HZ)
    share = np.array([0.01, 0.03])[:, None] * (1.0 + (FREQUENCY_HZ / 2.0) ** 2)
    std = share * np.abs(true) + 1e-4
    rng = np.random.default_rng(seed)
    noisy = true + std * (rng.standard_normal(true.shape) + 1j * rng.standard_normal(true.shape))
    variance = np.concatenate([std, std]).T ** 2
    covariance = np.einsum("ls,st->lst", variance, np.eye(4))
    return FrequencyResponse(
        frequency_hz=FREQUENCY_HZ,
        response=noisy[:, None, :],
        covariance=covariance,
        inputs=("n_set",),
        outputs=("n", "M_s"),
        lines=LINES,
        degrees_of_freedom=np.full(16, 24.0),
        used=USED,
        remarks={"S15": "aliased", "S16": "aliased"},
    )


@pytest.fixture(scope="session")
def response():
    return measured_response()


@pytest.fixture(scope="session")
def open_responses(response):
    return open_loop(response)


@pytest.fixture(scope="session")
def identification(response):
    settings = Settings(starts=10, draw=LatinHypercube(), priors={"g": Prior(0.0, 0.1)})
    return identify(structure("GAUGE-CLOSED"), response, rng=np.random.default_rng(3), settings=settings)


@pytest.fixture(scope="session")
def fits(response, open_responses):
    """The structures of the thesis, fitted to the same data."""
    governor, core = open_responses
    rng = np.random.default_rng(4)
    settings = Settings(starts=12)
    data = {"OL1": core} | dict.fromkeys(("OL2", "OL3", "OL4", "OL5"), governor)
    data |= dict.fromkeys(("CL1", "CL3", "CL4", "BENCHMARK"), response)
    return {name: identify(structure(name), r, rng=rng, settings=settings) for name, r in data.items()}


@pytest.fixture(scope="session")
def campaign():
    return Campaign(
        name="short test",
        duration_s=700.0,
        offset_v=-5.0,
        sines=(
            {"name": "S1", "frequency_hz": 0.1, "amplitude_v": 0.6, "start_s": 20, "settled_s": 30, "stop_s": 120},
            {"name": "S2", "frequency_hz": 0.5, "amplitude_v": 0.6, "start_s": 130, "settled_s": 140, "stop_s": 180},
            {"name": "S3", "frequency_hz": 2.0, "amplitude_v": 0.6, "start_s": 185, "settled_s": 188, "stop_s": 200},
        ),
        staircases=({"name": "St1", "levels_v": (-4, -5, -6, -5, -4), "dwell_s": 20, "start_s": 210},),
        chirps=(
            {
                "name": "C11",
                "start_frequency_hz": 0.01,
                "stop_frequency_hz": 2.0,
                "amplitude_v": 0.6,
                "start_s": 350,
                "stop_s": 450,
            },
            {
                "name": "C21",
                "start_frequency_hz": 0.01,
                "stop_frequency_hz": 0.1,
                "amplitude_v": 0.6,
                "start_s": 460,
                "stop_s": 560,
            },
            {
                "name": "C22",
                "start_frequency_hz": 0.1,
                "stop_frequency_hz": 2.0,
                "amplitude_v": 0.6,
                "start_s": 580,
                "stop_s": 680,
            },
        ),
    )


@pytest.fixture(scope="session")
def volts(campaign):
    return setpoint(campaign, np.arange(700 * 50) / RATE_HZ)


@pytest.fixture(scope="session")
def signals(volts):
    rng = np.random.default_rng(5)
    set_point = (-250.97 * volts - 83.467) / 60.0
    lag = round(0.4 * RATE_HZ)
    speed = np.concatenate([np.full(lag, set_point[0]), set_point[:-lag]]) + 0.02 * rng.standard_normal(volts.size)
    torque = 1725.0 * (speed / 19.53) ** 2 * (1.0 + 0.05 * rng.standard_normal(volts.size))
    sensors = {
        name: {"channel": channel, "values": speed, "pulse_rate_hz": rate}
        for name, channel, rate in (("n_e", "PTM_e", 19.73), ("n_e1", "PTM_1", 5.16), ("n_e4", "PTM_4", 20.66))
    }
    levels = np.array([-6.0, -5.0, -4.0])
    point = WorkingPoint(
        engine_speed_rev_s=19.53,
        shaft_torque_nm=1725.0,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=8.0,
        set_point_v=-5.0,
        load_std=0.005,
    )
    return Signals(
        rate_hz=RATE_HZ,
        start_s=START_S,
        channels=made_channels(point, set_point, torque, sensors, per_volt=-250.97 / 60.0),
        working_point=point,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-250.97 / 60.0,
            intercept_rev_s=-83.467 / 60.0,
            covariance=np.array([[1e-4, 5e-4], [5e-4, 2.6e-3]]),
            level_v=levels,
            level_rev_s=(-250.97 * levels - 83.467) / 60.0 + np.array([0.02, -0.03, 0.01]),
            level_std_rev_s=np.array([0.02, 0.015, 0.02]),
        ),
        dc_scale=1.004,
        dc_scale_std=0.001,
        strips=(
            StripAngles(
                channel="PTM_4",
                angle_rev=np.array([90.40, 87.24, 90.74, 91.62]) / 360.0,
                std_rev=np.full(4, 0.03) / 360.0,
            ),
        ),
        step_delays=tuple(
            StepDelay(staircase="St1", set_point_time_s=at, speed_time_s=at + delay, rising=rising)
            for at, delay, rising in (
                (230.0, 0.41, True),
                (250.0, 0.38, True),
                (270.0, 0.43, False),
                (290.0, 0.42, False),
            )
        ),
        repairs=(
            Repair(channel="PTM_e", kind="missing pulse", time_s=55.2, count=1),
            Repair(channel="M_s", kind="outlier", time_s=100.0, count=3),
            Repair(channel="U_setpoint", kind="outlier", time_s=300.0, count=1),
            Repair(channel="M_s", kind="outlier", time_s=600.0, count=2),
        ),
        mode="shaftprint",
        recording_sha256="ab" * 32,
        recording_name="short.nc",
    )


@pytest.fixture(scope="session")
def recording(tmp_path_factory, volts, signals):
    torque = signals.shaft_torque_nm / 500.0
    spiked = {"U_setpoint": volts.copy(), "M_s": torque.copy()}
    spiked["U_setpoint"][15000] = 3.0
    spiked["M_s"][[5000, 30000]] = 9.5
    channels = {
        name: Channel(
            name=name,
            unit="V",
            rate_hz=RATE_HZ,
            start_s=START_S,
            count=values.size,
            source=lambda start, stop, values=values: values[start:stop],
        )
        for name, values in spiked.items()
    }
    return Recording(
        path=tmp_path_factory.mktemp("raw") / "short.nc", sha256="ab" * 32, format="native", channels=channels
    )


@pytest.fixture(scope="session")
def spectra(response, signals):
    channels = ("n_set", *signals.speeds, "M_s")
    ramp_db = np.linspace(60.0, -20.0, 16)
    local = ramp_db[:, None] - np.array([0.0, 10.0, 12.0, 11.0, 25.0])
    plan = Campaign(
        name="sines",
        duration_s=12000.0,
        offset_v=-5.0,
        sines=tuple(
            {
                "name": name,
                "frequency_hz": frequency,
                "amplitude_v": 0.6,
                "start_s": 700.0 * place,
                "settled_s": 700.0 * place + 5.0,
                "stop_s": 700.0 * place + 690.0,
            }
            for place, (name, frequency) in enumerate(zip(LINES, FREQUENCY_HZ.tolist(), strict=True))
        ),
    )
    return Spectra(
        response=response,
        windows=plan_windows(plan),
        signal_to_noise=SignalToNoise(
            lines=LINES,
            channels=channels,
            local_db=local,
            overall=np.array([0.9986, 0.9451, 0.9475, 0.8610, 0.5751]),
        ),
        harmonics=Harmonics(
            lines=LINES,
            outputs=("n", "M_s"),
            orders=(2, 3),
            fundamental=np.full((16, 2), 0.1),
            amplitude=np.full((16, 2, 2), 0.002),
            standard_deviation=np.full((16, 2, 2), 0.001),
            expected_second_torque=np.full(16, 0.005),
        ),
        load_drift=None,
        speed="n_e",
        remarks={"S15": "above 9.87 Hz, half the pulse rate of n_e: aliased", "S16": "aliased"},
    )


@pytest.fixture(scope="session")
def vessel():
    return load_vessel("stan-tug-1205")


@pytest.fixture(scope="session")
def fingerprint(identification, signals, spectra, vessel, campaign):
    return take_fingerprint(
        identification,
        signals=signals,
        signal_to_noise=spectra.signal_to_noise,
        vessel=vessel,
        campaign=campaign,
        settings_files=(SourceFile(role="vessel", name="stan-tug-1205", sha256="cd" * 32),),
        now=datetime(2026, 1, 2, 3, 4, tzinfo=UTC),
    )


@pytest.fixture(scope="session")
def survey(fingerprint, identification, recording, signals, spectra, vessel, campaign):
    return Survey(
        trial=Trial(vessel=vessel, campaign=campaign),
        measurement=Measurement(
            signals=signals, spectra=spectra, responses=(spectra.response,), levels=recording.levels()
        ),
        fits=(identification,),
        fingerprint=fingerprint,
    )
