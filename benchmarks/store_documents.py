"""Fingerprint files written by hand, for what keeps them: numbers that are stated, and the size of a real one."""

import json
import random

KINDS = {"parameters": 12, "combinations": 4, "physical": 6, "margins": 3, "calibration": 7}
"""How many numbers of each kind a ship has."""
PHYSICAL = {"I_dn": ("kg m2", 17.0, 0.34), "I_up": ("kg m2", 54.0, 3.7), "K_Q": ("-", 0.0494, 0.001)}
IMO_NUMBER = 9074729
"""The example of IMO resolution A.1117(30): 9 * 7 + 0 * 6 + 7 * 5 + 4 * 4 + 7 * 3 + 2 * 2 = 139."""


def quantity(name: str, unit: str, value: float, std: float) -> dict[str, object]:
    """Return a number with its interval to first order left to the reader."""
    return {"name": name, "unit": unit, "value": value, "std": std, "meaning": "a number written by hand"}


def document(
    *,
    tested_at: str | None = "2026-03-13T14:05:00+01:00",
    created: str = "2026-03-14T09:30:00Z",
    recording: str | None = "ab" * 32,
    ship: dict[str, object] | None = None,
    k_q: float = 0.0494,
    filling: int = 0,
    seed: int = 0,
    **conditions: object,
) -> bytes:
    """Return the content of a fingerprint file.

    Parameters
    ----------
    tested_at, created, recording, ship, conditions
        What it states; None is not stated.
    k_q
        Torque coefficient, with a standard deviation of 0.001.
    filling
        Fields of the vessel file, some 40 bytes each, which give it the size of a real one.
    seed
        Where its other numbers begin.
    """
    rng = random.Random(seed)  # noqa: S311
    numbers = {
        kind: [quantity(f"{kind[:2]}_{place}", "-", rng.gauss(1.0, 0.1), 0.1) for place in range(count)]
        for kind, count in KINDS.items()
    }
    stated = PHYSICAL | {"K_Q": ("-", k_q, 0.001)}
    numbers["physical"][: len(stated)] = [quantity(name, *rest) for name, rest in stated.items()]
    names = [str(one["name"]) for kind in numbers.values() for one in kind]
    sources = [{"role": "vessel", "name": "tug.toml", "sha256": "cd" * 32}]
    if recording is not None:
        sources.insert(0, {"role": "recording", "name": "log.nc", "sha256": recording})
    count = KINDS["parameters"]
    content = {
        "schema_version": "2.2",
        "shaftprint_version": "0.1.0",
        "created": created,
        "sources": sources,
        "conditions": {
            "vessel": "a tug",
            "campaign": "a test",
            "tested_at": tested_at,
            "ship": ship,
            "engine_speed": quantity("n_0", "rpm", 1183.8, 0.6),
            "shaft_torque": quantity("M_s0", "N m", 1725.0, 8.0),
            "set_point_v": -5.0,
            "speed_channel": "n_e",
            "mode": "shaftprint",
            "lines_used": ["S1"],
            "lines_left_out": {},
        }
        | conditions,
        "structure": "GAUGE-CLOSED",
        "held": {},
        "priors": {},
        # standard deviations of 0.1
        "covariance": [[0.01 if i == j else 0.0 for j in range(count)] for i in range(count)],
        "budget": {"sources": [], "rows": []},
        "vessel_fields": {f"part.{place}.inertia_kg_m2": rng.random() for place in range(filling)},
        "quality": {
            "weighting": "MaximumLikelihood",
            **{key: {} for key in ("fit_percent", "fit_ceiling", "snr_overall", "snr_local_db", "repairs")},
            "chi_square": 45.0,
            "p_value": 0.5,
            "degrees_of_freedom": 45,
            "starts": 20,
            "starts_at_optimum": 3,
            "remarks": [],
        },
        "verdict": {
            "trustworthy": True,
            "reason": "The fit can be trusted.",
            "sentences": ["The fit can be trusted."],
            "trusted": [name for name in names if name != "I_up"],
            "not_trusted": {"I_up": "it is mostly its prior"},
            "loop": "ample",
        },
        "findings": [],
    } | numbers
    return json.dumps(content, indent=2).encode()
