"""The noun ``PlannedTest``: a plan with all that it takes to sail it, and what was found out about it since."""

from dataclasses import dataclass
from datetime import datetime

from shaftprint import __version__
from shaftprint.campaign._campaign import Campaign
from shaftprint.design.inputs._set_point_line import SetPointLine
from shaftprint.design.plan._campaign import campaign_of
from shaftprint.design.plan._plan import Plan
from shaftprint.design.planned_test._rehearsal import Rehearsal
from shaftprint.design.planned_test._remedies import Remedy
from shaftprint.design.planned_test._verdict import plan_sentences
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.spectra._frequency_response import FrequencyResponse


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class SailedLeg(Shown):
    """What was measured of a leg in an earlier recording, where it was sailed."""

    name: str
    """Name of the leg."""
    speed_share: float
    """Its measured speed over that of the first working point."""
    torque_share: float
    """The same of the shaft torque."""
    response: FrequencyResponse
    """What was measured."""


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class PlannedTest(Shown):
    """A plan with all that it takes to sail it: what a folder of ``shaftprint plan`` holds."""

    name: str
    """Name of the test."""
    vessel: str
    """Name of the vessel and shaft line."""
    plan: Plan
    """Legs, and what they would tell."""
    line: SetPointLine
    """From volts to engine speed."""
    created: datetime
    """When it was planned, with time zone."""
    noise_source: str
    """Where the noise comes from, in words."""
    version: str = __version__
    """Version of shaftprint that planned it."""
    rehearsal: Rehearsal | None = None
    """What came out of sailing it on simulated ships; None where that was not done."""
    remedies: tuple[Remedy, ...] = ()
    """What would help where wishes are not met, the best first."""
    sailed: tuple[SailedLeg, ...] = ()
    """Legs of earlier recordings that this test goes on from."""
    remarks: tuple[str, ...] = ()
    """What the plan leaves alone, in sentences."""

    def summary(self) -> Summary:
        """Return what is sailed, and whether it was rehearsed."""
        facts = {
            "vessel": self.vessel,
            "legs": ", ".join(f"{leg.level_rpm:.0f} rpm +/- {leg.peak_rpm:.0f}" for leg in self.plan.legs),
            "wishes": "met, as predicted" if self.plan.is_enough else "not met",
            "rehearsed": "no" if self.rehearsal is None else " ".join(self.rehearsal.sentences),
        }
        return Summary(title=f"PlannedTest {self.name}", facts=facts)

    @property
    def sentences(self) -> tuple[str, ...]:
        """What the test reaches, the answer first, and whether it was rehearsed."""
        answer, *others = plan_sentences(self.plan, self.remedies, self.rehearsal)
        return (answer, *self.remarks, *others)

    @property
    def campaign(self) -> Campaign:
        """What is asked of the ship, in volts."""
        return campaign_of(
            self.plan, name=self.name, offset_v=self.line.offset_v, slope_rpm_per_v=self.line.slope_rpm_per_v
        )
