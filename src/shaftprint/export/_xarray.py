"""A model as labelled arrays of xarray."""

from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from shaftprint.export._model import ExportedModel, exported_model
from shaftprint.export._model_response import model_response
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.notebook._library import library

if TYPE_CHECKING:
    from xarray import Dataset


def to_xarray(model: ExportedModel | Fingerprint, omega_rad_s: ArrayLike | None = None) -> "Dataset":
    """Return response, its uncertainty, parameters and their covariance as a dataset.

    Parameters
    ----------
    model
        The model, or the fingerprint of a shipped structure.
    omega_rad_s
        Frequencies [rad/s], shape (frequencies,); 0.05 to 50 rad/s if not given.

    Returns
    -------
        ``response`` with standard deviations of magnitude and phase over output, input and ``omega``; ``value`` and
        ``std`` over ``parameter``; ``covariance`` over ``uncertain`` and ``uncertain_too``.

    Raises
    ------
    ExportError
        If xarray is missing, or the frequencies are not positive and ascending.
    """
    xarray = library("xarray", "to_xarray")
    model = exported_model(model, linear=True) if isinstance(model, Fingerprint) else model
    modelled, std = model_response(model, omega_rad_s), model.std
    axes = ("output", "input", "omega")
    names = list(model.structure.names)
    dataset: Dataset = xarray.Dataset(
        {
            "response": (
                axes,
                np.array(modelled.response),
                {"long_name": "output over input, both over the working point"},
            ),
            "magnitude_std": (axes, modelled.magnitude_std_db, {"units": "dB"}),
            "phase_std": (axes, modelled.phase_std_deg, {"units": "deg"}),
            "value": ("parameter", np.array(model.values)),
            "std": ("parameter", np.array([std.get(name, np.nan) for name in names])),
            "covariance": (("uncertain", "uncertain_too"), np.array(model.covariance_matrix)),
        },
        coords={
            "output": list(modelled.outputs),
            "input": list(modelled.inputs),
            "omega": ("omega", np.array(modelled.omega_rad_s), {"units": "rad/s", "long_name": "angular frequency"}),
            "parameter": names,
            "unit": ("parameter", [parameter.unit for parameter in model.structure.parameters]),
            "meaning": ("parameter", [parameter.meaning for parameter in model.structure.parameters]),
            "uncertain": list(model.uncertain),
            "uncertain_too": list(model.uncertain),
        },
        attrs={
            "title": model.title,
            "structure": model.structure.name,
            "engine_speed_rpm": model.engine_speed_rpm,
            "shaft_torque_nm": model.shaft_torque_nm,
            "not_known": list(model.not_known),
        },
    )
    return dataset
