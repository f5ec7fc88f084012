"""Row 10: a line with its limits, 50 starts, eight parameters, a chirp of ten minutes and steps of thirteen.

The simulated tug with a rate limit of its rack beside its torque limits, through the raw recording. Free are gains and
delays of the governor and the four numbers of the limits; the rest is held where the sines have it. Timed is the whole
fit: responses, records, noise, 50 starts on coarse records, the best on fine ones, covariance.
"""

import tempfile
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from benchmarks.timing import Spread, print_table
from shaftprint.campaign import Campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Identification, Settings, identify, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import Signals, prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.time_domain import NonlinearSettings, identify_nonlinear, structure_for
from shaftprint.time_domain.nonlinear._fit import NonlinearFit
from shaftprint.time_domain.nonlinear._structure import LimitedModel
from shaftprint.tug import Tug, sail
from shaftprint.vessel import Vessel, load_vessel

FREE = ("K_p", "K_i", "t_d", "t_sp", "m_max", "m_min", "T_aw", "r_x")
RACK_RATE_PER_S = 1.5
SEED = 1
STARTS = 50
WARM_STARTS = 2
LINES = (
    (0.03, 0.4, 2),
    (0.06, 0.4, 3),
    (0.15, 0.4, 6),
    (0.3, 0.3, 10),
    (0.5, 0.2, 14),
    (0.8, 0.12, 20),
    (1.25, 0.08, 30),
    (2.0, 0.1, 40),
    (3.3, 0.1, 60),
)
"""Frequency [Hz], amplitude [V] and periods: small enough for no limit to be reached."""
LEVELS_V = (-5.0, -3.0, -5.0, -7.0, -5.0, -4.0, -6.0, -4.0)
DWELL_S, STAIRCASES = 16.0, 6
CHIRP_S = 600.0


def limits_campaign(*, staircases: int = STAIRCASES, chirp_s: float = CHIRP_S) -> Campaign:
    """Return steps of 2 V, small sines and a chirp that reaches the limits."""
    time_s, stairs, sines = 15.0, [], []
    for number in range(1, staircases + 1):
        stairs.append({"name": f"St{number}", "levels_v": LEVELS_V, "dwell_s": DWELL_S, "start_s": time_s})
        time_s += DWELL_S * len(LEVELS_V) + 20.0
    for number, (frequency, amplitude, periods) in enumerate(LINES, start=1):
        stop_s = round(time_s + 10.0 + periods / frequency + 0.05, 2)
        sines.append(
            {
                "name": f"S{number}",
                "frequency_hz": frequency,
                "amplitude_v": amplitude,
                "start_s": time_s,
                "settled_s": time_s + 10.0,
                "stop_s": stop_s,
            }
        )
        time_s = float(np.ceil(stop_s)) + 3.0
    sweep = {"name": "C1", "start_frequency_hz": 0.02, "stop_frequency_hz": 2.0, "amplitude_v": 0.8}
    chirp = {**sweep, "start_s": time_s, "stop_s": time_s + chirp_s}
    return Campaign.model_validate(
        {
            "name": "limits",
            "duration_s": time_s + chirp_s + 20.0,
            "offset_v": -5.0,
            "sample_rate_hz": 2000.0,
            "sines": sines,
            "staircases": stairs,
            "chirps": [chirp],
        }
    )


def with_wide_gauge(vessel: Vessel) -> Vessel:
    """Return a vessel whose torque telemetry has twice the range: at the torque limit the orders reach its end."""
    gauge = vessel.sensors.shaft_torque
    wide = {"full_scale_nm": 2.0 * gauge.full_scale_nm, "scale_nm_per_unit": 2.0 * gauge.scale_nm_per_unit}
    sensors = vessel.sensors.model_copy(update={"shaft_torque": gauge.model_copy(update=wide)})
    return vessel.model_copy(update={"sensors": sensors})


def run(repetitions: int) -> None:
    """Sail, fit and print."""
    vessel, campaign = with_wide_gauge(load_vessel("stan-tug-1205")), limits_campaign()
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "limits.nc"
        truth = sail(vessel, campaign, path, tug=Tug(rack_rate_limit_per_s=RACK_RATE_PER_S), seed=SEED)
        with read_recording(path) as recording:
            signals = prepare_signals(recording, vessel, campaign)
    gauge = structure("GAUGE-CLOSED")
    settings = Settings(priors=priors_from_vessel(gauge, vessel, signals.working_point))
    sines = identify(gauge, estimate_response(signals, campaign), rng=np.random.default_rng(SEED), settings=settings)
    model = _eight_free(vessel, signals, sines)
    _fit(signals, campaign, vessel, model, sines, starts=WARM_STARTS)
    wall, cpu = [], []
    for _ in range(repetitions):
        begin, begin_cpu = time.perf_counter(), time.process_time()
        fit = _fit(signals, campaign, vessel, model, sines, starts=STARTS)
        wall.append(time.perf_counter() - begin)
        cpu.append(time.process_time() - begin_cpu)
    _print(fit, truth.normalised["X_0"], Spread(tuple(wall)), Spread(tuple(cpu)))


def _eight_free(vessel: Vessel, signals: Signals, sines: Identification) -> LimitedModel:
    model = structure_for(("torque", "rate"), vessel, signals.working_point)
    known = {p.name: p.value for p in sines.parameters if p.name not in FREE}
    return replace(model, structure=model.structure.held_at(**known))


def _fit(
    signals: Signals, campaign: Campaign, vessel: Vessel, model: LimitedModel, sines: Identification, *, starts: int
) -> NonlinearFit:
    return identify_nonlinear(
        signals,
        campaign,
        vessel,
        model,
        rng=np.random.default_rng(SEED),
        linear=sines,
        settings=NonlinearSettings(starts=starts),
    )


def _print(fit: NonlinearFit, rack: float, wall: Spread, cpu: Spread) -> None:
    print_table(
        "Row 10: nonlinear fit, 50 starts, 8 parameters, chirp of 600 s and steps of 768 s",
        ("what", "asked", "measured"),
        (
            ("wall time [s]", "at most 60 on 2 cores", wall.text(digits=1)),
            ("CPU time of all threads [s]", "", cpu.text(digits=1)),
            ("starts that went on, of these at the winning optimum", "", f"{fit.reached[1]}, {fit.reached[0]}"),
        ),
    )
    true = {"share": 1.0, "r_x": RACK_RATE_PER_S / rack}
    rows = [
        (number.name, f"{number.value:.4g}", f"{number.std:.2g}", f"{true[number.name]:.4g}")
        for number in fit.limits
        if number.name in true
    ]
    print_table("Its limits", ("number", "found", "standard deviation", "true"), rows)
