"""What stands in ``plan.json``: the nouns of a planned test, and what is predicted for those who read the file."""

from dataclasses import dataclass, fields
from typing import TYPE_CHECKING, Annotated, Final, Literal

from pydantic import AwareDatetime, Field

from shaftprint.arrays import frozen_bool
from shaftprint.design.inputs._assumed_ship import AssumedShip
from shaftprint.design.inputs._lever import Lever
from shaftprint.design.inputs._limits import Limits
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.design.inputs._wish import Wish
from shaftprint.design.plan._band import Band
from shaftprint.design.plan._leg import Leg
from shaftprint.design.plan._plan import Peaks, Plan, predicted_accuracy
from shaftprint.design.plan._timetable import Timetable
from shaftprint.design.planned_test._planned_test import PlannedTest, SailedLeg
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.errors import DesignError
from shaftprint.identify.likelihood._prior import Prior
from shaftprint.identify.prediction._noise_levels import NoiseLevels
from shaftprint.models._working_point import at_working_point
from shaftprint.records import MOST, AnyFloats, Floats, Named, Number, Record, Text, Texts
from shaftprint.spectra._frequency_response import FrequencyResponse

if TYPE_CHECKING:
    from shaftprint.models._structure import Structure

SCHEMA_VERSION: Final = 1


class ShipRecord(Record):
    """What is assumed of the ship."""

    structure: Text
    """Name of the structure."""
    values: Named
    """Assumed values of all parameters."""
    covariance: Floats
    """Their covariance, in the order of the values."""
    held: Texts = ()
    """Parameters that a fit holds at their values."""

    def ship(self, structure: "Structure") -> AssumedShip:
        """Return the ship with the structure of that name."""
        names = tuple(self.values)
        if names != structure.names or self.covariance.shape != (len(names), len(names)):
            raise DesignError(
                f"ship: expected values and covariance of {', '.join(structure.names)}, found "
                f"{', '.join(names) or 'none'}."
            )
        return AssumedShip(structure=structure, values=structure.vector(self.values), covariance=self.covariance)


class NoiseRecord(Record):
    """Noise at one leg, without what its orders cost."""

    frequency_hz: Floats
    """Frequencies [Hz]."""
    density: Floats
    """Real parts of the density [1/Hz] of each frequency."""
    density_im: Floats
    """Imaginary parts."""
    outputs: Texts
    """Names of the outputs."""
    set_point_per_v: Number
    """Change of the set point over the working-point speed for one volt [1/V]."""

    def levels(self) -> NoiseLevels:
        """Return it as planning takes it."""
        return NoiseLevels(
            frequency_hz=self.frequency_hz,
            density=self.density + 1j * self.density_im,
            outputs=self.outputs,
            set_point_per_v=self.set_point_per_v,
        )


@dataclass(frozen=True, kw_only=True, eq=False, repr=False)
class LegInFile(Leg):
    """A leg with what belongs to it."""

    noise: NoiseRecord
    """Noise at its speed."""
    peaks: Peaks
    """The most that it asks for."""

    @property
    def leg(self) -> Leg:
        """The leg itself."""
        return Leg(**{field.name: getattr(self, field.name) for field in fields(Leg)})


class SailedRecord(Record):
    """A leg of an earlier recording, with what a fit needs of its response."""

    name: Text
    """Name of the leg."""
    speed_share: Number
    """Measured speed over that of the first working point."""
    torque_share: Number
    """The same of the shaft torque."""
    lines: Texts
    """Names of its lines."""
    used: Annotated[tuple[bool, ...], Field(max_length=MOST)]
    """Which of them a fit uses."""
    frequency_hz: Floats
    """Their frequencies [Hz]."""
    response: Floats
    """Real parts of the response, a row an output."""
    response_im: Floats
    """Imaginary parts."""
    covariance: Floats
    """Covariance of each line."""
    degrees_of_freedom: AnyFloats
    """Degrees of freedom of each covariance; infinite for a known one."""
    inputs: Texts
    """Names of the inputs."""
    outputs: Texts
    """Names of the outputs."""
    averaging_s: Number
    """Window over which the speed is a mean [s]."""
    hold_s: Number
    """Time for which a speed value is held [s]."""
    pick_up_delay_s: Number
    """Delay of the speed behind the true one [s]."""

    def sailed(self) -> SailedLeg:
        """Return the leg."""
        known = {name: getattr(self, name) for name in _OF_RESPONSE}
        values = (self.response + 1j * self.response_im).reshape(len(self.outputs), len(self.inputs), -1)
        response = FrequencyResponse(**known | {"response": values, "used": frozen_bool(self.used)})
        return SailedLeg(
            name=self.name, speed_share=self.speed_share, torque_share=self.torque_share, response=response
        )


# what record and response have alike
_OF_RESPONSE: Final = (
    *("lines", "frequency_hz", "covariance", "degrees_of_freedom", "inputs", "outputs"),
    *("averaging_s", "hold_s", "pick_up_delay_s"),
)


class PlanRecord(Record):
    """The whole file."""

    schema_version: Literal[1] = SCHEMA_VERSION
    """Version of this layout."""
    shaftprint_version: Text
    """Version of shaftprint that planned it."""
    created: AwareDatetime
    """When it was planned."""
    name: Text
    """Name of the test."""
    vessel: Text
    """Name of the vessel."""
    noise_source: Text
    """Where the noise comes from."""
    slope_rpm_per_v: Number
    """Change of the engine speed for one volt [rpm/V]."""
    offset_v: Number
    """Set point at the first working point [V]."""
    lever: Lever | None = None
    """What the channel of the set point shows for volts, where it does not show them."""
    rehearsed: bool
    """Whether the plan was sailed on simulated ships; its numbers are predictions all the same."""
    duration_s: Number
    """Length of the test [s]."""
    predicted: dict[Text, dict[str, float | str | None]]
    """Value, predicted standard deviation, wish and unit of every number; for those who read the file."""
    ship: ShipRecord
    """What is assumed of the ship."""
    wish_relative: Named
    """Wished standard deviations over the values."""
    wish_absolute: Named
    """Wished standard deviations in the numbers' units."""
    limits: Limits
    """What ship and engine allow."""
    priors: dict[Text, tuple[Number, Number]]
    """What the fit will know besides: mean and standard deviation."""
    timetable: Timetable
    """How the time is divided."""
    stairs_rpm: Annotated[tuple[Number, ...], Field(max_length=MOST)] = ()
    """Levels of the staircase at the end, as deviations from the level of the first leg [rpm]."""
    legs: Annotated[tuple[LegInFile, ...], Field(min_length=1, max_length=100)]
    """Legs in the order in which they are sailed."""
    band: Band | None = None
    """How far what is predicted reaches, where ship or noise are not known."""
    rehearsal: Rehearsal | None = None
    """What came out of sailing it on simulated ships."""
    remarks: Texts = ()
    """What the plan leaves alone, in sentences."""
    remedies: Annotated[tuple[Remedy, ...], Field(max_length=MOST)] = ()
    """What would help."""
    sailed: Annotated[tuple[SailedRecord, ...], Field(max_length=MOST)] = ()
    """Legs of earlier recordings."""

    def planned_test(self, structure: "Structure") -> PlannedTest:
        """Return the planned test; what is predicted is computed again from its legs.

        ``structure``: the structure of its name, free where the plan has it free. Raises ShaftprintError if the numbers
        of the file do not make a plan.
        """
        sailed = tuple(one.sailed() for one in self.sailed)
        return PlannedTest(
            name=self.name,
            vessel=self.vessel,
            plan=self._plan(structure, sailed),
            line=SetPointLine(slope_rpm_per_v=self.slope_rpm_per_v, offset_v=self.offset_v, lever=self.lever),
            created=self.created,
            noise_source=self.noise_source,
            version=self.shaftprint_version,
            rehearsal=self.rehearsal,
            remarks=self.remarks,
            remedies=self.remedies,
            sailed=sailed,
        )

    def _plan(self, structure: "Structure", sailed: tuple[SailedLeg, ...]) -> Plan:
        ship = self.ship.ship(structure)
        legs, noise = tuple(one.leg for one in self.legs), tuple(one.noise.levels() for one in self.legs)
        structures = tuple(at_working_point(structure, speed_share=leg.speed_share) for leg in legs)
        priors = {name: Prior(mean, std) for name, (mean, std) in self.priors.items()}
        earlier = tuple(
            (at_working_point(structure, speed_share=one.speed_share, torque_share=one.torque_share), one.response)
            for one in sailed
        )
        return Plan(
            ship=ship,
            wish=Wish(relative=self.wish_relative, absolute=self.wish_absolute),
            limits=self.limits,
            priors=priors,
            timetable=self.timetable,
            noise=noise,
            structures=structures,
            legs=legs,
            stairs_rpm=self.stairs_rpm,
            band=self.band,
            peaks=tuple(one.peaks for one in self.legs),
            earlier=earlier,
            predicted=predicted_accuracy(structures, legs, noise, values=ship.by_name, priors=priors, earlier=earlier),
        )


def record_of(test: PlannedTest) -> PlanRecord:
    """Return a planned test as the record that stands in its file."""
    plan = test.plan
    ship = plan.ship
    return PlanRecord(
        shaftprint_version=test.version,
        created=test.created,
        name=test.name,
        vessel=test.vessel,
        noise_source=test.noise_source,
        slope_rpm_per_v=test.line.slope_rpm_per_v,
        offset_v=test.line.offset_v,
        lever=test.line.lever,
        rehearsed=test.rehearsal is not None,
        duration_s=plan.duration_s,
        predicted={
            one.name: {"value": one.value, "std": one.std, "wished_std": plan.targets.get(one.name), "unit": one.unit}
            for one in plan.promised.values()
        },
        ship=ShipRecord(
            structure=ship.structure.name,
            values=ship.by_name,
            covariance=ship.covariance,
            held=tuple(p.name for p in ship.structure.parameters if p.held),
        ),
        wish_relative=dict(plan.wish.relative),
        wish_absolute=dict(plan.wish.absolute),
        limits=plan.limits,
        priors={name: (prior.mean, prior.std) for name, prior in plan.priors.items()},
        timetable=plan.timetable,
        stairs_rpm=plan.stairs_rpm,
        legs=tuple(_leg(*one) for one in zip(plan.legs, plan.noise, plan.peaks, strict=True)),
        band=plan.band,
        rehearsal=test.rehearsal,
        remarks=test.remarks,
        remedies=test.remedies,
        sailed=tuple(map(_sailed, test.sailed)),
    )


def _leg(leg: Leg, noise: NoiseLevels, peaks: Peaks) -> LegInFile:
    record = NoiseRecord(
        frequency_hz=noise.frequency_hz,
        density=noise.density.real,
        density_im=noise.density.imag,
        outputs=noise.outputs,
        set_point_per_v=noise.set_point_per_v,
    )
    return LegInFile(**{field.name: getattr(leg, field.name) for field in fields(Leg)}, noise=record, peaks=peaks)


def _sailed(leg: SailedLeg) -> SailedRecord:
    response = leg.response
    values = response.response.reshape(-1, len(response.lines))
    return SailedRecord(
        name=leg.name,
        speed_share=leg.speed_share,
        torque_share=leg.torque_share,
        used=tuple(response.used.tolist()),
        response=values.real,
        response_im=values.imag,
        **{name: getattr(response, name) for name in _OF_RESPONSE},
    )
