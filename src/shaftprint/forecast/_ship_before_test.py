"""The noun ``ShipBeforeTest``: what is known of a ship before a test of it is predicted, planned or simulated."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path

from shaftprint.campaign._campaign import Campaign
from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.fingerprint._fingerprint import Fingerprint
from shaftprint.fingerprint._model import structure_to_use
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.models._structure import Structure
from shaftprint.survey._fit_options import expect_free
from shaftprint.survey._of_vessel import default_structure, of_vessel
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class ShipBeforeTest:
    """What is known of a ship before a test: its files, and what is stated beside them."""

    vessel: Vessel | None = None
    """The installation; nothing is known of the ship where it is not given."""
    first_test: Fingerprint | None = None
    """What a first test found."""
    recording: Path | None = None
    """A recording of the ship, for its noise."""
    recorded: str | Campaign | None = None
    """What was asked in that recording: a campaign, its path or name."""
    slope_rpm_per_v: float | None = None
    """Change of the engine speed for one volt of set point [rpm/V]; as a campaign or test says where not given."""
    offset_v: float | None = None
    """Set point at the working point [V]."""
    priors: Mapping[str, Prior] = field(default_factory=dict)
    """What is known of parameters, instead of what the vessel file knows."""
    freed: tuple[str, ...] = ()
    """Parameters of which nothing is taken as known."""
    held: Mapping[str, float] = field(default_factory=dict)
    """Parameters that are held, and at what value."""
    values: Mapping[str, float] = field(default_factory=dict)
    """Values that are assumed, by parameter."""

    def structure(self, name: TypedName | None = None, campaign: Campaign | None = None) -> Structure:
        """Return the structure that a test is to find, with what is held in it.

        Parameters
        ----------
        name
            The structure; that of the first test, or else the closed loop that a test asks for, where not given.
        campaign
            What is asked of the ship; the set point of the speed alone where not given.

        Raises
        ------
        StructureError
            If there is no such structure or parameter.
        FingerprintError
            If the first test has a structure that is not shipped, and none is named.
        """
        if self.first_test is not None:
            chosen = structure_to_use(name, self.first_test)
        else:
            (chosen,) = chosen_structures([name or default_structure(self.vessel, campaign)])
        return (chosen if self.vessel is None else of_vessel(chosen, self.vessel)).held_at(**self.held)

    def known(self, of_vessel_file: Mapping[str, Prior]) -> dict[str, Prior]:
        """Return what is known of parameters beforehand: by the vessel file and as stated, without what is freed."""
        known = dict(of_vessel_file) | dict(self.priors)
        return {name: prior for name, prior in known.items() if name not in self.freed}

    def expect_free(self, chosen: Structure) -> None:
        """Refuse to free what is no free parameter of a structure.

        Raises
        ------
        StructureError
            If there is no such parameter.
        """
        expect_free(self.freed, [parameter.name for parameter in chosen.free])
