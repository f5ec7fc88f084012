"""How fast a logger has to sample for the pulses of a card."""

from collections.abc import Iterator

from shaftprint.card._card import Card, Pulses
from shaftprint.card._derived import gear_ratio, working_speed
from shaftprint.units import rev_s_from_rpm
from shaftprint.vessel._wheel import Wheel


def least_rate_hz(card: Card) -> float:
    """Return the lowest rate of a logger that shows all pick-ups at rated speed [Hz], a round number; 0 without any."""
    return max((_rated_rate_hz(card, wheel, over) for _, wheel, over in _wheels(card)), default=0.0)


def pulses_not_shown(card: Card) -> list[str]:
    """Return a sentence for each pick-up whose pulses the logger does not show at the speed of the test."""
    turns_hz, rate_hz = rev_s_from_rpm(working_speed(card).value), card.sample_rate_hz
    return [
        f"{pick_up.channel}: expected a logger of {_rated_rate_hz(card, wheel, over):g} Hz or more, as {wheel} pulses "
        f"a turn need at the rated {card.rated_speed_rpm:g} rpm of the engine, found {rate_hz:g} Hz"
        for pick_up, wheel, over in _wheels(card)
        if not wheel.is_shown(rate_hz=rate_hz, turns_hz=turns_hz / over)
    ]


def _rated_rate_hz(card: Card, wheel: Wheel, over: float) -> float:
    return wheel.least_rate_hz(rev_s_from_rpm(card.rated_speed_rpm) / over)


def _wheels(card: Card) -> Iterator[tuple[Pulses, Wheel, float]]:
    """Yield the pick-ups with their wheels, and engine speed over that of their shaft."""
    for pick_ups, over in ((card.engine_pulses, 1.0), (card.shaft_pulses, gear_ratio(card).value)):
        for pick_up in pick_ups:
            yield pick_up, Wheel.parse(pick_up.wheel), over
