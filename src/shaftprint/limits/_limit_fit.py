"""The noun of the room: which limits a line has, their numbers, and what of them may be trusted."""

from collections.abc import Mapping
from dataclasses import dataclass

from shaftprint.identify.fit._estimate import Estimate
from shaftprint.identify.fit._identification import Identification
from shaftprint.limits._candidates import STRUCTURE_LIMITS, Kind, parameters_of
from shaftprint.limits.prediction._prediction_error import PredictedTorque
from shaftprint.notebook._shown import Shown
from shaftprint.notebook._summary import Summary, shortened
from shaftprint.spelling import listed


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class LimitFit(Shown):
    """The limits of a line."""

    numbers: tuple[Estimate, ...]
    """Their levels, rates and widths; the first of each limit is the one by which it is known."""
    gains: Mapping[Kind, float]
    """Fall of minus twice the log-likelihood that each limit brings to the others, the strongest evidence first."""
    governor: tuple[Estimate, ...]
    """Governor and delays that go with them, with their standard deviations; infinite where none is known."""
    not_seen: Mapping[Kind, str]
    """For each limit that does not act: up to which level the data exclude it, in words."""
    identification: Identification
    """The fit."""
    reached: str
    """What the test reached, in words: of limits beyond it says nothing."""

    def summary(self) -> Summary:
        """Return the limits with their intervals."""
        ends = {one.name: one.interval_95 or one.limits_95 for one in self.numbers}
        facts = {
            one.name: f"{one.value:.4g}, 95 % {ends[one.name][0]:.4g} to {ends[one.name][1]:.4g} {one.unit}"
            for one in self.numbers
        }
        return Summary(title="LimitFit", facts={**facts, "not seen": shortened(str(kind) for kind in self.not_seen)})

    @property
    def kinds(self) -> tuple[Kind, ...]:
        """The limits that act, the strongest evidence first."""
        return tuple(self.gains)

    @property
    def trusted(self) -> tuple[Estimate, ...]:
        """The numbers that may be used."""
        return tuple(number for number in self.numbers if number.trusted)

    @property
    def trusted_kinds(self) -> tuple[Kind, ...]:
        """The limits whose level may be used; a smoke limit is a share of the torque limit, where there is one."""
        first = {Kind(number.limit): number.trusted for number in reversed(self.numbers)}
        return tuple(
            kind for kind in self.kinds if first[kind] and (kind is not Kind.SMOKE or first.get(Kind.TORQUE, True))
        )

    @property
    def doubts(self) -> Mapping[Kind, str]:
        """Why the level of a limit is not to be used, for those of which it is not."""
        first = {Kind(number.limit): number for number in reversed(self.numbers)}
        return {
            kind: first[kind].doubt or "it is a share of a torque limit that is not trusted"
            for kind in self.kinds
            if kind not in self.trusted_kinds
        }

    @property
    def predicted(self) -> PredictedTorque:
        """The data with the torque over the load as governor and limits predict it."""
        (part,) = self.identification.parts
        if not isinstance(part, PredictedTorque):
            raise TypeError(f"{part.name}: expected the torque of a governor.")
        return part

    @property
    def structure_limits(self) -> tuple[str, ...]:
        """The trusted limits by the names of ``time_domain.structure_for``, for a fit of the whole line with them."""
        return tuple(dict.fromkeys(name for kind in self.trusted_kinds for name in STRUCTURE_LIMITS.get(kind, ())))

    @property
    def start(self) -> Mapping[str, float]:
        """Values of the trusted limits' parameters, from which such a fit may start."""
        names = parameters_of(self.trusted_kinds)
        return {one.name: one.value for one in self.identification.parameters if one.name in names}

    @property
    def sentence(self) -> str:
        """All limits in a sentence."""
        if not self.kinds:
            return (
                "No limit was found: governor and engine are linear in this test, beyond what its noise hides. "
                f"{self.reached} What lies beyond was not asked for."
            )
        named = [f"a {kind.value}" for kind in self.kinds]
        return f"Governor and engine show {listed(named)}: a linear model does not hold where they act."
