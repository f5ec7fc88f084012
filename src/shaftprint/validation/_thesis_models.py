"""The parameter sets of the thesis, to be held against records as chapter 5.6 of the thesis does."""

from shaftprint.catalogue._thesis import structure
from shaftprint.catalogue._thesis_values import THESIS_VALUES
from shaftprint.validation._model import Model, model_of


def thesis_models() -> tuple[Model, ...]:
    """Return CL4, OL1+OL5, CL3, OL1+OL4 and the benchmark with the values that the thesis prints."""
    return tuple(model_of(structure(name), values, name=called) for called, (name, values) in THESIS_VALUES.items())
