"""Export an identified line as an FMU, run it as another program would, and hold it against shaftprint's simulation.

The line is identified from a simulated test first; replace that by `sp.fingerprint.read_fingerprint("result.json")`.
The FMU needs a C compiler called `cc` (or `pip install "shaftprint[fmu]"`). FMPy runs it here, in place of Simulink or
the Open Simulation Platform.
"""

import sys
from datetime import UTC, datetime
from pathlib import Path
from tempfile import TemporaryDirectory

import fmpy
import numpy as np

import shaftprint as sp

vessel, campaign = sp.vessel.load_vessel("stan-tug-1205"), sp.campaign.load_campaign("short")
line = sp.catalogue.structure("GAUGE-CLOSED")
with TemporaryDirectory() as folder:
    path = Path(folder) / "recording.nc"
    sp.tug.sail(vessel, campaign, path, seed=3)
    with sp.recording.read_recording(path) as recording:
        signals = sp.signals.prepare_signals(recording, vessel, campaign)
measured = sp.spectra.estimate_spectra(signals, campaign)
settings = sp.identify.Settings(priors=sp.identify.priors_from_vessel(line, vessel, signals.working_point))
fit = sp.identify.identify(line, measured.response, rng=np.random.default_rng(3), settings=settings)
fingerprint = sp.fingerprint.take_fingerprint(
    fit,
    signals=signals,
    signal_to_noise=measured.signal_to_noise,
    vessel=vessel,
    campaign=campaign,
    settings_files=(),
    now=datetime.now(UTC),
)

# ---- out ----

model = sp.export.exported_model(fingerprint)
time_s = np.arange(0.0, 10.0, 0.01)
set_point_rpm = np.where(time_s >= 1.0, 1.02, 1.0) * model.engine_speed_rpm
here = {"linux": "linux64", "win32": "win64", "darwin": "darwin64"}[sys.platform]
with TemporaryDirectory() as folder:
    written = sp.export.write_fmu(model, Path(folder) / "tug.fmu", platforms=[here])
    size_kb, step_ms = written.path.stat().st_size / 1024, 1e3 * written.internal_step_s
    print(f"{written.path.name}: {size_kb:.0f} kB, steps of {step_ms:.2g} ms")
    course = np.array(
        list(zip(time_s, set_point_rpm, strict=True)), dtype=[("time", float), ("engine_speed_set_point", float)]
    )
    ran = fmpy.simulate_fmu(
        str(written.path),
        start_values={"engine_speed_set_point": set_point_rpm[0]},
        input=course,
        stop_time=time_s[-1],
        output_interval=0.01,
        output=["engine_speed", "shaft_torque"],
    )

# ---- and beside shaftprint itself ----

held = {"n_set": set_point_rpm / model.engine_speed_rpm - 1.0}
own = sp.simulation.simulate_exactly(model.structure, model.values, time_s, held, hold=True)
own_rpm = model.engine_speed_rpm * (1.0 + own.outputs["n"])
fmu_rpm = np.interp(time_s, ran["time"], ran["engine_speed"])
print(f"engine speed goes from {fmu_rpm[0]:.1f} to {fmu_rpm[-1]:.1f} rpm, at most {fmu_rpm.max():.1f}")
print(f"largest difference from shaftprint's simulation: {np.abs(fmu_rpm - own_rpm).max():.1e} rpm")
