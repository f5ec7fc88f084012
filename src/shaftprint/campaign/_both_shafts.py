"""What is asked of both shafts of a ship during one recording: in turn, or at once on lines of their own."""

from collections.abc import Iterator, Mapping
from importlib.resources import files
from itertools import product
from pathlib import Path
from typing import Any, Literal, Self

from pydantic import model_validator

from shaftprint.arguments import refusing_none
from shaftprint.campaign._campaign import Campaign
from shaftprint.campaign._excitation import ROUNDING_S, Excitation
from shaftprint.campaign._multisine import Multisine
from shaftprint.errors import SettingsError
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary
from shaftprint.settings import Name, PositiveNumber, Settings, load_settings

SIDES = ("port", "starboard")
_OF_BOTH = ("name", "place", "duration_s", "sample_rate_hz")
# Set points closer than this are the same [V].
_NOTHING_V = 1e-9


class CampaignOfBoth(Shown, Settings):
    """A test of both shafts of a ship, in one recording."""

    name: Name
    """Name of the test."""
    place: Name | None = None
    """Where it is made, such as the harbour; shown on the first page of the reports."""
    duration_s: PositiveNumber
    """Length of the recording that it needs [s]."""
    sample_rate_hz: PositiveNumber | None = None
    """Rate at which the test is meant to be recorded [Hz]; no frequency may reach half of it."""
    excited: Literal["at once", "in turn"]
    """At once: multisines at the same time, whose lines are not those of the other side. In turn: one side stands still
    while the other is excited."""
    port: Campaign
    """What is asked of the line to port."""
    starboard: Campaign
    """What is asked of the line to starboard."""

    def summary(self) -> Summary:
        """Return the tests of both sides and how long they take."""
        facts = {side: f"{len(one.excitations)} tests" for side, one in zip(SIDES, self.sides, strict=True)}
        return Summary(
            title=f"Campaign {self.name}, both shafts",
            facts=facts | {"excited": f"{self.excited}, {self.duration_s:g} s"},
        )

    @property
    def sides(self) -> tuple[Campaign, Campaign]:
        """What is asked of each line, port first."""
        return self.port, self.starboard

    @model_validator(mode="before")
    @classmethod
    def _sides_of_one_test(cls, content: Any) -> Any:
        """Give each side what stands once for both."""
        if not isinstance(content, Mapping):
            return content
        common = {key: content[key] for key in _OF_BOTH if key in content}
        sides = {side: content[side] for side in SIDES if isinstance(content.get(side), Mapping)}
        for side, asked in sides.items():
            twice = [key for key in _OF_BOTH if key in asked]
            if twice:
                raise ValueError(f"expected {side}.{twice[0]} left out, as it stands once for both sides, found one.")
        named = {
            side: common | {"name": f"{common['name']}, {side}"} | dict(asked)
            for side, asked in sides.items()
            if isinstance(common.get("name"), str)
        }
        return {**content, **named}

    @model_validator(mode="after")
    def _sides_are_told_apart(self) -> Self:
        faults = self._not_in_turn() if self.excited == "in turn" else self._not_apart()
        # one sentence: the same mistake is made at every leg
        first = next(faults, None)
        if first is not None:
            raise ValueError(first)
        return self

    def _at_the_same_time(self) -> list[tuple[Excitation, Excitation]]:
        pairs = product(self.port.excitations, self.starboard.excitations)
        return [(p, s) for p, s in pairs if p.start_s < s.stop_s - ROUNDING_S and s.start_s < p.stop_s - ROUNDING_S]

    def _not_in_turn(self) -> Iterator[str]:
        for port, starboard in self._at_the_same_time():
            yield (
                f"expected port.{port.name} and starboard.{starboard.name} one after the other, as excited = "
                f'"in turn", found both from {max(port.start_s, starboard.start_s):g} to '
                f"{min(port.stop_s, starboard.stop_s):g} s; "
                'move one of them, or give each lines of its own and excited = "at once".'
            )
        for side, mover, other in (("starboard", self.port, self.starboard), ("port", self.starboard, self.port)):
            for move, test in product(mover.moves, other.excitations):
                if (
                    abs(move.to_v - move.from_v) > _NOTHING_V
                    and move.start_s < test.stop_s - ROUNDING_S
                    and test.start_s < move.stop_s - ROUNDING_S
                ):
                    yield (
                        f"expected the other side to stand still during {side}.{test.name}, found it on its way from "
                        f"{move.from_v:g} to {move.to_v:g} V {move.where}; leave time for that before or after."
                    )

    def _not_apart(self) -> Iterator[str]:
        together = self._at_the_same_time()
        if not together:
            yield 'expected tests of both sides at the same time, as excited = "at once", found none; say "in turn".'
        for port, starboard in together:
            where = f"port.{port.name} and starboard.{starboard.name}"
            if not isinstance(port, Multisine) or not isinstance(starboard, Multisine):
                yield (
                    f"expected multisines where both sides are excited at once, found others in {where}; make them one "
                    "after the other."
                )
                continue
            times = [(one.start_s, one.settled_s, one.stop_s, one.period_s) for one in (port, starboard)]
            if times[0] != times[1]:
                yield (
                    f"expected the same start_s, settled_s, stop_s and period_s of {where}, so that the lines of one "
                    f"do not reach into those of the other, found {times[0]} and {times[1]}."
                )
            both = sorted({*port.harmonics} & {*starboard.harmonics})
            if both:
                yield (
                    f"expected lines of their own for {where}, which are excited at once, found {len(both)} lines in "
                    f"both, the first at {both[0] / port.period_s:.4g} Hz; leave each harmonic to one of them."
                )


@refusing_none(SettingsError)
def load_campaign_of_both(path_or_name: str | Path) -> CampaignOfBoth:
    """Read a campaign file of both shafts, or a shipped one by its name such as ``at-once``.

    ``path_or_name``: path of a TOML file, or the name of a shipped campaign of both shafts. Raises SettingsError if the
    file cannot be used; the message lists every field that is wrong.
    """
    return load_settings(path_or_name, CampaignOfBoth, shipped=files(__package__) / "shipped_for_both")
