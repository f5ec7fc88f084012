"""A ship underway: wake, resistance and thrust deduction from a dither test, with the propeller's curve known.

The simulated tug sails at 1600 rpm while both set points move by 2 %. Torque, speed of one shaft and the ship's log are
recorded, and everything is found from that recording. Replace the first part by your own files.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from shaftprint.campaign import load_campaign
from shaftprint.catalogue import KnownPropeller, structure, with_known_propeller
from shaftprint.identify import identifiability, identify
from shaftprint.propeller import ka4_70_in_19a
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_spectra, plant_from_closed_loop
from shaftprint.tug import Sailing, Tug, sail
from shaftprint.vessel import ShipSpeedSensor, load_vessel

# ---- a recording of a ship with a log ----

vessel, campaign = load_vessel("stan-tug-1205"), load_campaign("transit")
log = ShipSpeedSensor(channel="v_s", unit="m/s", cycle_s=0.2, resolution=0.005, latency_s=0.3)
vessel = vessel.model_copy(update={"sensors": vessel.sensors.model_copy(update={"ship_speed": log})})
tug = Tug(engine_speed_rpm=1600.41, sailing=Sailing(wake_fraction=0.20, thrust_deduction=0.15))

with TemporaryDirectory() as folder:
    path = Path(folder) / "underway.nc"
    truth = sail(vessel, campaign, path, tug=tug, seed=1).normalised
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, campaign)

# ---- from torque to shaft speed and ship speed ----

response = estimate_spectra(signals, campaign).response
core = plant_from_closed_loop(response, input="M_s", output=("n", "v_s"))

# ---- the propeller is known: what remains is the ship ----

propeller = KnownPropeller(
    curve=ka4_70_in_19a(),
    pitch_ratio=vessel.propeller.pitch_ratio,
    diameter_m=vessel.propeller.diameter_m,
    propellers=vessel.hull.shafts,
    water_density_kg_m3=vessel.water_density_kg_m3,
    shaft_speed_rev_s=signals.working_point.engine_speed_rev_s / vessel.gearbox.ratio,
    ship_speed_m_s=signals.channels["v_s"].reference,
)
plain = structure("FREE-SHIP").held_at(t_gauge=0.0)
known = with_known_propeller(plain, propeller, mass_kg=vessel.hull.surging_mass_kg)

print(identifiability(plain, rng=np.random.default_rng(1)).text)
print()
fit = identify(known, core, rng=np.random.default_rng(1))
estimates = {estimate.name: estimate for estimate in (*fit.parameters, *fit.combinations)}
for name in ("w", "t", "R", "e", "tau_dn", "b", "(e - a) / tau_u"):
    estimate = estimates[name]
    told = f"{truth[name]:10.4g}" if name in truth else ""
    print(f"{name:16s} {estimate.value:10.4g} +/- {estimate.std:8.2g} {estimate.unit:4s} {told}")
