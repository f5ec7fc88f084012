"""The table of docs/validation.md: the simulated tug with its limits and without, held against its own linear model.

``python -m benchmarks.validation``, about three minutes.
"""

import tempfile
from pathlib import Path

import numpy as np

from shaftprint.campaign import Campaign, load_campaign
from shaftprint.catalogue import structure
from shaftprint.identify import Settings, identify, priors_from_vessel
from shaftprint.recording import read_recording
from shaftprint.signals import prepare_signals
from shaftprint.spectra import estimate_response
from shaftprint.tug import Tug, sail
from shaftprint.validation import Validation, validate
from shaftprint.vessel import Vessel, load_vessel

SEED = 1
# so much that no limit is ever reached
STRONGER, MOTORING_NM = 20.0, 1e4


def main() -> None:
    """Sail, identify, validate and print, with limits and without, with the propeller's square law and without."""
    vessel, campaign = load_vessel("stan-tug-1205"), load_campaign("thesis")
    torques = tuple(STRONGER * torque for torque in vessel.engine.full_load_torque_nm)
    strong = vessel.model_copy(update={"engine": vessel.engine.model_copy(update={"full_load_torque_nm": torques})})
    with tempfile.TemporaryDirectory() as folder:
        for name, sailed, tug in (("on", vessel, Tug()), ("off", strong, Tug(motoring_torque_nm=MOTORING_NM))):
            path = Path(folder) / f"{name}.nc"
            sail(sailed, campaign, path, tug=tug, seed=SEED)
            for square, found in _validated(path, vessel, campaign).items():
                law = "square" if square else "linear"
                print(f"\nlimits {name}, {law} law of the torque: {found.outcome}")
                _print(found)


def _validated(path: Path, vessel: Vessel, campaign: Campaign) -> dict[bool, Validation]:
    with read_recording(path) as recording:
        signals = prepare_signals(recording, vessel, campaign)
    gauge = structure("GAUGE-CLOSED")
    settings = Settings(priors=priors_from_vessel(gauge, vessel, signals.working_point))
    fit = identify(gauge, estimate_response(signals, campaign), rng=np.random.default_rng(SEED), settings=settings)
    return {
        square: validate(fit, signals, campaign, rng=np.random.default_rng(SEED), quadratic_propeller=square)
        for square in (True, False)
    }


def _print(validation: Validation) -> None:
    for comparison in validation.comparisons:
        numbers = "   ".join(
            f"{m.output:3} FitPercent {m.fit_percent:6.1f} of {m.fit_ceiling:5.1f}, missed {100.0 * m.error:5.1f} "
            f"({100.0 * m.error_interval[0]:.1f} to {100.0 * m.error_interval[1]:.1f}) %"
            for m in comparison.misfits
        )
        excerpt = comparison.excerpt
        print(f"{excerpt.record:4}{excerpt.title:30}{comparison.outcome:10}{numbers}")
    print(*validation.sentences, sep="\n")


if __name__ == "__main__":
    main()
