"""The structures that come with the package: those of the thesis, the gauge-aware ones, with limits, under way.

The language in which they are written, blocks and structures, is ``models``; symbols and signs are explained there.
"""

from shaftprint.catalogue._bent_line import with_bend
from shaftprint.catalogue._crash_stop import (
    CRASH_STOP,
    NOT_OF_THE_LINE,
    CrashStopSymbol,
    FourQuadrantPropeller,
    crash_stop,
)
from shaftprint.catalogue._drives import DRIVES, SIGNAL_MEANINGS, SIGNAL_UNITS
from shaftprint.catalogue._gauge import gauge_governor, gauge_line
from shaftprint.catalogue._hybrid_at_large import limited_hybrid
from shaftprint.catalogue._known_propeller import (
    OF_THE_SHIP,
    KnownPropeller,
    sailing_values,
    sails_free,
    with_known_propeller,
)
from shaftprint.catalogue._limited import limited
from shaftprint.catalogue._limited_governor import AHEAD_S, GovernorSymbol, limited_governor
from shaftprint.catalogue._linear_drives import along_a_line, unit_along
from shaftprint.catalogue._pitch import pitched_with_rack
from shaftprint.catalogue._roles import ROLES, ShipRole
from shaftprint.catalogue._sailing import sailing_with_rack
from shaftprint.catalogue._sailing_at_large import pitch_actuator, sailing_at_large
from shaftprint.catalogue._sailing_blocks import PitchSpeed, SailingShaft, SailingSpeed, SailingTorque
from shaftprint.catalogue._shipped import expect_roles, shipped_structure
from shaftprint.catalogue._thesis import CLOSED_LOOPS, COMBINED_LOOP, PITCHED_LOOP, STRUCTURES, structure
from shaftprint.catalogue._thesis_figures import Family, thesis_families
from shaftprint.catalogue._thesis_values import THESIS_VALUES
from shaftprint.catalogue._two_masses import two_mass_line

__all__ = [
    "AHEAD_S",
    "CLOSED_LOOPS",
    "COMBINED_LOOP",
    "CRASH_STOP",
    "DRIVES",
    "NOT_OF_THE_LINE",
    "OF_THE_SHIP",
    "PITCHED_LOOP",
    "ROLES",
    "SIGNAL_MEANINGS",
    "SIGNAL_UNITS",
    "STRUCTURES",
    "THESIS_VALUES",
    "CrashStopSymbol",
    "Family",
    "FourQuadrantPropeller",
    "GovernorSymbol",
    "KnownPropeller",
    "PitchSpeed",
    "SailingShaft",
    "SailingSpeed",
    "SailingTorque",
    "ShipRole",
    "along_a_line",
    "crash_stop",
    "expect_roles",
    "gauge_governor",
    "gauge_line",
    "limited",
    "limited_governor",
    "limited_hybrid",
    "pitch_actuator",
    "pitched_with_rack",
    "sailing_at_large",
    "sailing_values",
    "sailing_with_rack",
    "sails_free",
    "shipped_structure",
    "structure",
    "thesis_families",
    "two_mass_line",
    "unit_along",
    "with_bend",
    "with_known_propeller",
]
