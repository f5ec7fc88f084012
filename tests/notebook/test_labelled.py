"""Tables of pandas and datasets of xarray hold what the noun holds, with unit and meaning."""

from datetime import UTC, datetime
from types import SimpleNamespace

import numpy as np
import pytest

import shaftprint as sp
from shaftprint.fingerprint import Fingerprint
from shaftprint.identify import Estimate
from shaftprint.notebook._labelled import LabelledData, Variable
from shaftprint.signals import ChannelSignal, MessageSignal, Signals, SpeedSignal

pytest.importorskip("pandas", reason="pandas gets the tables")
pytest.importorskip("xarray", reason="xarray gets the datasets")

TURN = np.exp(1j * np.radians([-30.0, -150.0, -270.0]))
RESPONSE = sp.spectra.FrequencyResponse(
    frequency_hz=np.array([0.1, 0.2, 0.4]),
    response=np.stack([0.9 * TURN, 2.0 * TURN])[:, None, :],
    covariance=np.array([np.diag([1.0, 4.0, 9.0, 16.0]) * scale for scale in (1e-4, 1e-6, 1e-8)]),
    inputs=("n_set",),
    outputs=("n", "M_s"),
    lines=("S1", "S2", "S3"),
    used=np.array([True, True, False]),
)


def test_a_response_is_a_row_for_each_output_and_line():
    frame = RESPONSE.to_pandas()
    assert list(frame.index.names) == ["output", "input", "line"]
    row = frame.loc[("M_s", "n_set", "S2")]
    assert (row["frequency_hz"], row["used"]) == (0.2, True)
    assert row["magnitude"] == pytest.approx(2.0)
    assert row["phase_deg"] == pytest.approx(-150.0)
    # covariance of [Re n, Re M_s, Im n, Im M_s]
    assert (row["real_std"], row["imaginary_std"]) == pytest.approx((2e-3, 4e-3))
    assert frame.loc[("n", "n_set", "S3"), "phase_deg"] == pytest.approx(-270.0), "unwrapped"
    assert frame.attrs["units"]["frequency_hz"] == "Hz"
    assert frame.attrs["meanings"]["real_std"] == "standard deviation of the real part"


def test_a_response_keeps_its_covariance_in_a_dataset():
    data = RESPONSE.to_xarray()
    assert data["response"].dims == ("output", "input", "line")
    assert complex(data["response"].sel(output="n", input="n_set", line="S1")) == pytest.approx(0.9 * TURN[0])
    block = data["covariance"].sel(line="S1", component="Im M_s/n_set", component_too="Im M_s/n_set")
    assert float(block) == pytest.approx(16e-4)
    assert data["frequency_hz"].attrs == {"units": "Hz", "long_name": "frequency"}


def signals():
    speed = SpeedSignal(
        name="n_e", channel="PTM", values=np.array([19.0, 20.0, 21.0, 20.0]), reference=20.0, pulse_rate_hz=20.0
    )
    torque = ChannelSignal(name="M_s", channel="gauge", values=np.array([1.0, 2.0, 3.0, 4.0]), reference=2.0)
    rack = MessageSignal(
        name="X", channel="EEC1", values=np.array([0.4, 0.5]), reference=0.5, rate_hz=1.0, start_s=10.2, resolution=0.01
    )
    content = dict.fromkeys(Signals.__dataclass_fields__) | {
        "channels": {"n_set": speed, "n_e": speed, "M_s": torque, "X": rack},
        "rate_hz": 2.0,
        "start_s": 10.0,
        "mode": "shaftprint",
        "recording_name": "log.mf4",
        "recording_sha256": "0" * 64,
    }
    return Signals(**content)


def test_signals_are_columns_over_time():
    frame = signals().to_pandas()
    assert frame.index.name == "time_s"
    assert list(frame.index) == [10.0, 10.5, 11.0, 11.5]
    assert list(frame.columns) == ["n_set", "n_e", "M_s"], "messages have a clock of their own"
    assert frame.loc[11.0, "M_s"] == 3.0
    assert frame.attrs["units"] == {"n_set": "rev/s", "n_e": "rev/s", "M_s": "N m"}
    assert frame.attrs["meanings"]["M_s"] == "shaft torque at the gauge, channel gauge"


def test_messages_are_in_the_dataset_at_their_own_times():
    data = signals().to_xarray()
    assert data["X"].dims == ("time_of_X_s",)
    assert list(data["time_of_X_s"].values) == [10.2, 11.2]
    assert data["X"].sel(time_of_X_s=11.2) == 0.5


def test_the_values_of_a_noun_stay_its_own():
    data = RESPONSE.to_xarray()
    data["frequency_hz"][0] = 7.0
    assert RESPONSE.frequency_hz[0] == 0.1


def test_numbers_of_a_fingerprint_have_interval_unit_meaning_and_kind():
    profiled = Estimate(name="K_p", unit="-", value=4.6, std=0.4, interval_95=(3.8, 5.4), meaning="gain of governor")
    stopped = Estimate(
        name="t_d", unit="s", value=0.1, std=0.02, interval_95=(0.0, 0.13), interval_open=(True, False), at_bound=True
    )
    inertia = Estimate(name="I_dn", unit="kg m2", value=17.0, std=0.5, expected=16.0, expected_std=1.0)
    fingerprint = Fingerprint.model_construct(
        created=datetime(2026, 3, 14, tzinfo=UTC),
        conditions=SimpleNamespace(vessel="Tug", campaign="short"),
        structure="OL3",
        parameters=(profiled, stopped),
        covariance=((0.16, 0.002), (0.002, 4e-4)),
        combinations=(),
        physical=(inertia,),
        margins=(),
        calibration=(),
        verdict=SimpleNamespace(not_trusted={"t_d": "the data set no lower end to it"}),
    )
    frame = fingerprint.to_pandas()
    assert list(frame.index) == ["K_p", "t_d", "I_dn"]
    assert list(frame["kind"]) == ["parameter", "parameter", "physical value"]
    assert frame.loc["K_p", "meaning"] == "gain of governor"
    assert tuple(frame.loc["K_p", ["lower_95", "upper_95"]]) == (3.8, 5.4)
    assert tuple(frame.loc["t_d", ["lower_95", "lower_at_bound", "upper_at_bound"]]) == (0.0, True, False)
    assert list(frame["trusted"]) == [True, False, True]
    assert list(frame["doubt"]) == ["", "the data set no lower end to it", ""]
    assert np.isnan(frame.loc["t_d", "std"]), "at a bound the standard deviation says nothing"
    assert frame.loc["I_dn", "upper_95"] == pytest.approx(17.0 + 1.959964 * 0.5)
    assert (frame.loc["I_dn", "expected"], frame.loc["I_dn", "unit"]) == (16.0, "kg m2")
    data = fingerprint.to_xarray()
    assert float(data["covariance"].sel(parameter="K_p", parameter_too="t_d")) == 0.002
    assert data.attrs["vessel"] == "Tug"


def test_a_fit_gives_its_parameters_and_covariance():
    gain = sp.models.Structure(
        name="GAIN",
        title="a gain",
        input="n_set",
        outputs={"n": sp.models.Gain(sp.models.Parameter("k", "-", 0.0, 3.0, 1.0, "gain of it all"))},
    )
    response = sp.spectra.FrequencyResponse(
        frequency_hz=np.array([0.1, 0.2]),
        response=np.full((1, 1, 2), 1.5 + 0j),
        covariance=np.tile(0.04 * np.eye(2), (2, 1, 1)),
        inputs=("n_set",),
        outputs=("n",),
    )
    fit = sp.identify.identify(gain, response, rng=np.random.default_rng(1))
    frame = fit.to_pandas()
    assert frame.loc["k", "value"] == pytest.approx(1.5)
    # two real parts, each with a standard deviation of 0.2
    assert frame.loc["k", "std"] == pytest.approx(0.2 / np.sqrt(2.0))
    assert (frame.loc["k", "unit"], frame.loc["k", "meaning"]) == ("-", "gain of it all")
    assert fit.to_xarray()["covariance"].shape == (1, 1)
    assert "k 1.5" in repr(fit)


@pytest.mark.parametrize("package", ["pandas", "xarray"])
def test_without_the_package_it_is_said_what_to_install(package, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, package, None)
    data = LabelledData(rows=("a",), variables={}, coordinates={"a": Variable(dims=("a",), values=np.array([1.0]))})
    with pytest.raises(sp.errors.ExportError, match=rf'pip install "shaftprint\[{package}\]"'):
        {"pandas": data.frame, "xarray": data.dataset}[package]()
