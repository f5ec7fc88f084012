from ._clock_influence import ClockInfluence
from ._conditions import ShipIdentity
from ._fingerprint import Fingerprint
from ._inertia import inertia_beside
from ._json_file import read_drive_fingerprint, read_fingerprint, write_fingerprint
from ._line_fingerprint import SourceFile
from ._physical import physical_quantities
from ._take import take_fingerprint
from ._vessel_fields import vessel_fields

__all__ = [
    "ClockInfluence",
    "Fingerprint",
    "ShipIdentity",
    "SourceFile",
    "inertia_beside",
    "physical_quantities",
    "read_drive_fingerprint",
    "read_fingerprint",
    "take_fingerprint",
    "vessel_fields",
    "write_fingerprint",
]
