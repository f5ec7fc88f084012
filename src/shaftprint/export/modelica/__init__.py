"""A structure as a model of Modelica (Modelica Language Specification 3.6)."""

from shaftprint.export.modelica._expressions import modelica_name, modelica_number
from shaftprint.export.modelica._write import WrittenModelica, modelica_text, write_modelica

__all__ = [
    "WrittenModelica",
    "modelica_name",
    "modelica_number",
    "modelica_text",
    "write_modelica",
]
