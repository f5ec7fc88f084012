from ._control import to_control
from ._csv import write_csv
from ._fmu import write_fmu
from ._json import write_json
from ._matlab import write_matlab
from ._model import ExportedModel, exported_model
from ._osp import write_osp
from ._ssp import write_ssv
from ._xarray import to_xarray
from .modelica._write import write_modelica

__all__ = [
    "ExportedModel",
    "exported_model",
    "to_control",
    "to_xarray",
    "write_csv",
    "write_fmu",
    "write_json",
    "write_matlab",
    "write_modelica",
    "write_osp",
    "write_ssv",
]
