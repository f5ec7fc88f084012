"""A structure as a model of Modelica (Modelica Language Specification 3.6)."""
