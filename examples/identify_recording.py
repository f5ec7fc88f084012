"""From a raw recording to a fingerprint, step by step; run `shaftprint demo` first.

Every step gives a value that can be looked at on its own: the signals on one time grid, the measured frequency
response with its covariance, the identified model, the record that is kept.
"""

from datetime import UTC, datetime

import numpy as np

import shaftprint as sp

vessel, campaign = sp.vessel.load_vessel("demo/vessel.toml"), sp.campaign.load_campaign("demo/campaign.toml")

with sp.recording.read_recording("demo/recording.nc") as recording:
    signals = sp.signals.prepare_signals(recording, vessel, campaign)
point = signals.working_point
print(f"working point: {sp.units.rpm_from_rev_s(point.engine_speed_rev_s):.1f} rpm, {point.shaft_torque_nm:.0f} N m")
print(f"repairs: {len(signals.repairs)}")

measured = sp.spectra.estimate_spectra(signals, campaign)
response = measured.response
for line, frequency, used in zip(response.lines, response.frequency_hz, response.used, strict=True):
    print(f"{line:4} {frequency:8.4f} Hz {'' if used else measured.remarks[line]}")

# A test of speed and shaft torque cannot tell the slope g of the engine torque from the inertia time tau_up of the
# engine: something must be known of both, and the vessel file knows it from the torsional vibration calculation.
gauge = sp.catalogue.structure("GAUGE-CLOSED")
priors = sp.identify.priors_from_vessel(gauge, vessel, point)
for name, prior in priors.items():
    print(f"known beforehand: {name} = {prior.mean:.4f} +/- {prior.std:.4f}")

settings = sp.identify.Settings(priors=priors)
fit = sp.identify.identify(gauge, response, rng=np.random.default_rng(1), settings=settings)
intervals = sp.identify.profile_intervals(fit)
for number in (*fit.parameters, *fit.combinations):
    interval = intervals[number.name]
    print(f"{number.name:26}{number.value:9.4f} {number.unit:6} 95 %: {interval.lower:.4f} to {interval.upper:.4f}")

# The fingerprint adds physical values, margins, the verdict and the conditions under which all of it holds.
fingerprint = sp.fingerprint.take_fingerprint(
    fit,
    signals=signals,
    signal_to_noise=measured.signal_to_noise,
    vessel=vessel,
    campaign=campaign,
    settings_files=(),
    now=datetime.now(UTC),
)
sp.fingerprint.write_fingerprint(fingerprint, "my_fingerprint.json")
for number in (*fingerprint.physical, *fingerprint.margins):
    low, high = number.limits_95
    print(f"{number.name:30}{number.value:10.4g}   95 % interval {low:.4g} to {high:.4g} {number.unit}")
print(fingerprint.verdict.reason)
