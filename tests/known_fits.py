"""Fits whose result is known, and their fingerprints: responses of a known line, with a stated covariance."""

from dataclasses import replace
from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
from tests.made_signals import made_channels

from shaftprint.catalogue import structure
from shaftprint.fingerprint import SourceFile, take_fingerprint
from shaftprint.identify import Settings, identify
from shaftprint.identify.fit._identification import Cluster
from shaftprint.signals import Repair, SetPointCalibration, Signals, StripAngles, WorkingPoint
from shaftprint.spectra import FrequencyResponse, SignalToNoise
from shaftprint.vessel import load_vessel

TRUTH = {
    "tau_dn": 0.32,
    "tau_up": 1.016,
    "k_q": 2.0,
    "g": 0.0,
    "v": 1.0,
    "K_p": 5.7,
    "K_i": 4.27,
    "t_d": 0.0703,
    "t_sp": 0.0518,
    "omega_n": 10.3,
    "zeta": 0.47,
    "c_set": 1.0,
    "t_gauge": 0.0,
}
FREQUENCY_HZ = np.geomspace(0.005, 6.0, 14)
LINES = tuple(f"S{number}" for number in range(1, 15))
NOW = datetime(2026, 3, 14, 9, 30, tzinfo=UTC)
CAMPAIGN = SimpleNamespace(
    name="Test around -5 V", place="Quay 12, Rotterdam", offset_v=-5.0, offset_rpm=None, slope_rpm_per_v=None
)
# loggers often state no time zone
BEGAN = datetime(2026, 3, 13, 14, 5)  # noqa: DTZ001


def exact_response(model, values, share, **changes):
    """Return the response of a model without noise, whose stated standard deviation is a share of its size."""
    known = {name: value for name, value in values.items() if name in model.names}
    true = model.response(model.vector(known), 2j * np.pi * FREQUENCY_HZ)
    variance = np.concatenate([np.abs(true), np.abs(true)]).T ** 2 * share**2
    given = {
        "frequency_hz": FREQUENCY_HZ,
        "response": true[:, None, :],
        "covariance": np.einsum("ls,st->lst", variance, np.eye(2 * true.shape[0])),
        "inputs": (model.input,),
        "outputs": tuple(model.outputs),
        "lines": LINES,
    }
    return FrequencyResponse(**given | changes)


def fitted(name, values, share=0.001, settings=None, lines=None, held=(), **changes):
    model = structure(name)
    model = model.held_at(**{parameter: values[parameter] for parameter in held})
    return identify(
        model,
        exact_response(model, values, share, **changes),
        rng=np.random.default_rng(7),
        settings=settings or Settings(starts=20),
        lines=lines,
    )


def changed(identification, *, values=None, std=None, **fields):
    """Return a fit with some values and standard deviations put by hand; those parameters lose their correlations."""
    names = [parameter.name for parameter in identification.structure.free]
    covariance = identification.covariance.copy()
    for name, size in (std or {}).items():
        place = names.index(name)
        covariance[place, :] = covariance[:, place] = 0.0
        covariance[place, place] = size**2
    table = identification.values.copy()
    for name, value in (values or {}).items():
        table[identification.structure.names.index(name)] = value
    clusters = tuple(
        Cluster(values=table if i == 0 else c.values, cost=c.cost, starts=c.starts, stable=c.stable)
        for i, c in enumerate(identification.clusters)
    )
    return replace(identification, values=table, covariance=covariance, **{"clusters": clusters} | fields)


def noisy_response(model, values, *, share, seed):
    """Return a response with drawn noise, a share of the response in each part."""
    exact = exact_response(model, values, share)
    std = np.sqrt(np.diagonal(exact.covariance, axis1=1, axis2=2)).T
    parts = np.random.default_rng(seed).standard_normal(std.shape) * std
    outputs = std.shape[0] // 2
    noisy = exact.response + (parts[:outputs] + 1j * parts[outputs:])[:, None, :]
    return replace(exact, response=noisy)


def known_working_point():
    return WorkingPoint(
        engine_speed_rev_s=1183.8 / 60.0,
        shaft_torque_nm=1725.0,
        engine_speed_std_rev_s=0.01,
        shaft_torque_std_nm=8.0,
        set_point_v=-5.05,
        load_std=0.005,
    )


def known_signals(working_point):
    still = np.zeros(4)
    return Signals(
        rate_hz=200.0,
        start_s=0.0,
        channels=made_channels(
            working_point, still, still, {"n_e": {"channel": "PTM_e", "values": still, "pulse_rate_hz": 19.73}}
        ),
        working_point=working_point,
        calibration=SetPointCalibration(
            slope_rev_s_per_v=-4.2,
            intercept_rev_s=-1.4,
            covariance=np.array([[1e-4, 5e-4], [5e-4, 2.5e-3]]),
            level_v=np.array([-6.0, -4.0]),
            level_rev_s=np.array([23.8, 15.4]),
            level_std_rev_s=np.array([0.02, 0.02]),
        ),
        dc_scale=1.004,
        dc_scale_std=0.001,
        strips=(StripAngles(channel="PTM_4", angle_rev=np.full(4, 0.25), std_rev=np.full(4, 1e-4)),),
        step_delays=(),
        repairs=(
            Repair(channel="M_s", kind="outlier", time_s=3.0, count=1),
            Repair(channel="PTM_e", kind="missing pulse", time_s=5.0, count=2),
            Repair(channel="M_s", kind="outlier", time_s=8.0, count=4),
        ),
        mode="shaftprint",
        findings=("channel M_s reaches full scale from 12.0 s on: 3 samples are cut off there",),
        recording_sha256="ab" * 32,
        recording_name="port.nc",
    )


def known_signal_to_noise():
    return SignalToNoise(
        lines=LINES,
        channels=("n_set", "n_e", "M_s"),
        local_db=np.arange(42.0).reshape(14, 3),
        overall=np.array([0.999, 0.94, 0.57]),
    )


def taken(identification, *, now=NOW, signals=None, vessel=None, campaign=CAMPAIGN, **stated):
    """Return the fingerprint of a fit, of signals that are known."""
    return take_fingerprint(
        identification,
        signals=signals or known_signals(known_working_point()),
        signal_to_noise=known_signal_to_noise(),
        vessel=vessel or load_vessel("stan-tug-1205"),
        campaign=campaign,
        settings_files=(
            SourceFile(role="vessel", name="tug.toml", sha256="cd" * 32),
            SourceFile(role="campaign", name="test.toml", sha256="ef" * 32),
        ),
        now=now,
        **{"tested_at": BEGAN} | stated,
    )
