"""A model for MATLAB and Octave: a data file, and a function next to it that rebuilds the objects."""

import re
from dataclasses import dataclass
from importlib.resources import files
from pathlib import Path
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.io import savemat

from shaftprint import __version__
from shaftprint.arguments import refusing_none
from shaftprint.errors import ExportError
from shaftprint.escape import matlab_comment, matlab_string, printable
from shaftprint.export._model import ExportedModel
from shaftprint.export._model_response import ModelResponse, channel_covariance, model_response
from shaftprint.export._parameter_descriptions import scaled_signal
from shaftprint.export.linear._delay_model import DelayModel, delay_model
from shaftprint.files import written_whole
from shaftprint.spectra._frequency_response import FrequencyResponse

LONGEST_NAME: Final = 63
# MATLAB keeps 116 bytes of text at the head of a file; a date would make equal models differ.
HEAD: Final = 116


@dataclass(frozen=True, kw_only=True, slots=True)
class WrittenMatlab:
    """What was written."""

    data: Path
    """The data file, MATLAB version 5."""
    script: Path
    """The function that rebuilds the objects; it must stay in the folder of the data."""


@refusing_none(ExportError)
def write_matlab(
    model: ExportedModel,
    path: str | Path,
    *,
    omega_rad_s: ArrayLike | None = None,
    measured: FrequencyResponse | None = None,
    overwrite: bool = False,
) -> WrittenMatlab:
    """Write state space with delays, frequency response and parameters with their covariances, and an ``.m`` file.

    Parameters
    ----------
    path
        Data file; the function is written next to it, its name made one that MATLAB can call.
    omega_rad_s
        Frequencies of the response [rad/s], shape (frequencies,); 0.05 to 50 rad/s if not given.
    measured
        The measured response, to be shown with that of the model.
    overwrite
        Whether earlier files are replaced.

    Raises
    ------
    ExportError
        If the model has no state space, its frequencies are wrong, or the name holds no letter or control characters.
    StructureError
        If a block of the structure has no equations in time.
    FileExistsError
        If a file exists and is not to be replaced.
    """
    data = Path(path) if Path(path).suffix == ".mat" else Path(path).with_name(f"{Path(path).name}.mat")
    if printable(data.name) != data.name:
        raise ExportError(f"{data}: expected a file name without control characters; rename it.")
    name = matlab_name(data.stem)
    script = data.with_name(f"{name}.m")
    content = _content(model, model_response(model, omega_rad_s), delay_model(model), measured)
    text = _script(name, data.name, model)
    head = f"MATLAB 5.0 MAT-file, written by shaftprint {__version__}".encode().ljust(HEAD)
    with written_whole(data, overwrite=overwrite) as one, written_whole(script, overwrite=overwrite) as two:
        savemat(str(one), {"shaftprint": content}, appendmat=False, long_field_names=True, oned_as="column")
        with one.open("r+b") as stored:
            stored.write(head)
        two.write_text(text, encoding="utf-8", newline="\n")
    return WrittenMatlab(data=data, script=script)


def matlab_name(stem: str) -> str:
    """Return a text as the name of a function in MATLAB: letters, digits and underscores, a letter first.

    Raises ExportError if it holds no letter.
    """
    name = re.sub(r"[^A-Za-z0-9_]", "_", stem)
    name = re.sub(r"^[^A-Za-z]+", "", name)[:LONGEST_NAME]
    if not name:
        raise ExportError(f"{stem}: expected a file name with a letter from A to Z, which MATLAB can call; rename it.")
    return name


def _script(name: str, data: str, model: ExportedModel) -> str:
    text = files("shaftprint.export").joinpath("templates", "rebuild.m").read_text(encoding="utf-8")
    words = {
        "NAME_UPPER": name.upper(),
        "NAME": name,
        "DATA": matlab_string(data),
        "DATA_WORDS": matlab_comment(data),
        "TITLE": matlab_comment(f"{model.title}, {model.structure.name}: {model.structure.title}{_remark(model)}"),
        "VERSION": __version__,
    }
    # in one pass: what is put in is never searched for marks again
    return re.sub(r"@([A-Z_]+)@", lambda mark: words[mark[1]], text)


def _remark(model: ExportedModel) -> str:
    return f"; {model.remark}" if model.remark else ""


def _content(
    model: ExportedModel, response: ModelResponse, linear: DelayModel, measured: FrequencyResponse | None
) -> dict[str, Any]:
    content: dict[str, Any] = {
        "title": printable(model.title),
        # Octave counts bytes where the file counts letters, and would cut a title that is not in ASCII
        "title_utf8": np.frombuffer(printable(model.title).encode(), dtype=np.uint8),
        "structure": model.structure.name,
        "structure_title": model.structure.title,
        "remark": printable(model.remark),
        "version": __version__,
        "working_point": {
            "engine_speed_rpm": model.engine_speed_rpm,
            "shaft_torque_nm": model.shaft_torque_nm,
        },
        "inputs": _signals(model, linear.inputs),
        "outputs": _signals(model, linear.outputs),
        "linear": _linear(linear),
        "parameters": _parameters(model),
        "response": {
            "omega_rad_s": response.omega_rad_s,
            "H": response.response,
            "covariance": response.channel_covariance,
            "full_covariance": np.moveaxis(response.covariance, 0, -1),
        },
    }
    return content | ({} if measured is None else {"measured": _measured(measured)})


def _signals(model: ExportedModel, names: tuple[str, ...]) -> dict[str, Any]:
    """Return names, and what a deviation of 1 stands for outside."""
    signals = [scaled_signal(model, name) for name in names]
    return {
        "names": _cell(names),
        "meanings": _cell([scaled.signal.meaning for scaled in signals]),
        "units": _cell([scaled.signal.unit for scaled in signals]),
        "scale": np.array([scaled.scale for scaled in signals]),
        "offset": np.array([scaled.offset for scaled in signals]),
    }


def _linear(linear: DelayModel) -> dict[str, Any]:
    return {
        "A": linear.a,
        "B": linear.b,
        "C": linear.c,
        "D": linear.d,
        "tau_s": linear.tau_s,
        "output_delay_s": linear.shift_s,
        "states": _cell(linear.states),
        "count_inputs": float(len(linear.inputs)),
        "count_outputs": float(len(linear.outputs)),
    }


def _parameters(model: ExportedModel) -> dict[str, Any]:
    std = model.std
    parameters = model.structure.parameters
    return {
        "names": _cell([p.name for p in parameters]),
        "units": _cell([p.unit for p in parameters]),
        "meanings": _cell([p.meaning for p in parameters]),
        "values": model.values,
        "std": np.array([std.get(p.name, np.nan) for p in parameters]),
        "uncertain": _cell(model.uncertain),
        "covariance": model.covariance_matrix,
        "not_known": _cell(model.not_known),
    }


def _measured(measured: FrequencyResponse) -> dict[str, Any]:
    return {
        "omega_rad_s": measured.omega_rad_s,
        "H": measured.response,
        "covariance": channel_covariance(measured.covariance, len(measured.outputs)),
        "full_covariance": np.moveaxis(measured.covariance, 0, -1),
        "inputs": _cell(measured.inputs),
        "outputs": _cell(measured.outputs),
        "lines": _cell(measured.lines),
        "used": measured.used,
    }


def _cell(texts: tuple[str, ...] | list[str]) -> NDArray[np.object_]:
    """Return texts as what becomes a column of a cell array."""
    cell = np.empty((len(texts), 1), dtype=object)
    cell[:, 0] = texts
    return cell
