"""Wake fraction, thrust deduction and resistance of a ship underway, whose propeller is one of a series.

A free-sailing structure shows slopes of the propeller and times of the ship. Where the curves of the propeller are
known they are all functions of the wake fraction and of the resistance, to which the same responses are fitted once
more. What that rests on, and no recording shows, is in the standard deviations: mass, zero of the torque gauge and
latency of the log are parameters with priors; the mean speed by the log and the pitch are moved by their standard
deviations, and the fit is made again.
"""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace

import numpy as np

from shaftprint.catalogue._known_propeller import KnownPropeller, sails_free, with_known_propeller
from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._identify import identify
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.search._settings import Settings
from shaftprint.identify.search._starts import GivenStarts
from shaftprint.models._structure import Structure
from shaftprint.signals._signals import Signals
from shaftprint.survey._known_propeller import known_propeller
from shaftprint.vessel._hull import Hull
from shaftprint.vessel._vessel import Vessel

_STARTS = 8


def ship_numbers(
    fit: Identification, signals: Signals, vessel: Vessel, *, rng: np.random.Generator
) -> tuple[Estimate, ...]:
    """Return what a test underway says of the ship; nothing where it was at the quay or its propeller is not known.

    ``fit``: fit of a free-sailing structure to responses of shaft and log. ``signals``, ``vessel``: what it was made
    from. ``rng``: for the starts of the search. Returns ``w``, ``t``, ``R`` [N] and the exponent of the resistance,
    beside what the vessel file states of them. Raises StructureError if the propeller does not pull at the speeds that
    were measured; IdentificationError if the responses cannot be fitted.
    """
    log, hull = signals.channels.get("v_s"), vessel.hull
    if log is None or hull is None or not sails_free(fit.structure):
        return ()
    propeller = known_propeller(
        vessel,
        shaft_speed_rev_s=signals.working_point.engine_speed_rev_s / vessel.gearbox.ratio,
        ship_speed_m_s=log.reference,
    )
    if propeller is None:
        return ()
    problem = _Problem(fit, hull)
    known = problem.solved(propeller, rng=rng)
    variances = {name: std**2 for name, (_, std) in known.found.items()}
    for moved in _moved(propeller, vessel):
        other = problem.solved(moved, rng=rng, start=known.values)
        for name, (value, _) in other.found.items():
            variances[name] += (value - known.found[name][0]) ** 2
    expected = _expected(hull, propeller.ship_speed_m_s)
    return tuple(
        Estimate(
            name=name,
            unit=unit,
            value=known.found[symbol][0],
            std=float(np.sqrt(variances[symbol])),
            expected=expected[symbol][0],
            expected_std=expected[symbol][1],
            meaning=meaning,
        )
        for name, symbol, unit, meaning in _QUANTITIES
    )


_QUANTITIES = (
    ("w", "w", "-", "wake fraction, with the propeller's curves known"),
    ("t", "t", "-", "thrust deduction, 1 - R / thrust of all propellers, with mass and curves known"),
    ("R", "R", "N", "resistance at the mean speed, with mass and curves known"),
    ("R exponent", "e", "-", "slope of the resistance, d ln R / d ln v, with the propeller's curves known"),
)


@dataclass(frozen=True, slots=True)
class _Solved:
    """One fit with a known propeller."""

    found: Mapping[str, tuple[float, float]]
    """Value and standard deviation of each number by its symbol."""
    values: tuple[float, ...]
    """Its free parameters, to begin another fit at."""


@dataclass(frozen=True, slots=True)
class _Problem:
    """What stays the same while something that is known moves."""

    fit: Identification
    hull: Hull

    def solved(
        self, propeller: KnownPropeller, *, rng: np.random.Generator, start: tuple[float, ...] | None = None
    ) -> _Solved:
        """Return the fit with a propeller; from one start where it is given."""
        tied = self._tied(propeller)
        search = {"starts": _STARTS} if start is None else {"starts": 1, "draw": GivenStarts(np.array([start]))}
        free = {parameter.name for parameter in tied.free}
        known = {**self.fit.settings.priors, "m": Prior(self.hull.surging_mass_kg, self.hull.surging_mass_std_kg)}
        priors = {name: prior for name, prior in known.items() if name in free}
        fit = identify(tied, self.fit.response, rng=rng, settings=Settings(priors=priors, **search))
        found = {one.name: (one.value, one.std) for one in (*fit.parameters, *fit.combinations)}
        return _Solved(
            {symbol: found[symbol] for _, symbol, _, _ in _QUANTITIES}, tuple(one.value for one in fit.parameters)
        )

    def _tied(self, propeller: KnownPropeller) -> Structure:
        """Return the structure with wake and resistance, and with the mass free."""
        tied = with_known_propeller(self.fit.structure, propeller, mass_kg=self.hull.surging_mass_kg)
        mass = self.hull.surging_mass_kg
        return tied.free_between(m=(0.5 * mass, 2.0 * mass))


def _moved(propeller: KnownPropeller, vessel: Vessel) -> Iterator[KnownPropeller]:
    """Yield the propeller with something that no recording shows off by one standard deviation."""
    log = vessel.sensors.ship_speed
    if log is not None:
        yield replace(propeller, ship_speed_m_s=propeller.ship_speed_m_s * (1.0 + log.scale_std))
    yield replace(propeller, pitch_ratio=propeller.pitch_ratio * (1.0 + vessel.propeller.pitch_std))


def _expected(hull: Hull, speed_m_s: float) -> Mapping[str, tuple[float | None, float | None]]:
    """Return what the vessel file states of each number, with its standard deviation."""
    resistance_n = hull.resistance_at_n(speed_m_s)
    share = None if hull.resistance_std_n is None else hull.resistance_std_n / hull.resistance_n
    return {
        "w": (hull.wake_fraction, hull.wake_fraction_std),
        "t": (hull.thrust_deduction, hull.thrust_deduction_std),
        "R": (resistance_n, None if share is None else share * resistance_n),
        "e": (hull.resistance_exponent, None),
    }
