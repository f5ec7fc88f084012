"""Files of a planned test: the plan itself, its campaign, and its set point for generators and MATLAB."""

from shaftprint.design.files._plan_folder import CAMPAIGN, write_plan_files
from shaftprint.design.files._plan_json import PLAN, read_plan, write_plan
from shaftprint.design.files._set_point_files import CSV, GENERATOR, MAT
from shaftprint.design.files._set_point_samples import RATE_HZ, SetPointSamples, set_point_samples

__all__ = [
    "CAMPAIGN",
    "CSV",
    "GENERATOR",
    "MAT",
    "PLAN",
    "RATE_HZ",
    "SetPointSamples",
    "read_plan",
    "set_point_samples",
    "write_plan",
    "write_plan_files",
]
