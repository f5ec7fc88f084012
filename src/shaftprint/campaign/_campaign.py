"""The noun of the room: everything that is asked of the ship during one recording."""

from collections.abc import Iterable, Mapping
from importlib.resources import files
from itertools import pairwise
from pathlib import Path
from typing import Self

from pydantic import Field, model_validator

from shaftprint.arguments import refusing_none
from shaftprint.campaign._binary_sequence import BinarySequence
from shaftprint.campaign._excitation import ROUNDING_S, Excitation
from shaftprint.campaign._excitations import SPEED_SET_POINT, Chirp, Sine, Staircase
from shaftprint.campaign._leg import Leg
from shaftprint.campaign._moves import Move, faults_of, moves_of
from shaftprint.campaign._multisine import Multisine
from shaftprint.errors import SettingsError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.settings import Name, Number, PositiveNumber, Settings, load_settings, names_twice


class Campaign(Shown, Settings):
    """A test of one shaft line: excitations one after the other around a constant set point."""

    name: Name
    """Name of the test."""
    place: Name | None = None
    """Where it is made, such as the harbour; shown on the first page of the report."""
    duration_s: PositiveNumber
    """Length of the recording that it needs [s]."""
    offset_v: Number
    """Set point outside of every excitation [V]."""
    offset_rpm: PositiveNumber | None = None
    """Engine speed for which that asks [rpm]; the working point's of the vessel file where it is not given."""
    slope_rpm_per_v: Number | None = None
    """Change of the engine speed for one volt [rpm/V], negative where a lower voltage asks for more speed; of the lever
    for which the test was made. Where it is not given nothing is known of the lever before the test."""
    further_offsets_v: Mapping[Name, Number] = Field(default_factory=dict)
    """Middle of the sines and multisines that move something else than the set point of the speed [V], by the name of
    that input."""
    sample_rate_hz: PositiveNumber | None = None
    """Rate at which the test is meant to be recorded [Hz]; no frequency may reach half of it."""
    ramp_s: PositiveNumber | None = None
    """Time in which the set point goes to a leg, from one to the next, and back to the offset [s]."""
    ramp_v_per_s: PositiveNumber | None = None
    """The same as a rate [V/s]; one of the two is needed where there are legs."""
    read_off: Name | None = None
    """File name of the recording whose set point the tests were read off; nothing of a test that was planned."""
    sines: tuple[Sine, ...] = ()
    """Sines of constant frequency."""
    multisines: tuple[Multisine, ...] = ()
    """Sums of sines, each at a level of its own: one level, one working point."""
    binary_sequences: tuple[BinarySequence, ...] = ()
    """Pseudo-random binary sequences, each at a level of its own."""
    chirps: tuple[Chirp, ...] = ()
    """Sweeps."""
    staircases: tuple[Staircase, ...] = ()
    """Steps between constant levels."""

    def summary(self) -> Summary:
        """Return the tests, their band and how long they take."""
        hertz = [sine.frequency_hz for sine in self.sines]
        facts = {
            "length": f"{self.duration_s:g} s ({self.duration_s / 60.0:.3g} min)",
            "sines": f"{shortened(s.name for s in self.sines)}: {min(hertz):.3g} to {max(hertz):.3g} Hz"
            if hertz
            else "",
            "multisines": shortened(one.name for one in self.multisines),
            "binary sequences": shortened(one.name for one in self.binary_sequences),
            "chirps": shortened(chirp.name for chirp in self.chirps),
            "staircases": shortened(staircase.name for staircase in self.staircases),
            "set point": f"{self.offset_v:g} V in the middle",
        }
        return Summary(title=f"Campaign {self.name}", facts=facts)

    @property
    def excitations(self) -> tuple[Excitation, ...]:
        """Every excitation in the order of time."""
        every: tuple[Excitation, ...] = (
            *self.sines,
            *self.multisines,
            *self.binary_sequences,
            *self.chirps,
            *self.staircases,
        )
        return tuple(sorted(every, key=lambda excitation: excitation.start_s))

    @property
    def legs(self) -> tuple[Leg, ...]:
        """What moves the speed and repeats itself at a level of its own, in the order of time."""
        return tuple(one for one in self.of_input().excitations if isinstance(one, Leg))

    @property
    def measured(self) -> tuple[str, ...]:
        """Names of its sines and legs, whose lines are measured."""
        return (*(sine.name for sine in self.sines), *(leg.name for leg in self.legs))

    @property
    def levels_v(self) -> frozenset[float]:
        """Set points about which something that repeats itself is measured [V]: of the legs, and of the sines."""
        of_sines = {self.offset_v} if self.sines else set()
        return frozenset({leg.level_v for leg in self.legs} | of_sines)

    def is_read_off(self, recording: Path) -> bool:
        """Return whether the tests were read off a recording, in whichever format it is now."""
        return self.read_off is not None and Path(self.read_off).stem == recording.stem

    def beside(self, leg: Leg) -> tuple[Multisine, ...]:
        """Return the multisines that move something else in the periods of a leg."""
        return tuple(one for one in self._of_further_inputs if runs_beside(one, leg))

    @property
    def _of_further_inputs(self) -> tuple[Multisine, ...]:
        return tuple(one for one in self.multisines if one.input != SPEED_SET_POINT)

    @property
    def moves(self) -> tuple[Move, ...]:
        """How the set point of the speed goes to the legs, between them and back, in order of time."""
        return moves_of(
            self.of_input().excitations,
            offset_v=self.offset_v,
            duration_s=self.duration_s,
            ramp_s=self.ramp_s,
            ramp_v_per_s=self.ramp_v_per_s,
        )

    @property
    def inputs(self) -> tuple[str, ...]:
        """What is moved, the set point of the speed first."""
        moved = (*(sine.input for sine in self.sines), *(one.input for one in self.multisines))
        return tuple(dict.fromkeys((SPEED_SET_POINT, *moved)))

    def middle_v(self, name: str) -> float:
        """Return the voltage of an input outside of every excitation [V]; 0 where the campaign does not name it."""
        return self.offset_v if name == SPEED_SET_POINT else self.further_offsets_v.get(name, 0.0)

    def of_input(self, name: str = SPEED_SET_POINT) -> Self:
        """Return the campaign with those excitations alone that move one input."""
        moving = {
            "sines": tuple(sine for sine in self.sines if sine.input == name),
            "multisines": tuple(one for one in self.multisines if one.input == name),
        }
        if name == SPEED_SET_POINT:
            return self.model_copy(update=moving)
        return self.model_copy(update=moving | dict.fromkeys(("binary_sequences", "chirps", "staircases"), ()))

    @model_validator(mode="after")
    def _can_be_sailed(self) -> Self:
        errors = [
            *self._without_offset(),
            *self._without_slope(),
            *self._names_twice(),
            *self._overlaps(),
            *self._too_late(),
            *self._too_fast(),
            *faults_beside(self._of_further_inputs, self.legs, self.further_offsets_v),
            *faults_of(self.moves, ramp_s=self.ramp_s, ramp_v_per_s=self.ramp_v_per_s),
        ]
        errors += self._without_excitations()
        if errors:
            raise ValueError(" ".join(errors))
        return self

    def _without_excitations(self) -> list[str]:
        if self.excitations:
            return []
        return ["expected at least one sine, multisine, binary sequence, chirp or staircase, found none."]

    def _without_offset(self) -> list[str]:
        missing = [name for name in self.inputs if name != SPEED_SET_POINT and name not in self.further_offsets_v]
        return [
            f"expected further_offsets_v.{name}, the middle of the tests that move it, found none." for name in missing
        ]

    def _without_slope(self) -> list[str]:
        if self.slope_rpm_per_v != 0.0:
            return []
        return ["expected slope_rpm_per_v, what one volt asks for, other than 0, found 0."]

    def _names_twice(self) -> list[str]:
        names = [excitation.name for excitation in self.excitations]
        twice = names_twice(names)
        return [f"expected every excitation to have its own name, found {name} twice." for name in twice]

    def _overlaps(self) -> list[str]:
        return [
            f"expected {later.name} to start after {earlier.name} has stopped at {earlier.stop_s:g} s, "
            f"found a start at {later.start_s:g} s."
            for earlier, later in pairwise(one for one in self.excitations if one not in self._of_further_inputs)
            if later.start_s < earlier.stop_s - ROUNDING_S
        ]

    def _too_late(self) -> list[str]:
        return [
            f"expected {excitation.name} to stop within duration_s = {self.duration_s:g}, "
            f"found a stop at {excitation.stop_s:g} s."
            for excitation in self.excitations
            if excitation.stop_s > self.duration_s + ROUNDING_S
        ]

    def _too_fast(self) -> list[str]:
        if self.sample_rate_hz is None:
            return []
        highest = [(sine.name, sine.frequency_hz) for sine in self.sines]
        legs = (*self.legs, *self._of_further_inputs)
        highest += [(leg.name, max(leg.lines) / leg.length_of_period_s) for leg in legs]
        highest += [(chirp.name, max(chirp.start_frequency_hz, chirp.stop_frequency_hz)) for chirp in self.chirps]
        nyquist = self.sample_rate_hz / 2.0
        return [
            f"expected {name} below half of sample_rate_hz, {nyquist:g} Hz, found {frequency:g} Hz."
            for name, frequency in highest
            if frequency >= nyquist
        ]


@refusing_none(SettingsError)
def load_campaign(path_or_name: str | Path) -> Campaign:
    """Read a campaign file, or a shipped one by its name such as ``thesis``.

    Parameters
    ----------
    path_or_name
        Path of a TOML file, or the name of a shipped campaign.

    Raises
    ------
    SettingsError
        If the file cannot be used; the message lists every field that is wrong.
    """
    return load_settings(path_or_name, Campaign, shipped=files(__package__) / "shipped")


_ROUNDING = 1e-9


def runs_beside(multisine: Multisine, leg: "Leg") -> bool:
    """Return whether a multisine has the times and the period of a leg, so that their lines stay apart."""
    times = [(one.start_s, one.settled_s, one.stop_s, one.length_of_period_s) for one in (multisine, leg)]
    return all(abs(one - other) <= _ROUNDING * max(abs(other), 1.0) for one, other in zip(*times, strict=True))


def faults_beside(multisines: Iterable[Multisine], legs: "Iterable[Leg]", middles_v: Mapping[str, float]) -> list[str]:
    """Return what is wrong with multisines of further inputs, one sentence each.

    ``multisines``: those that move something else than the set point of the speed. ``legs``: those of the speed.
    ``middles_v``: voltage of each further input outside of its tests [V].
    """
    every, errors = tuple(legs), []
    taken: dict[tuple[str, int], str] = {}
    for one in multisines:
        leg = next((leg for leg in every if runs_beside(one, leg)), None)
        if leg is None:
            errors.append(
                f"expected {one.name}, which moves {one.input}, beside a multisine of the speed with the same start_s, "
                "settled_s, stop_s and period_s, found none."
            )
            continue
        for harmonic in leg.lines:
            taken.setdefault((leg.name, harmonic), leg.name)
        twice = [(harmonic, taken[leg.name, harmonic]) for harmonic in one.lines if (leg.name, harmonic) in taken]
        if twice:
            errors.append(
                f"expected {one.name} to have harmonics of its own, found {twice[0][0]} in {twice[0][1]} too; two "
                "inputs on one line cannot be told apart."
            )
        taken.update({(leg.name, harmonic): one.name for harmonic in one.lines})
        middle_v = middles_v.get(one.input)
        if middle_v is not None and abs(one.level_v - middle_v) > _ROUNDING:
            errors.append(
                f"expected level_v of {one.name} to be further_offsets_v.{one.input} = {middle_v:g}, about which that "
                f"stands still, found {one.level_v:g}."
            )
    return errors
