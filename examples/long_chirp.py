"""From a recording to fits of the thesis' long chirp: CL2, CL4 and the gauge-aware loop.

The long chirp of the thesis is three chirps in a row, C21 to C23, and the recording ends with the last of them, at full
speed. A tug that is simulated sails them here, after a staircase that calibrates the set point.
"""

from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from shaftprint.campaign import Campaign, Staircase, load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings, assess, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.time_domain import identify_chirp, records_of
from shaftprint.tug import sail
from shaftprint.vessel import load_vessel

tug, thesis = load_vessel("stan-tug-1205"), load_campaign("thesis")

# the part of the thesis' test that is used, earlier by EARLIER_S
EARLIER_S = 9000.0
chirps = tuple(
    chirp.model_copy(update={"start_s": chirp.start_s - EARLIER_S, "stop_s": chirp.stop_s - EARLIER_S})
    for chirp in thesis.chirps
    if chirp.name in ("C21", "C22", "C23")
)
stairs = Staircase(name="St1", levels_v=(-3.0, -4.0, -5.0, -6.0, -5.0, -4.0, -3.0), dwell_s=60.0, start_s=60.0)
test = Campaign(
    name="Long chirp",
    duration_s=thesis.duration_s - EARLIER_S,
    offset_v=thesis.offset_v,
    staircases=(stairs,),
    chirps=chirps,
)

with TemporaryDirectory() as folder:
    path = Path(folder) / "long_chirp.nc"
    truth = sail(tug, test, path, seed=4)
    with read_recording(path) as raw:
        signals = prepare_signals(raw, tug, test)

# several excitations in one pair of brackets become one record, as the thesis merges them
(record,) = records_of(signals, test, [("C21", "C22", "C23")])
print(f"{record.name}: {record.samples} samples at {record.rate_hz:g} Hz")

# CL2 is the structure of CL1 fitted to the long chirp; what is known of the gauge-aware loop comes from the vessel file
gauge = structure("GAUGE-CLOSED")
priors = priors_from_vessel(gauge, tug, signals.working_point)
fits = {
    "CL2": identify_chirp(structure("CL1"), record, rng=np.random.default_rng(1)),
    "CL4": identify_chirp(structure("CL4"), record, rng=np.random.default_rng(1)),
    "GAUGE-CLOSED": identify_chirp(gauge, record, rng=np.random.default_rng(1), settings=Settings(priors=priors)),
}
for name, fit in fits.items():
    percents = ", ".join(
        f"{output} {percent:.1f} % of {fit.fit_ceiling[output]:.1f} %" for output, percent in fit.fit_percent.items()
    )
    print(f"\n{name}: FitPercent {percents}, p = {fit.p_value:.2g}")
    for estimate in fit.parameters:
        print(f"  {estimate.name:8}{estimate.value:9.4f} +/- {estimate.std:.4f} {estimate.unit}")
# At an amplitude of 0.6 V the tug is not linear any more: no linear structure explains this chirp within its noise, and
# numbers that the data hardly fix, such as t_sp, go wrong by more than their deviation. The verdict refuses the fit.
verdict = assess(fits["GAUGE-CLOSED"])
print(f"\n{verdict.reason}")
