"""The options of the commands that fit structures: which, what is known, how they are weighed and searched."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import click

from shaftprint.catalogue._own_structure import TypedName, chosen_structures
from shaftprint.cli._gathered_options import gathered_options
from shaftprint.cli._known_values import hold_option, prior_option
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

_OPTIONS = (
    prior_option,
    click.option(
        "--free",
        "freed",
        metavar="NAME",
        multiple=True,
        help="Take nothing as known of a parameter, such as tau_up, of which the vessel file knows the inertia.",
    ),
    hold_option,
    click.option(
        "--mode",
        type=click.Choice(["shaftprint", "thesis"]),
        default="shaftprint",
        show_default=True,
        help="How signals and lines are prepared; the thesis' way is there to compare.",
    ),
    click.option("--unweighted", is_flag=True, help="Weigh all lines alike, as the thesis did; intervals are wider."),
    click.option("--starts", type=click.IntRange(min=1), default=50, show_default=True, help="Starts of each search."),
    click.option("--seed", type=click.IntRange(min=0), default=1, show_default=True, help="Seed of the starts."),
)


@dataclass(frozen=True, kw_only=True, slots=True)
class FitOptions:
    """What a user chose of how to fit."""

    priors: tuple[tuple[str, Prior], ...]
    """What is known beforehand, by parameter."""
    freed: tuple[str, ...]
    """Parameters of which nothing is taken as known."""
    held: tuple[tuple[str, float], ...]
    """Parameters that are held, and at what value."""
    mode: Mode
    """How signals and lines are prepared."""
    unweighted: bool
    """Whether all lines are weighed alike."""
    starts: int
    """Number of starts of each search."""
    seed: int
    """Seed of the starts."""


def fit_options(command: Callable[..., Any]) -> Callable[..., Any]:
    """Add ``--prior``, ``--free``, ``--hold``, ``--mode``, ``--unweighted``, ``--starts`` and ``--seed``.

    The command takes them as one ``options``, a ``FitOptions``.
    """
    return gathered_options(FitOptions, _OPTIONS)(command)


def structures_of(names: Sequence[TypedName], options: FitOptions, vessel: Vessel) -> tuple[Structure, ...]:
    """Return the structures that the user names as they are fitted for a ship, with what is held in them.

    Raises
    ------
    StructureError
        If there is no such structure, or a parameter that is held or freed is in none of them.
    """
    return held_structures([of_vessel(one, vessel) for one in chosen_structures(names)], options)


def held_structures(chosen: Sequence[Structure], options: FitOptions) -> tuple[Structure, ...]:
    """Return structures with what is held in those that have it; each name given must be of use in one.

    Raises
    ------
    StructureError
        If a parameter that is held or freed is in none of them.
    """
    held = dict(options.held)
    unused = [name for name in held if not any(name in structure.names for structure in chosen)]
    if unused:
        raise StructureError(
            f"--hold {', '.join(unused)}: expected a parameter of {', '.join(structure.name for structure in chosen)}, "
            f"which have {', '.join(sorted({name for structure in chosen for name in structure.names}))}."
            f"{meant(unused[0], (name for structure in chosen for name in structure.names))}"
        )
    structures = tuple(
        structure.held_at(**{name: value for name, value in held.items() if name in structure.names})
        for structure in chosen
    )
    anywhere = _free_names(structures)
    unknown = [name for name in options.freed if name not in anywhere]
    if unknown:
        raise StructureError(
            f"--free {', '.join(unknown)}: expected a free parameter, one of {', '.join(sorted(anywhere))}."
            f"{meant(unknown[0], anywhere)}"
        )
    return structures


def settings_of(structures: Sequence[Structure], options: FitOptions) -> SettingsOf:
    """Return what gives how a structure is fitted: with the vessel file's priors and what the user states.

    The function that is returned takes a structure, the measurement and the trial.
    """

    def settings(chosen: Structure, measurement: Measurement, trial: Trial) -> Settings:
        # refused before anything is fitted, if the recording does not give what the structure describes
        pairs_of(chosen, measurement)
        stated = _stated(chosen, structures, dict(options.priors))
        priors = priors_of(chosen, trial.vessel, measurement.signals, stated)
        return Settings(
            weighting=Unweighted() if options.unweighted else MaximumLikelihood(),
            starts=options.starts,
            priors={name: prior for name, prior in priors.items() if name not in options.freed},
        )

    return settings


def _stated(chosen: Structure, structures: Sequence[Structure], stated: Mapping[str, Prior]) -> dict[str, Prior]:
    """Return the priors that concern a structure; one that no structure has is passed on, to be refused."""
    free, anywhere = _free_names([chosen]), _free_names(structures)
    return {name: prior for name, prior in stated.items() if name in free or name not in anywhere}


def _free_names(structures: Sequence[Structure]) -> set[str]:
    return {parameter.name for structure in structures for parameter in structure.free}
