"""What ordinary service tells of ships of any size, of which a card alone is known: a sentence of docs/service.md.

Power, speeds, propeller, logger and lever are drawn and go into ``shaftprint new vessel``; the ship differs from its
card, and its governor from any other. Its logs are scanned and fitted as they are, without a fingerprint to begin from.
Run ``python benchmarks/service_ships.py --seeds 16 --hours 3 --outcomes FOLDER``; outcomes that the folder holds are
not made again. With ``--write`` the sentence goes into the document. A ship of three hours takes 30 s of a processor.
"""

import argparse
import sys
import tempfile
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from click.testing import CliRunner

ROOT = Path(__file__).resolve().parent.parent
# Run as a file, the folder of the benchmarks is on the path, not the one above.
sys.path.insert(0, str(ROOT))

from benchmarks.kept_outcomes import kept
from benchmarks.result_tables import write_between_marks
from benchmarks.service import add_options, said_of, true_numbers
from shaftprint.cli import shaftprint
from shaftprint.distributions import NORMAL_95
from shaftprint.service._model import OVER_TORQUE
from shaftprint.tug import Tug, sail_service
from shaftprint.tug._like_stan_tug import like_stan_tug_1205
from shaftprint.vessel import load_vessel
from shaftprint.vessel._vessel import Vessel

DOCUMENT = ROOT / "docs" / "service.md"
BEGIN, END = (
    "<!-- sentence of benchmarks/service_ships.py: begin -->",
    "<!-- sentence of benchmarks/service_ships.py: end -->",
)
_PERCENT = 100.0


def card(rng: np.random.Generator) -> list[str]:
    """Return the options of ``shaftprint new vessel`` for some ship, whose propeller takes 0.9 to 1.4 of the power."""
    rated_rpm = float(rng.choice([520, 750, 1000, 1200, 1500, 1800, 2100]))
    power_kw = float(np.exp(rng.uniform(np.log(300.0), np.log(5000.0))))
    propeller_rpm = float(np.clip(rated_rpm / rng.uniform(2.0, 6.0), 100.0, 450.0))
    pitch_ratio = float(rng.uniform(0.75, 1.1))
    turns_s, coefficient = propeller_rpm / 60.0, 0.04 * pitch_ratio / 0.9
    torque_nm = 1e3 * power_kw / (2.0 * np.pi * turns_s) * rng.uniform(0.9, 1.4)
    diameter_m = float((torque_nm / (coefficient * 1025.0 * turns_s**2)) ** 0.2)
    unit = str(rng.choice(["rpm", "%"]))
    lever = {
        "rpm": ["0=0", f"{rated_rpm:g}={rated_rpm:g}"],
        "%": [f"0={0.33 * rated_rpm:.0f}", f"100={rated_rpm:.0f}"],
    }[unit]
    return [
        *("--power-kw", f"{power_kw:.0f}", "--rated-rpm", f"{rated_rpm:g}"),
        *("--cylinders", str(int(rng.choice([6, 8, 12, 16]))), "--diameter-m", f"{diameter_m:.2f}", "--blades", "4"),
        *("--pitch-ratio", f"{pitch_ratio:.2f}", "--ratio", f"{rated_rpm / propeller_rpm:.3f}"),
        *("--sample-rate", str(int(rng.choice([20, 50, 100]))), "--engine-speed", "n_e"),
        *("--lever-unit", unit, "--set-point", "lever", "--lever", lever[0], "--lever", lever[1]),
    ]


def drawn(vessel: Vessel, rng: np.random.Generator) -> Tug:
    """Return the truth of a ship of which its card is a guess."""

    def about(value: float, spread: float) -> float:
        return float(value * np.exp(spread * rng.standard_normal()))

    usual = like_stan_tug_1205(vessel)
    return replace(
        usual,
        proportional_gain=about(usual.proportional_gain, 0.3),
        integral_gain_per_s=about(usual.integral_gain_per_s, 0.3),
        governor_delay_s=about(0.06, 0.3),
        natural_frequency_rad_s=about(11.0, 0.25),
        damping_ratio=about(0.55, 0.2),
        set_point_latency_s=about(0.05, 0.4),
        inertia_upstream_kg_m2=about(vessel.inertia_upstream_kg_m2, 0.15),
        inertia_downstream_kg_m2=about(vessel.inertia_downstream_kg_m2, 0.1),
        g=float(0.2 * rng.standard_normal()),
    )


def outcome(seed: int, hours: float) -> dict[str, Any]:
    """Return what some hours of one ship tell, beside its truth."""
    rng = np.random.default_rng((seed, 14))
    words = card(rng)
    with tempfile.TemporaryDirectory() as place:
        file = Path(place) / "ship.toml"
        made = CliRunner().invoke(shaftprint, ["new", "vessel", str(file), *words], catch_exceptions=False)
        if made.exit_code:
            raise RuntimeError(made.output)
        vessel = load_vessel(file)
        files, truth = sail_service(vessel, Path(place) / "logs", hours=hours, seed=seed, tug=drawn(vessel, rng))
        said, day = said_of(files, vessel, Path(place))
    said |= {"seed": seed, "hours": hours, "card": " ".join(words)}
    if day is None:
        return said
    found = day.fingerprint
    load = found.conditions.shaft_torque.value / vessel.working_point.driving_torque_nm
    true = true_numbers(truth)
    scaled = {name: value / (load if name in OVER_TORQUE else 1.0) for name, value in true.items()}
    return said | {
        "z": {one.name: (one.value - scaled[one.name]) / one.std for one in found.parameters},
        "trusted": list(found.verdict.trusted),
    }


def report(outcomes: Sequence[Mapping[str, Any]]) -> str:
    """Return what was found of all ships, in sentences."""
    fitted = [one for one in outcomes if "z" in one]
    refused = [one["refused"] for one in outcomes if "refused" in one]
    z = np.array([list(one["z"].values()) for one in fitted])
    held = np.abs(z) < NORMAL_95
    trusted = [value for one in fitted for name, value in one["z"].items() if name in one["trusted"]]
    outside = np.mean(np.abs(trusted) > NORMAL_95)
    text = (
        f"{len(outcomes)} ships of 300 to 5000 kW, of which only a card is known, {outcomes[0]['hours']:g} hours each: "
        f"{len(fitted)} fitted, and {_PERCENT * held.mean():.0f} % of {held.size} intervals hold (rms z "
        f"{np.sqrt(np.mean(z**2)):.2f}); of the numbers that are trusted {_PERCENT * outside:.0f} % lie outside."
    )
    return text + "".join(f" Refused: {one}" for one in refused)


def main() -> None:
    """Make what is missing, and print the sentence."""
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, seeds=16)
    options = parser.parse_args()
    options.outcomes.mkdir(parents=True, exist_ok=True)
    outcomes = []
    for seed in range(options.first, options.first + options.seeds):
        path = options.outcomes / f"ship-{seed}-{options.hours:g}h.json"
        outcomes.append(kept(path, lambda seed=seed: outcome(seed, options.hours)))
        print(seed, outcomes[-1].get("refused") or {k: round(v, 1) for k, v in outcomes[-1]["z"].items()}, flush=True)
    text = report(outcomes)
    print(text)
    if options.write:
        write_between_marks(DOCUMENT, text, BEGIN, END)


if __name__ == "__main__":
    main()
