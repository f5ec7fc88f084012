"""The verdict on the simulated tug: dynamic inflow and entrained water, switched on, are missed and then found."""

import numpy as np
import pytest

from shaftprint.catalogue import structure
from shaftprint.identify import Settings, assess, compare_fits, identify, priors_from_vessel, profile
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_spectra
from shaftprint.tug import Tug, sail

pytestmark = pytest.mark.slow


INFLOW = Tug(inflow_gain=1.0, inflow_time_s=0.12, entrained_water_kg_m2=4.4)


@pytest.fixture(scope="module")
def judged(vessel, short_campaign, tmp_path_factory):
    """Both structures fitted to a recording of each truth, with their verdicts."""

    def judge(tug, seed):
        path = tmp_path_factory.mktemp("verdict") / "recording.nc"
        sail(vessel, short_campaign, path, tug=tug, seed=seed)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, short_campaign)
        spectra = estimate_spectra(signals, short_campaign)
        fits = {}
        for name in ("GAUGE-CLOSED", "GAUGE-INFLOW"):
            known = priors_from_vessel(structure(name), vessel, signals.working_point)
            settings = Settings(priors=known, starts=30)
            fits[name] = identify(structure(name), spectra.response, rng=np.random.default_rng(1), settings=settings)
        verdicts = {
            name: assess(fit, profile=profile(fit), signal_to_noise=spectra.signal_to_noise)
            for name, fit in fits.items()
        }
        return fits, verdicts

    return judge


def test_with_inflow_the_plain_structure_is_rejected_and_the_right_one_found(judged):
    fits, verdicts = judged(INFLOW, seed=1)
    plain, right = verdicts["GAUGE-CLOSED"], verdicts["GAUGE-INFLOW"]
    assert fits["GAUGE-CLOSED"].p_value < 0.01
    assert not plain.trustworthy
    misfit = "The structure GAUGE-CLOSED does not explain the data within their noise"
    assert any(reason.sentence.startswith(misfit) for reason in plain.reasons[:3])
    assert plain.suspects[0].words == "there is dynamic inflow: the slipstream follows the propeller late"
    assert plain.suspects[0].share > 0.8
    assert fits["GAUGE-INFLOW"].p_value >= 0.01
    assert right.trustworthy
    compared = compare_fits(list(fits.values()), rng=np.random.default_rng(1), folds=0)
    assert compared.best.name == "GAUGE-INFLOW"
    (ratio,) = compared.ratios
    assert (ratio.small, ratio.large) == ("GAUGE-CLOSED", "GAUGE-INFLOW")
    assert ratio.p_value < 1e-9


def test_without_inflow_the_plain_structure_is_not_rejected_and_needs_no_more(judged):
    fits, verdicts = judged(Tug(), seed=1)
    assert fits["GAUGE-CLOSED"].p_value >= 0.05
    assert verdicts["GAUGE-CLOSED"].trustworthy
    compared = compare_fits(list(fits.values()), rng=np.random.default_rng(1), folds=0, draws=99)
    assert compared.best.name == "GAUGE-CLOSED"
    assert compared.ratios[0].p_value > 0.05
