"""Fingerprints of a drive that nobody tested: three numbers with a stated covariance, drawn about a truth."""

import json
from datetime import UTC, datetime

import numpy as np

TRUTH = {"R": 0.8, "J": 1.4e-3, "d": 4e-4}
UNITS = {"R": "ohm", "J": "kg m2", "d": "N m s/rad"}
SHARE = np.array([0.001, 0.002, 0.02])
"""Standard deviations, as shares."""
CORRELATION = np.array([[1.0, 0.3, 0.0], [0.3, 1.0, -0.5], [0.0, -0.5, 1.0]])


def drive_document(month, rng, *, drive="bench motor", stated=True, recording=None, **truth):
    """Return the file of a fingerprint of a test in a month of 2026, whose numbers are drawn about a truth."""
    values = np.array(list((TRUTH | truth).values()))
    std = SHARE * values
    covariance = np.outer(std, std) * CORRELATION
    drawn = rng.multivariate_normal(values, covariance)
    numbers = [
        {
            "name": name,
            "unit": UNITS[name],
            "value": value,
            "std": deviation,
            "interval_95": [value - 1.96 * deviation, value + 1.96 * deviation],
            "meaning": name,
        }
        for name, value, deviation in zip(TRUTH, drawn.tolist(), std.tolist(), strict=True)
    ]
    at = datetime(2026, month, 10, 9, tzinfo=UTC)
    content = {
        "kind": "drive",
        "schema_version": "drive 1.3",
        "shaftprint_version": "0.1.0",
        "created": at.isoformat(),
        "tested_at": at.isoformat() if stated else None,
        "sources": [{"role": "recording", "name": "run.csv", "sha256": recording or f"{month:064x}"}],
        "drive": drive,
        "structure": "LOADED-MOTOR",
        "inputs": {"u": "V"},
        "outputs": {"omega": "rad/s"},
        "parameters": numbers,
        "held": {},
        "priors": {},
        "covariance": covariance.tolist(),
        "joint": {"names": list(TRUTH), "own_covariance": covariance.tolist(), "loadings": {}},
        "combinations": [],
        "records": [],
        "p_value": 0.5,
        "starts": 4,
        "starts_at_optimum": 4,
        "verdict": {
            "trustworthy": True,
            "reason": "",
            "sentences": [],
            "trusted": list(TRUTH),
            "not_trusted": {},
            "loop": None,
            "suspects": [],
            "cautions": [],
            "reasons": [],
            "assumptions": [],
        },
    }
    return json.dumps(content).encode()
