"""What a search found besides its result: how unique the optimum is, and how hard it was to find."""

from dataclasses import dataclass

from shaftprint.identify.fit._identification import Identification
from shaftprint.identify.fit._optima import Optimum, is_passed_over, is_rival, optima_of
from shaftprint.identify.judgement._search_words import search_words


@dataclass(frozen=True, kw_only=True, slots=True, eq=False)
class SearchReport:
    """The optima of a search."""

    optima: tuple[Optimum, ...]
    """The result first, then the others, lowest cost first."""
    sentences: tuple[str, ...]
    """What a reader must know of them."""

    @property
    def agreeing(self) -> int:
        """How many starts ended at the result, or in one valley with it."""
        return sum(optimum.starts for optimum in self.optima if optimum.connected)

    @property
    def rivals(self) -> tuple[Optimum, ...]:
        """Other stable optima that fit as well within the noise."""
        return tuple(optimum for optimum in self.optima[1:] if is_rival(optimum))

    @property
    def passed_over(self) -> tuple[Optimum, ...]:
        """Unstable optima that fit better."""
        return tuple(optimum for optimum in self.optima[1:] if is_passed_over(optimum))


def report_search(identification: Identification) -> SearchReport:
    """Return the optima that the starts of a fit reached, each led to its end, and what they mean."""
    optima = optima_of(identification)
    return SearchReport(optima=optima, sentences=search_words(identification, optima))
