"""Compare two fingerprints of one ship: which numbers have changed, and which differ by chance.

The simulated tug is tested twice. Between both tests its propeller has become 1.5 kg m2 heavier (a rope in it, say)
and somebody has lowered the governor's integral gain by a fifth. Replace the first part by two saved fingerprints.

What both tests have in common cannot make them differ: the scale of the same torque gauge, the same torsional vibration
calculation, the same latency of the telemetry. The budget of a fingerprint says how much of each variance comes from
where, so that the difference is held against what is a test's own alone.
"""

from datetime import UTC, datetime
from math import hypot, sqrt
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import shaftprint as sp

OWN_SOURCES = ("noise of n", "noise of M_s", "set-point calibration", "wander of the load")


def fingerprint_of(tug, seed):
    """Sail a test of 14 minutes and return its fingerprint."""
    vessel, campaign = sp.vessel.load_vessel("stan-tug-1205"), sp.campaign.load_campaign("short")
    with TemporaryDirectory() as folder:
        path = Path(folder) / "recording.nc"
        sp.tug.sail(vessel, campaign, path, tug=tug, seed=seed)
        with sp.recording.read_recording(path) as recording:
            signals = sp.signals.prepare_signals(recording, vessel, campaign)
    measured = sp.spectra.estimate_spectra(signals, campaign)
    line = sp.catalogue.structure("GAUGE-CLOSED")
    settings = sp.identify.Settings(priors=sp.identify.priors_from_vessel(line, vessel, signals.working_point))
    return sp.fingerprint.take_fingerprint(
        sp.identify.identify(line, measured.response, rng=np.random.default_rng(seed), settings=settings),
        signals=signals,
        signal_to_noise=measured.signal_to_noise,
        vessel=vessel,
        campaign=campaign,
        settings_files=(),
        now=datetime.now(UTC),
    )


def own_std(fingerprint, name):
    """Return the standard deviation that comes from the test itself, in the number's unit."""
    variances = fingerprint.budget.row(name).variances
    return sqrt(max(sum(variances.get(source, 0.0) for source in OWN_SOURCES), 0.0))


before = fingerprint_of(sp.tug.Tug(), seed=3)
after = fingerprint_of(sp.tug.Tug(inertia_downstream_kg_m2=18.5, integral_gain_per_s=0.8 * 4.27), seed=4)

print(f"{'':10}{'before':>9}{'after':>9}{'change':>11} +/-")
deviations = {}
for name in ("I_dn", "I_up", "k_q", "K_Q", "t_d + t_sp", "K_p / K_i"):
    one, other = before.quantity(name), after.quantity(name)
    change, std = other.value - one.value, hypot(own_std(before, name), own_std(after, name))
    deviations[name] = change / std
    said = "CHANGED" if abs(change) > 3.0 * std else "as it was"
    print(f"{name:10}{one.value:9.4g}{other.value:9.4g}{change:+11.3g} +/- {std:<8.2g}{one.unit:6} {said}")
