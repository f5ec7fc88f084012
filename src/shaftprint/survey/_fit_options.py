"""The noun ``FitOptions``: what is chosen of how structures are fitted, and known of their parameters beforehand."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.errors import StructureError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.likelihood._weighting import MaximumLikelihood, Unweighted
from shaftprint.identify.search._settings import Settings
from shaftprint.models._structure import Structure
from shaftprint.signals._clock import Mode
from shaftprint.spelling import meant
from shaftprint.survey._fits import priors_of
from shaftprint.survey._measurement import Measurement, pairs_of
from shaftprint.survey._of_vessel import of_vessel
from shaftprint.survey._survey import SettingsOf
from shaftprint.survey._trial import Trial
from shaftprint.vessel._vessel import Vessel


@dataclass(frozen=True, kw_only=True, slots=True)
class FitOptions:
    """What is chosen of how to fit."""

    priors: Mapping[str, Prior] = field(default_factory=dict)
    """What is known beforehand, by parameter, instead of what the vessel file knows."""
    freed: tuple[str, ...] = ()
    """Parameters of which nothing is taken as known."""
    held: Mapping[str, float] = field(default_factory=dict)
    """Parameters that are held, and at what value."""
    mode: Mode = "shaftprint"
    """How signals and lines are prepared."""
    unweighted: bool = False
    """Whether all lines are weighed alike."""
    starts: int = 50
    """Number of starts of each search."""
    seed: int = 1
    """Seed of the starts."""

    def structures(self, names: Sequence[TypedName], vessel: Vessel) -> tuple[Structure, ...]:
        """Return the structures that the user names as they are fitted for a ship, with what is held in them.

        Raises
        ------
        StructureError
            If there is no such structure, or a parameter that is held or freed is in none of them.
        """
        return self.holding([of_vessel(one, vessel) for one in chosen_structures(names)])

    def holding(self, chosen: Sequence[Structure]) -> tuple[Structure, ...]:
        """Return structures with what is held in those that have it; each name given must be of use in one.

        Raises
        ------
        StructureError
            If a parameter that is held or freed is in none of them.
        """
        unused = [name for name in self.held if not any(name in structure.names for structure in chosen)]
        if unused:
            raise StructureError(
                f"--hold {', '.join(unused)}: expected a parameter of {', '.join(one.name for one in chosen)}, "
                f"which have {', '.join(sorted({name for structure in chosen for name in structure.names}))}."
                f"{meant(unused[0], (name for structure in chosen for name in structure.names))}"
            )
        structures = tuple(
            structure.held_at(**{name: value for name, value in self.held.items() if name in structure.names})
            for structure in chosen
        )
        expect_free(self.freed, sorted(_free_names(structures)))
        return structures

    def settings(self, structures: Sequence[Structure]) -> SettingsOf:
        """Return what gives how a structure is fitted: with the vessel file's priors and what the user states.

        The function that is returned takes a structure, the measurement and the trial.
        """

        def settings(chosen: Structure, measurement: Measurement, trial: Trial) -> Settings:
            # refused before anything is fitted, if the recording does not give what the structure describes
            pairs_of(chosen, measurement)
            stated = _stated(chosen, structures, self.priors)
            priors = priors_of(chosen, trial.vessel, measurement.signals, stated)
            return Settings(
                weighting=Unweighted() if self.unweighted else MaximumLikelihood(),
                starts=self.starts,
                priors={name: prior for name, prior in priors.items() if name not in self.freed},
            )

        return settings


def _stated(chosen: Structure, structures: Sequence[Structure], stated: Mapping[str, Prior]) -> dict[str, Prior]:
    """Return the priors that concern a structure; one that no structure has is passed on, to be refused."""
    free, anywhere = _free_names([chosen]), _free_names(structures)
    return {name: prior for name, prior in stated.items() if name in free or name not in anywhere}


def _free_names(structures: Sequence[Structure]) -> set[str]:
    return {parameter.name for structure in structures for parameter in structure.free}


def expect_free(freed: Sequence[str], free: Sequence[str]) -> None:
    """Refuse to free what is no free parameter of a structure.

    Raises StructureError if one of ``freed`` is none of ``free``.
    """
    unknown = [name for name in freed if name not in free]
    if unknown:
        expected = f"expected a free parameter, one of {', '.join(free)}.{meant(unknown[0], free)}"
        raise StructureError(f"--free {', '.join(unknown)}: {expected}")
