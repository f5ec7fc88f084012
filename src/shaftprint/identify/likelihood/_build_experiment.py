"""From a structure and a response to a part of the likelihood."""

from collections.abc import Sequence

import numpy as np

from shaftprint.arrays import BoolArray
from shaftprint.errors import IdentificationError
from shaftprint.identify.likelihood._experiment import Experiment, elements_of
from shaftprint.identify.likelihood._fitted_response import channels_of
from shaftprint.identify.likelihood._load_factors import load_factors
from shaftprint.identify.likelihood._weighting import Weighting
from shaftprint.models._structure import Structure
from shaftprint.spectra._frequency_response import FrequencyResponse


def build_experiment(
    structure: Structure,
    response: FrequencyResponse,
    *,
    weighting: Weighting,
    lines: Sequence[str] | None,
) -> Experiment:
    """Return the part of the likelihood that one response gives, in an objective of its own.

    Raises IdentificationError if input or outputs differ or a line is not in the response.
    """
    reduced = _of_structure(structure, response)
    fitted = _fitted_lines(reduced, lines)
    measured = channels_of(reduced)[:, fitted]
    covariance = reduced.covariance[fitted]
    weights = weighting.matrices(reduced, covariance)
    free = tuple(i for i, p in enumerate(structure.parameters) if not p.held)
    return Experiment(
        structure=structure,
        response=reduced,
        fitted=fitted,
        s=np.asarray(1j * reduced.omega_rad_s[fitted], dtype=np.complex128),
        factors=load_factors(structure, reduced, fitted),
        data=np.concatenate([measured.real, measured.imag]).T,
        measured=measured,
        covariance=covariance,
        weighting=weighting,
        weights=weights,
        tails=weighting.tails(reduced.degrees_of_freedom[fitted], covariance.shape[1]),
        elements=elements_of(weights),
        held=structure.vector({}),
        free=free,
        places=free,
        columns=tuple(range(len(free))),
    )


def _fitted_lines(response: FrequencyResponse, lines: Sequence[str] | None) -> BoolArray:
    if lines is None:
        return response.used
    unknown = [name for name in lines if name not in response.lines]
    if unknown:
        raise IdentificationError(
            f"lines {', '.join(unknown)} are not in the response; it has {', '.join(response.lines)}."
        )
    return np.array([name in lines for name in response.lines], dtype=np.bool_)


def _of_structure(structure: Structure, response: FrequencyResponse) -> FrequencyResponse:
    """Return the response of the structure's outputs."""
    outputs = tuple(structure.outputs)
    if structure.inputs != response.inputs or not set(outputs) <= set(response.outputs):
        raise IdentificationError(
            f"structure {structure.name} goes from {', '.join(structure.inputs)} to {', '.join(outputs)}, the "
            f"response from {', '.join(response.inputs)} to {', '.join(response.outputs)}: "
            + (
                "choose a structure with these channels, or convert the response with open_loop()."
                if response.inputs == ("n_set",)
                else "give both the same names."
            )
        )
    return response if outputs == response.outputs else response.of_outputs(*outputs)
