"""The shortest test: multisines that tell most of a ship's propulsion line within the limits of ship and engine.

=================== ======= ==========================================================================================
quantity            unit    meaning and sign
=================== ======= ==========================================================================================
speed share         -       mean speed of a leg over that of the first working point
amplitudes ``c_k``  -       complex amplitudes of the set point over the leg's mean speed:
                            ``Re sum_k c_k exp(j 2 pi h_k t / T)``
use                 -       peak over what a limit leaves at the working point, the margin for noise taken off
brake torque        N m     of the engine, positive when it drives; down to the negative of the motoring torque
=================== ======= ==========================================================================================

A plan is made of what is assumed of the ship (``AssumedShip``), what is wanted (``Wish``), what ship and engine allow
(``Limits``) and the noise. Its accuracy is that of ``predict_joint_accuracy``, and a prediction until it is rehearsed.
"""

from shaftprint.design._assumed_ship import AssumedShip, assumed_ship, ship_of_fit
from shaftprint.design._brief import Brief
from shaftprint.design._campaign import campaign_of
from shaftprint.design._design import best_plan, design_campaign
from shaftprint.design._finish import plan_of_lines
from shaftprint.design._known_ship import limits_of_fingerprint, ship_before_test, ship_of_fingerprint
from shaftprint.design._leg import Leg
from shaftprint.design._limits import Limits, limits_from_vessel, usual_speeds
from shaftprint.design._plan import Peaks, Plan
from shaftprint.design._plan_test import Knowledge, plan_test
from shaftprint.design._planned_test import PlannedTest, SailedLeg
from shaftprint.design._rehearsal import Rehearsal, Sailing, rehearse
from shaftprint.design._remedies import Remedy, remedies
from shaftprint.design._replan import replan
from shaftprint.design._set_point_line import SetPointLine, line_of_fingerprint
from shaftprint.design._shortest import shortest
from shaftprint.design._standing import Standing, standing_of
from shaftprint.design._timetable import Timetable
from shaftprint.design._verdict import plan_sentences
from shaftprint.design._wish import Wish, no_worse_than
from shaftprint.design.files import (
    CAMPAIGN,
    CSV,
    GENERATOR,
    MAT,
    PLAN,
    RATE_HZ,
    SetPointSamples,
    read_plan,
    set_point_samples,
    write_plan,
    write_plan_files,
)
from shaftprint.design.operation import (
    LimitUse,
    Operation,
    expected_operation,
    limit_uses,
    recorded_operation,
    stated_limits,
)
from shaftprint.design.search import Effort
from shaftprint.design.views import (
    AbortCard,
    LengthCurve,
    LineWorth,
    PlannedMotion,
    abort_card,
    length_curve,
    line_worths,
    planned_motion,
)

__all__ = [
    "CAMPAIGN",
    "CSV",
    "GENERATOR",
    "MAT",
    "PLAN",
    "RATE_HZ",
    "AbortCard",
    "AssumedShip",
    "Brief",
    "Effort",
    "Knowledge",
    "Leg",
    "LengthCurve",
    "LimitUse",
    "Limits",
    "LineWorth",
    "Operation",
    "Peaks",
    "Plan",
    "PlannedMotion",
    "PlannedTest",
    "Rehearsal",
    "Remedy",
    "SailedLeg",
    "Sailing",
    "SetPointLine",
    "SetPointSamples",
    "Standing",
    "Timetable",
    "Wish",
    "abort_card",
    "assumed_ship",
    "best_plan",
    "campaign_of",
    "design_campaign",
    "expected_operation",
    "length_curve",
    "limit_uses",
    "limits_from_vessel",
    "limits_of_fingerprint",
    "line_of_fingerprint",
    "line_worths",
    "no_worse_than",
    "plan_of_lines",
    "plan_sentences",
    "plan_test",
    "planned_motion",
    "read_plan",
    "recorded_operation",
    "rehearse",
    "remedies",
    "replan",
    "set_point_samples",
    "ship_before_test",
    "ship_of_fingerprint",
    "ship_of_fit",
    "shortest",
    "standing_of",
    "stated_limits",
    "usual_speeds",
    "write_plan",
    "write_plan_files",
]
