"""From inputs to a plan: what is laid down before the search, the lines that it finds, and their amplitudes."""

from shaftprint.design.planning._band import with_band
from shaftprint.design.planning._brief import Brief
from shaftprint.design.planning._design import best_plan, design_campaign
from shaftprint.design.planning._finish import FINE, SHARE_HELD, extremes, plan_of_lines
from shaftprint.design.planning._from_knowledge import plan_test
from shaftprint.design.planning._replan import replan
from shaftprint.design.planning._shortest import shortest

__all__ = [
    "FINE",
    "SHARE_HELD",
    "Brief",
    "best_plan",
    "design_campaign",
    "extremes",
    "plan_of_lines",
    "plan_test",
    "replan",
    "shortest",
    "with_band",
]
