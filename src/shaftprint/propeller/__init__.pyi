from ._four_quadrants import four_quadrants
from ._ka4_70 import ka4_70_in_19a
from ._open_water import OpenWaterCurve
from ._steady_sailing import sail_steadily
from ._wageningen_b import wageningen_b

__all__ = [
    "OpenWaterCurve",
    "four_quadrants",
    "ka4_70_in_19a",
    "sail_steadily",
    "wageningen_b",
]
