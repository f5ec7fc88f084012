"""The noun ``PlannedTest``: a plan ready to be sailed, with its rehearsal, its verdict and what would help."""

from shaftprint.design.planned_test._planned_test import PlannedTest, SailedLeg
from shaftprint.design.planned_test._rehearsal import Rehearsal, RehearsedTest, rehearse
from shaftprint.design.planned_test._remedies import Remedy, remedies
from shaftprint.design.planned_test._verdict import plan_sentences

__all__ = ["PlannedTest", "Rehearsal", "RehearsedTest", "Remedy", "SailedLeg", "plan_sentences", "rehearse", "remedies"]
