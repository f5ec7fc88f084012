from .files._plan_folder import write_plan_files
from .files._plan_json import read_plan
from .inputs._assumed_ship import assumed_ship, ship_of_fit
from .inputs._limits import Limits, limits_from_vessel
from .inputs._set_point_line import SetPointLine
from .inputs._stated_limits import StatedLimit
from .inputs._wish import Wish, no_worse_than
from .operation._expected import expected_operation
from .operation._limit_use import limit_uses
from .operation._recorded import recorded_operation
from .plan._campaign import campaign_of
from .plan._plan import Plan
from .planned_test._planned_test import PlannedTest
from .planned_test._rehearsal import rehearse
from .planned_test._remedies import remedies
from .planned_test._verdict import plan_sentences
from .planning._design import design_campaign
from .planning._from_knowledge import plan_test
from .planning._replan import replan
from .planning._shortest import shortest
from .search._search import Effort

__all__ = [
    "Effort",
    "Limits",
    "Plan",
    "PlannedTest",
    "SetPointLine",
    "StatedLimit",
    "Wish",
    "assumed_ship",
    "campaign_of",
    "design_campaign",
    "expected_operation",
    "limit_uses",
    "limits_from_vessel",
    "no_worse_than",
    "plan_sentences",
    "plan_test",
    "read_plan",
    "recorded_operation",
    "rehearse",
    "remedies",
    "replan",
    "ship_of_fit",
    "shortest",
    "write_plan_files",
]
