"""Whether a ship has changed between tests, and what has changed: arithmetic on fingerprints, no database.

================ ====== ==========================================================================================
quantity         unit   meaning
================ ====== ==========================================================================================
``size``         -, s   change of a cause: a share of what it moves, negative where it has become less; of delays a time
``score``        -      size over its standard deviation
``odds``         -      likelihood of the difference under the best cause over that under another
================ ====== ==========================================================================================
"""

from shaftprint.drift._along import Whitened, p_value_of_largest, whitened
from shaftprint.drift._causes import ALL_CAUSES, CAUSES, Cause, may_happen
from shaftprint.drift._class_finding import (
    CauseSpread,
    ClassFinding,
    NumberSpread,
    ShipNumber,
    ShipSize,
    ShipStanding,
)
from shaftprint.drift._class_numbers import NEWEST_TESTS, Sister, sister_of
from shaftprint.drift._dated import EVENTS, DatedTest, Event
from shaftprint.drift._differ import LOAD_REPEATABILITY, differ
from shaftprint.drift._discoveries import discoveries
from shaftprint.drift._drift_finding import DatedCause, Drift, WatchFinding
from shaftprint.drift._finding import Finding, ShipChange, SizedCause
from shaftprint.drift._history import History, history_of
from shaftprint.drift._pair import Pair, pair_of
from shaftprint.drift._shared_errors import FieldChange, SharedErrors, are_two_lines, shared_errors
from shaftprint.drift._sister_words import sister_sentences
from shaftprint.drift._sisters import FEWEST_SISTERS, judge_sisters
from shaftprint.drift._time_to_limit import TimeToLimit, time_to_limit
from shaftprint.drift._visible import VisibleChange, visible_changes
from shaftprint.drift._watch import watch
from shaftprint.drift._words import finding_sentences, limit_sentence, watch_sentences

__all__ = [
    "ALL_CAUSES",
    "CAUSES",
    "EVENTS",
    "FEWEST_SISTERS",
    "LOAD_REPEATABILITY",
    "NEWEST_TESTS",
    "Cause",
    "CauseSpread",
    "ClassFinding",
    "DatedCause",
    "DatedTest",
    "Drift",
    "Event",
    "FieldChange",
    "Finding",
    "History",
    "NumberSpread",
    "Pair",
    "SharedErrors",
    "ShipChange",
    "ShipNumber",
    "ShipSize",
    "ShipStanding",
    "Sister",
    "SizedCause",
    "TimeToLimit",
    "VisibleChange",
    "WatchFinding",
    "Whitened",
    "are_two_lines",
    "differ",
    "discoveries",
    "finding_sentences",
    "history_of",
    "judge_sisters",
    "limit_sentence",
    "may_happen",
    "p_value_of_largest",
    "pair_of",
    "shared_errors",
    "sister_of",
    "sister_sentences",
    "time_to_limit",
    "visible_changes",
    "watch",
    "watch_sentences",
    "whitened",
]
