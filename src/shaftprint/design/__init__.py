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

Folders: ``inputs`` is what a plan is made of, ``motion`` what a leg does to the ship. ``search`` finds the strongest
lines, ``planning`` makes a ``plan`` of them. A ``planned_test`` is a plan that is ready to be sailed, ``standing`` how
far it has come. ``files`` keep it, ``views`` show it. ``operation`` is where a test, planned or sailed, leaves limits.
"""

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
from shaftprint.design.inputs import (
    AssumedShip,
    GaugeRange,
    Knowledge,
    Limits,
    SetPointLine,
    Wish,
    assumed_ship,
    limits_from_vessel,
    limits_of_fingerprint,
    line_of_fingerprint,
    no_worse_than,
    possible_ship,
    ship_before_test,
    ship_of_fingerprint,
    ship_of_fit,
    usual_speeds,
)
from shaftprint.design.motion import expect_motion
from shaftprint.design.operation import (
    LimitUse,
    Operation,
    expected_operation,
    inputs_left_out,
    limit_uses,
    recorded_operation,
    stated_limits,
)
from shaftprint.design.plan import Leg, Peaks, Plan, Timetable, campaign_of, length_words
from shaftprint.design.planned_test import (
    PlannedTest,
    Rehearsal,
    RehearsedTest,
    Remedy,
    SailedLeg,
    plan_sentences,
    rehearse,
    remedies,
)
from shaftprint.design.planning import Brief, best_plan, design_campaign, plan_of_lines, plan_test, replan, shortest
from shaftprint.design.search import Effort
from shaftprint.design.standing import Standing, standing_of
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
    "GaugeRange",
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
    "RehearsedTest",
    "Remedy",
    "SailedLeg",
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
    "expect_motion",
    "expected_operation",
    "inputs_left_out",
    "length_curve",
    "length_words",
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
    "possible_ship",
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
