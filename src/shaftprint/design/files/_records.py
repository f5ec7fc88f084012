"""What stands in ``plan.json``: numbers, lists and text, checked before anything is made of them."""

from typing import Annotated, Final, Literal

from pydantic import AwareDatetime, BaseModel, ConfigDict, Field

from shaftprint.design.inputs._limits import Limits
from shaftprint.design.plan._plan import Peaks
from shaftprint.design.plan._timetable import Timetable

SCHEMA_VERSION: Final = 1

# Larger than anything on a ship in any unit, and small enough that products and squares stay numbers.
_LARGEST = 1e30
# A file with more than this was not written by the program.
_MOST = 100_000

Number = Annotated[float, Field(allow_inf_nan=False, ge=-_LARGEST, le=_LARGEST)]
Row = Annotated[tuple[Number, ...], Field(max_length=_MOST)]
Table = Annotated[tuple[Row, ...], Field(max_length=_MOST)]
Text = Annotated[str, Field(max_length=_MOST)]
Named = dict[Text, Number]


class Record(BaseModel):
    """A frozen part of the file; fields that it does not know are refused."""

    model_config = ConfigDict(frozen=True, extra="forbid", ser_json_inf_nan="strings", defer_build=True)


class ShipRecord(Record):
    """What is assumed of the ship."""

    structure: Text
    """Name of the structure."""
    values: Named
    """Assumed values of all parameters."""
    covariance: Table
    """Their covariance, in the order of the values."""
    held: tuple[Text, ...] = ()
    """Parameters that a fit holds at their values."""


class NoiseRecord(Record):
    """Noise at one leg."""

    frequency_hz: Row
    """Frequencies [Hz]."""
    density: Annotated[tuple[Table, ...], Field(max_length=_MOST)]
    """Real parts of the density [1/Hz] of each frequency."""
    density_im: Annotated[tuple[Table, ...], Field(max_length=_MOST)]
    """Imaginary parts."""
    outputs: tuple[Text, ...]
    """Names of the outputs."""
    set_point_per_v: Number
    """Change of the set point over the working-point speed for one volt [1/V]."""


class PlannedLegRecord(Record):
    """One leg."""

    speed_share: Number
    """Mean speed over that of the first working point."""
    level_rpm: Number
    """The same as engine speed [rpm]."""
    period_s: Number
    """Period [s]."""
    harmonics: Annotated[tuple[int, ...], Field(max_length=_MOST)]
    """Multiples of the reciprocal of the period."""
    amplitudes: Table
    """Real and imaginary part of the amplitude of each line over the mean speed, two rows."""
    periods: Annotated[int, Field(gt=0, le=_MOST)]
    """Whole periods."""
    settle_s: Number
    """Time before them [s]."""
    noise: NoiseRecord
    """Noise at its speed."""
    peaks: Peaks
    """The most that it asks for."""


class RehearsalRecord(Record):
    """What came out of sailing the plan on simulated ships."""

    names: tuple[Text, ...]
    """Numbers that every sailing has found."""
    errors: Table
    """Estimate minus truth, a row a sailing."""
    stated: Table
    """Stated standard deviations, a row a sailing."""
    planned: Row
    """Planned standard deviations."""
    limited: Row
    """Share of the time for which a limit acted, by sailing."""
    failures: tuple[Text, ...]
    """What sailings without a result said."""


class RemedyRecord(Record):
    """What would help."""

    name: Text
    """What is done."""
    worst: float
    """Largest predicted deviation over its wish."""
    ratios: dict[Text, float]
    """Predicted deviation over the wish, by name."""


class SailedRecord(Record):
    """A leg of an earlier recording."""

    name: Text
    """Name of the leg."""
    speed_share: Number
    """Measured speed over that of the first working point."""
    torque_share: Number
    """The same of the shaft torque."""
    lines: tuple[Text, ...]
    """Names of its lines."""
    used: tuple[bool, ...]
    """Which of them a fit uses."""
    frequency_hz: Row
    """Their frequencies [Hz]."""
    response: Table
    """Real parts of the response, a row an output."""
    response_im: Table
    """Imaginary parts."""
    covariance: Annotated[tuple[Table, ...], Field(max_length=_MOST)]
    """Covariance of each line."""
    degrees_of_freedom: tuple[float, ...]
    """Degrees of freedom of each covariance; infinite for a known one."""
    inputs: tuple[Text, ...]
    """Names of the inputs."""
    outputs: tuple[Text, ...]
    """Names of the outputs."""
    averaging_s: Number
    """Window over which the speed is a mean [s]."""
    hold_s: Number
    """Time for which a speed value is held [s]."""
    pick_up_delay_s: Number
    """Delay of the speed behind the true one [s]."""


class BandRecord(Record):
    """How far what is predicted reaches."""

    deviations: dict[Text, tuple[float, float]]
    """Lower and upper deviation over that of the middle, by number."""
    middle: dict[Text, float] = {}
    """Deviation of the middle of the possible ships over that at the assumed values, by number."""
    seconds: tuple[float, float] | None = None
    """Shortest and longest test that meets every wish [s]."""


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
    stairs_rpm: Row = ()
    """Levels of the staircase at the end, as deviations from the level of the first leg [rpm]."""
    legs: Annotated[tuple[PlannedLegRecord, ...], Field(min_length=1, max_length=100)]
    """Legs in the order in which they are sailed."""
    band: BandRecord | None = None
    """How far what is predicted reaches, where ship or noise are not known."""
    rehearsal: RehearsalRecord | None = None
    """What came out of sailing it on simulated ships."""
    remarks: tuple[Text, ...] = ()
    """What the plan leaves alone, in sentences."""
    remedies: tuple[RemedyRecord, ...] = ()
    """What would help."""
    sailed: tuple[SailedRecord, ...] = ()
    """Legs of earlier recordings."""
