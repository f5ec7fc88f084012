"""The identified model in the user's tool.

=================== ======= =============================================================================
quantity            unit    meaning and sign
=================== ======= =============================================================================
engine speed        rpm     working-point speed times one plus the deviation ``n``; its set point alike
shaft torque        N m     at the gauge, working-point torque times one plus ``M_s``; positive when driving
others              -       deviations, as in ``shaftprint.models``
=================== ======= =============================================================================
"""

from shaftprint.export._control import ControlModel, to_control
from shaftprint.export._csv import WrittenTables, write_csv
from shaftprint.export._fmu import WrittenFmu, write_fmu
from shaftprint.export._fmu_build import PLATFORMS, host_platform
from shaftprint.export._json import write_json
from shaftprint.export._matlab import WrittenMatlab, write_matlab
from shaftprint.export._model import ExportedModel, exported_model, validation_remark
from shaftprint.export._osp import write_osp
from shaftprint.export._ssp import write_ssv
from shaftprint.export._xarray import to_xarray
from shaftprint.export.modelica import WrittenModelica, write_modelica

__all__ = [
    "PLATFORMS",
    "ControlModel",
    "ExportedModel",
    "WrittenFmu",
    "WrittenMatlab",
    "WrittenModelica",
    "WrittenTables",
    "exported_model",
    "host_platform",
    "to_control",
    "to_xarray",
    "validation_remark",
    "write_csv",
    "write_fmu",
    "write_json",
    "write_matlab",
    "write_modelica",
    "write_osp",
    "write_ssv",
]
