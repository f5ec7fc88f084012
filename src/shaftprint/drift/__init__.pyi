from ._class_numbers import Sister, sister_of
from ._dated import Event
from ._differ import differ
from ._finding import Finding
from ._history import History, history_of
from ._shared_errors import shared_errors
from ._sisters import judge_sisters
from ._watch import watch

__all__ = [
    "Event",
    "Finding",
    "History",
    "Sister",
    "differ",
    "history_of",
    "judge_sisters",
    "shared_errors",
    "sister_of",
    "watch",
]
