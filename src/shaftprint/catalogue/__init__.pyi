from ._known_propeller import KnownPropeller, with_known_propeller
from ._limited import limited
from ._limited_governor import AHEAD_S, limited_governor
from ._own_structure import chosen_structures
from ._roles import ShipRole
from ._sailing_blocks import SailingShaft, SailingSpeed, SailingTorque
from ._shipped import shipped_structure
from ._thesis import STRUCTURES, structure
from ._thesis_figures import thesis_families
from ._two_masses import two_mass_line

__all__ = [
    "AHEAD_S",
    "STRUCTURES",
    "KnownPropeller",
    "SailingShaft",
    "SailingSpeed",
    "SailingTorque",
    "ShipRole",
    "chosen_structures",
    "limited",
    "limited_governor",
    "shipped_structure",
    "structure",
    "thesis_families",
    "two_mass_line",
    "with_known_propeller",
]
