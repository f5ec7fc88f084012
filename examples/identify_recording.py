"""From a raw recording to parameters with their uncertainty, step by step; run `shaftprint demo` first.

Every step gives a value that can be looked at on its own: the signals on one time grid, the measured frequency
response with its covariance, the identified model.
"""

import numpy as np

from shaftprint import campaign, identify, models, recording, signals, spectra, vessel
from shaftprint.units import rpm_from_rev_s

tug, test = vessel.load_vessel("demo/vessel.toml"), campaign.load_campaign("demo/campaign.toml")

with recording.read_recording("demo/recording.nc") as raw:
    prepared = signals.prepare_signals(raw, tug, test)
point = prepared.working_point
print(f"working point: {rpm_from_rev_s(point.engine_speed_rev_s):.1f} rpm, {point.shaft_torque_nm:.0f} N m")
print(f"repairs: {len(prepared.repairs)}")

measured = spectra.estimate_spectra(prepared, test)
for line, frequency, used in zip(
    measured.response.lines, measured.response.frequency_hz, measured.response.used, strict=True
):
    print(f"{line:4} {frequency:8.4f} Hz {'' if used else measured.remarks[line]}")

# A test of speed and shaft torque cannot tell the slope g of the engine torque from the inertia time tau_up of the
# engine: something must be known of both, and the vessel file knows it from the torsional vibration calculation.
gauge = models.structure("GAUGE-CLOSED")
priors = identify.priors_from_vessel(gauge, tug, point)
for name, prior in priors.items():
    print(f"known beforehand: {name} = {prior.mean:.4f} +/- {prior.std:.4f}")

settings = identify.Settings(priors=priors)
found = identify.identify(gauge, measured.response, rng=np.random.default_rng(1), settings=settings)
intervals = identify.profile_intervals(found)
for number in (*found.parameters, *found.combinations):
    interval = intervals[number.name]
    print(f"{number.name:26}{number.value:9.4f} {number.unit:6} 95 %: {interval.lower:.4f} to {interval.upper:.4f}")
