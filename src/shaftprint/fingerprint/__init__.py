"""The fingerprint of a propulsion line: parameters, physical values, margins and conditions, as a JSON record.

=================== =========== ==================================================================================
quantity            unit        meaning
=================== =========== ==================================================================================
``I_dn``, ``I_up``  kg m2       inertia downstream and upstream of the torque gauge, at the propeller shaft
``K_Q``             -           torque coefficient of the propeller, mean of the test
gain margin         -           factor on the loop gain that reaches instability
phase margin        deg         smallest over all crossovers
delay margin        s           smallest extra delay in the loop that reaches instability
gauge zero share    %           zero offset of the torque gauge over the working-point torque without it; positive
                                where it shows too much
=================== =========== ==================================================================================
"""

from shaftprint.fingerprint._clock_influence import NOTABLE_SHIFT, ClockInfluence, clock_findings, clock_influences
from shaftprint.fingerprint._conditions import WATER, Conditions, ShipIdentity
from shaftprint.fingerprint._drive_fingerprint import (
    DriveFingerprint,
    DriveRecord,
    DriveResponse,
    NoiseOfRecord,
    drive_fingerprint_content,
    is_of_a_drive,
    read_drive_fingerprint,
    write_drive_fingerprint,
)
from shaftprint.fingerprint._fingerprint import Fingerprint, Quality, SourceFile
from shaftprint.fingerprint._inertia import inertia_beside
from shaftprint.fingerprint._joint_numbers import JointNumbers
from shaftprint.fingerprint._json_file import (
    fingerprint_document,
    fingerprint_sha256,
    parse_fingerprint,
    read_fingerprint,
    write_fingerprint,
)
from shaftprint.fingerprint._leg_records import LegRecord, NoiseSpectrum, leg_record, noise_spectra
from shaftprint.fingerprint._line_with_limits import FoundBy, LimitNumber, LineWithLimits
from shaftprint.fingerprint._margin_numbers import margin_numbers
from shaftprint.fingerprint._margins import margin_quantities
from shaftprint.fingerprint._model import IdentifiedModel, identified_model, model_with_limits, named_structure
from shaftprint.fingerprint._physical import GAUGE_ZERO, physical_numbers, physical_quantities
from shaftprint.fingerprint._quantity import Quantity
from shaftprint.fingerprint._take import take_fingerprint
from shaftprint.fingerprint._validation_record import StretchRecord, ValidationRecord
from shaftprint.fingerprint._vessel_fields import BEHIND, TVC, FieldValue, stated_behind, vessel_fields

__all__ = [
    "BEHIND",
    "GAUGE_ZERO",
    "NOTABLE_SHIFT",
    "TVC",
    "WATER",
    "ClockInfluence",
    "Conditions",
    "DriveFingerprint",
    "DriveRecord",
    "DriveResponse",
    "FieldValue",
    "Fingerprint",
    "FoundBy",
    "IdentifiedModel",
    "JointNumbers",
    "LegRecord",
    "LimitNumber",
    "LineWithLimits",
    "NoiseOfRecord",
    "NoiseSpectrum",
    "Quality",
    "Quantity",
    "ShipIdentity",
    "SourceFile",
    "StretchRecord",
    "ValidationRecord",
    "clock_findings",
    "clock_influences",
    "drive_fingerprint_content",
    "fingerprint_document",
    "fingerprint_sha256",
    "identified_model",
    "inertia_beside",
    "is_of_a_drive",
    "leg_record",
    "margin_numbers",
    "margin_quantities",
    "model_with_limits",
    "named_structure",
    "noise_spectra",
    "parse_fingerprint",
    "physical_numbers",
    "physical_quantities",
    "read_drive_fingerprint",
    "read_fingerprint",
    "stated_behind",
    "take_fingerprint",
    "vessel_fields",
    "write_drive_fingerprint",
    "write_fingerprint",
]
