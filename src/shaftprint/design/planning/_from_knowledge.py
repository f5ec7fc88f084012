"""The verb ``plan_test``: from what is known of a ship and wished of its test to a planned test."""

from collections.abc import Callable
from datetime import datetime

import numpy as np

from shaftprint.design.inputs._knowledge import Knowledge
from shaftprint.design.inputs._wish import Wish
from shaftprint.design.plan._plan import Plan
from shaftprint.design.plan._timetable import STAIRS, Timetable
from shaftprint.design.planned_test._planned_test import PlannedTest
from shaftprint.design.planned_test._remedies import remedies
from shaftprint.design.planning._band import with_band
from shaftprint.design.planning._design import design_campaign
from shaftprint.design.planning._shortest import shortest
from shaftprint.design.search._search import Effort
from shaftprint.units import SECONDS_PER_MINUTE

# A shorter test has no staircase unless it is asked for: it would be a fifth of it, or more.
_WITH_STAIRS_S = 300.0


def plan_test(
    knowledge: Knowledge,
    wish: Wish,
    *,
    name: str,
    within_s: float,
    now: datetime,
    is_shortest: bool = False,
    stairs: bool | None = None,
    seed: int = 1,
    effort: Effort | None = None,
    tell: Callable[[str], None] | None = None,
) -> PlannedTest:
    """Return the strongest test within a time, or the shortest for the wishes; with what would help if none meets them.

    Parameters
    ----------
    knowledge
        What is known of the ship.
    wish
        What is wanted.
    name
        Name of the test.
    within_s
        Length of the test, or the longest that may be sailed [s].
    now
        When it is planned, with time zone.
    is_shortest
        Whether a shorter test is looked for.
    stairs
        Whether the test ends with a staircase of a minute, on which the model is tried and limits show; None: that of
        five minutes and more does.
    seed
        Of the possible ships and the starts of the search.
    effort
        What each search may cost.
    tell
        Is told what is being done.

    Raises
    ------
    DesignError
        If there is no such plan: no room below a limit, too little time, an unknown wish.
    """
    say = tell or _silent

    def has_stairs(seconds: float) -> bool:
        return seconds >= _WITH_STAIRS_S if stairs is None else stairs

    def design(seconds: float, speeds: tuple[float, ...] = tuple(knowledge.noise)) -> Plan:
        say(f"{seconds / SECONDS_PER_MINUTE:.3g} min at {len(speeds)} speed{'s' if len(speeds) > 1 else ''}")
        nearest = {
            share: knowledge.noise[min(knowledge.noise, key=lambda sailed: abs(sailed - share))] for share in speeds
        }
        plan = design_campaign(
            knowledge.ship,
            wish,
            knowledge.limits,
            nearest,
            speeds=speeds,
            within_s=seconds,
            rng=np.random.default_rng(seed),
            priors=knowledge.priors,
            timetable=Timetable(stairs=STAIRS if has_stairs(seconds) else ()),
            effort=effort,
        )
        return with_band(
            plan,
            noise_spread=knowledge.noise_spread,
            noise_is_assumed=knowledge.noise_is_assumed,
            possible=knowledge.possible,
            rng=np.random.default_rng(seed),
        )

    plan = shortest(design, longest_s=within_s) if is_shortest else design(within_s)
    help_needed = bool(wish.names) and not plan.is_enough
    return PlannedTest(
        name=name,
        vessel=knowledge.vessel,
        plan=plan,
        line=knowledge.line,
        created=now,
        noise_source=knowledge.noise_source,
        remarks=knowledge.remarks,
        remedies=remedies(plan, lambda speeds: design(within_s, speeds)) if help_needed else (),
    )


def _silent(text: str) -> None:
    """Say nothing."""
