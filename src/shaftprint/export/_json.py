"""A fingerprint's model in one JSON file, for programs that know nothing of shaftprint."""

import json
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.arrays import FloatArray
from shaftprint.errors import ExportError
from shaftprint.export._model import ExportedModel, exported_model
from shaftprint.export._model_response import ModelResponse, model_response
from shaftprint.export._parameter_descriptions import scaled_signal
from shaftprint.export._tables import number_rows, parameter_rows
from shaftprint.export.linear._delay_model import DelayModel, delay_model
from shaftprint.files import written_whole
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.models._structure import Structure

LAYOUT: Final = 1


@refusing_none(ExportError)
def write_json(
    fingerprint: Fingerprint,
    path: str | Path,
    *,
    of: Structure | None = None,
    omega_rad_s: ArrayLike | None = None,
    overwrite: bool = False,
) -> Path:
    """Write parameters, combinations, state space with delays and frequency response with covariances.

    Numbers that are not known are null; the file has no infinities. It complements the fingerprint itself, which only
    shaftprint turns into a model.

    Parameters
    ----------
    path
        File to write.
    of
        The structure that was identified; the shipped one of its name if not given.
    omega_rad_s
        Frequencies of the response [rad/s], shape (frequencies,); 0.05 to 50 rad/s if not given.
    overwrite
        Whether an earlier file is replaced.

    Returns
    -------
        The file that was written.

    Raises
    ------
    ExportError
        If the structure has no state space.
    FingerprintError
        If the structure has other parameters than the fingerprint.
    StructureError
        If there is no shipped structure of that name, or a block has no equations in time.
    FileExistsError
        If the file exists and is not to be replaced.
    """
    model = exported_model(fingerprint, of=of, linear=True)
    content = {
        "layout": LAYOUT,
        "written_by": f"shaftprint {__version__}",
        "title": model.title,
        "created": fingerprint.created.isoformat(),
        "trustworthy": fingerprint.verdict.trustworthy,
        "verdict": fingerprint.verdict.reason,
        "validation": _validation(fingerprint),
        "structure": {"name": model.structure.name, "title": model.structure.title},
        "working_point": {"engine_speed_rpm": model.engine_speed_rpm, "shaft_torque_nm": model.shaft_torque_nm},
        "inputs": [_signal(model, name) for name in model.structure.inputs],
        "outputs": [_signal(model, name) for name in model.structure.outputs],
        "parameters": parameter_rows(fingerprint, model.structure),
        "covariance": {"names": list(model.uncertain), "matrix": model.covariance_matrix.tolist()},
        "not_known": list(model.not_known),
        "numbers": number_rows(fingerprint),
        "with_limits": _with_limits(fingerprint),
        "linear": _linear(delay_model(model)),
        "response": _response(model_response(model, omega_rad_s)),
    }
    json_path = Path(path)
    text = json.dumps(content, indent=1, allow_nan=False, ensure_ascii=False)
    with written_whole(json_path, overwrite=overwrite) as part:
        part.write_text(f"{text}\n", encoding="utf-8")
    return json_path


def _signal(model: ExportedModel, name: str) -> dict[str, Any]:
    """Return a signal and what a deviation of 1 stands for outside."""
    scaled = scaled_signal(model, name)
    return {
        "name": name,
        "meaning": scaled.signal.meaning,
        "unit": scaled.signal.unit,
        "scale": scaled.scale,
        "offset": scaled.offset,
    }


def _validation(fingerprint: Fingerprint) -> dict[str, Any] | None:
    """Return what the model was worth on records that its fit had not seen; None where it was held against none."""
    record = fingerprint.validation
    if record is None:
        return None
    return {
        "model": record.model,
        "outcome": record.outcome,
        "headline": record.headline,
        "stretches": {f"{one.record}, {one.title}": one.outcome for one in record.stretches},
    }


def _with_limits(fingerprint: Fingerprint) -> dict[str, Any] | None:
    """Return the line with its limits: structure, values and covariance; None where limits were not looked for."""
    line = fingerprint.with_limits
    if line is None:
        return None
    model = exported_model(fingerprint)
    return {
        "structure": {"name": model.structure.name, "title": model.structure.title},
        "limits": list(line.limits),
        "full_load_curve": [list(corner) for corner in line.curve],
        "parameters": dict(zip(model.structure.names, model.values.tolist(), strict=True)),
        "covariance": {"names": list(model.uncertain), "matrix": model.covariance_matrix.tolist()},
        "not_known": list(model.not_known),
        "not_seen": list(line.not_seen),
    }


def _linear(linear: DelayModel) -> dict[str, Any]:
    return {
        "form": "dx/dt = A x + B [u; w], [y; z] = C x + D [u; w], w(t) = z(t - tau), outputs y(t - shift)",
        "states": list(linear.states),
        "A": linear.a.tolist(),
        "B": linear.b.tolist(),
        "C": linear.c.tolist(),
        "D": linear.d.tolist(),
        "tau_s": linear.tau_s.tolist(),
        "shift_s": linear.shift_s.tolist(),
    }


def _finite_or_null(values: FloatArray) -> Any:
    """Return nested lists with null where an input moves nothing, so that there is no level."""
    levels = values.astype(object)
    levels[~np.isfinite(values)] = None
    return levels.tolist()


def _response(modelled: ModelResponse) -> dict[str, Any]:
    return {
        "axes": ["output", "input", "frequency"],
        "omega_rad_s": modelled.omega_rad_s.tolist(),
        "real": modelled.response.real.tolist(),
        "imaginary": modelled.response.imag.tolist(),
        "magnitude_db": _finite_or_null(modelled.magnitude_db),
        "magnitude_std_db": modelled.magnitude_std_db.tolist(),
        "phase_deg": modelled.phase_deg.tolist(),
        "phase_std_deg": modelled.phase_std_deg.tolist(),
        "covariance_of_real_and_imaginary": modelled.channel_covariance.tolist(),
    }
