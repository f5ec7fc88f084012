"""Legs of a campaign: one line at several working points, fitted to all of their responses at once."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from shaftprint.fingerprint._leg_records import LegRecord, leg_record
from shaftprint.identify.fit._fit_test import FitTest
from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._part_tests import part_tests
from shaftprint.models._structure import Structure
from shaftprint.models._working_point import at_working_point
from shaftprint.spectra._frequency_response import FrequencyResponse
from shaftprint.spectra._leg_spectra import SPEED, estimate_inputs_of_legs
from shaftprint.spectra._spectra import Spectra
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.campaign._campaign import Campaign
    from shaftprint.signals._signals import Signals
    from shaftprint.signals._working_points import WorkingPoint


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegMeasurement:
    """What a recording gives of one leg before any model is fitted."""

    name: str
    """Name of the leg."""
    working_point: "WorkingPoint"
    """Mean speed and torque of its whole periods."""
    spectra: Spectra
    """Response about that working point."""
    rack: float | None = None
    """Mean fuel rack of the leg, where it was logged throughout."""
    further: Mapping[str, Spectra] = field(default_factory=dict)
    """Responses to what was moved beside the speed in the same periods, by its symbol."""

    @property
    def responses(self) -> tuple[FrequencyResponse, ...]:
        """The responses to all that was moved, to the speed's set point first."""
        return (self.spectra.response, *(one.response for one in self.further.values()))


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class LegTest:
    """Whether one model of all working points explains what was measured at one of them."""

    name: str
    """Name of the leg, or ``sines``."""
    working_point: "WorkingPoint"
    """Speed and torque there."""
    test: FitTest
    """Its share of the test of fit."""


def legs_of(signals: "Signals", campaign: "Campaign") -> tuple[LegMeasurement, ...]:
    """Return every leg of a campaign that the recording holds, that of the recording's working point first."""
    inputs = estimate_inputs_of_legs(signals, campaign)
    legs = (
        LegMeasurement(
            name=state.name,
            working_point=state.working_point,
            spectra=inputs[state.name][SPEED],
            rack=rack_of(signals.about(state.name)),
            further={name: one for name, one in inputs[state.name].items() if name != SPEED},
        )
        for state in signals.legs
    )
    return tuple(sorted(legs, key=lambda leg: leg.working_point != signals.working_point))


def rack_of(signals: "Signals") -> float | None:
    """Return the fuel rack by which signals are divided; None where it was not logged."""
    rack = signals.channels.get("X")
    return None if rack is None else rack.reference


def structure_at(
    structure: Structure, point: "WorkingPoint", *, main: "WorkingPoint", rack_share: float | None = None
) -> Structure:
    """Return a structure at another working point, with its parameters still those of the first.

    What is a physical value over the torque and times the speed goes with ``n_0 / M_0`` (thesis eqs 2.14-2.25), with
    both as they were measured: the load of a propeller is not the same from leg to leg.

    ``structure``: a structure whose parameters have roles. ``point``, ``main``: the other working point, and that of
    the parameters. ``rack_share``: fuel rack of the one over that of the other, where the structure gives it.
    """
    torque_share = point.shaft_torque_nm / main.shaft_torque_nm
    return at_working_point(
        structure,
        speed_share=point.engine_speed_rev_s / main.engine_speed_rev_s,
        torque_share=torque_share,
        shown_share=torque_share * main.zero_share / point.zero_share,
        rack_share=rack_share,
    )


def leg_pairs(
    structure: Structure, legs: "Sequence[LegMeasurement]", *, engine_speed_rpm: float, shaft_torque_nm: float
) -> list[tuple[Structure, "FrequencyResponse"]]:
    """Return what a joint fit of legs takes, its parameters normalised at a stated working point.

    ``legs``: what was measured. ``engine_speed_rpm``, ``shaft_torque_nm``: the working point at which the parameters
    are normalised, such as that of a plan.
    """
    speed_rev_s = rev_s_from_rpm(engine_speed_rpm)
    return [
        (
            at_working_point(
                structure,
                speed_share=leg.working_point.engine_speed_rev_s / speed_rev_s,
                torque_share=leg.working_point.shaft_torque_nm / shaft_torque_nm,
                shown_share=leg.working_point.shaft_torque_nm / (leg.working_point.zero_share * shaft_torque_nm),
            ),
            leg.spectra.response.of_outputs(*structure.outputs),
        )
        for leg in legs
    ]


def leg_tests(identification: Identification, working_points: Mapping[str, "WorkingPoint"]) -> tuple[LegTest, ...]:
    """Return how well a joint fit explains each leg; empty where it was not fitted to all of them, or to one alone.

    Parameters
    ----------
    identification
        A fit to several legs.
    working_points
        Those of its parts by name, in their order.
    """
    if len(working_points) < 2 or len(identification.parts) != len(working_points) or not identification.is_likelihood:
        return ()
    return tuple(
        LegTest(name=name, working_point=point, test=test)
        for (name, point), test in zip(working_points.items(), part_tests(identification), strict=True)
    )


def fitted_legs(signals: "Signals", legs: Sequence[LegMeasurement], tests: Sequence[LegTest]) -> tuple[LegRecord, ...]:
    """Return what is kept of the legs that were measured, each with its share of the test of fit."""
    p_values = {one.name: one.test.p_value for one in tests}
    names = {leg.name for leg in legs}
    return tuple(
        leg_record(leg, main=signals.working_point, p_value=p_values.get(leg.name))
        for leg in signals.legs
        if leg.name in names
    )
