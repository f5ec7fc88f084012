from ._differ import differ
from ._finding import Finding
from ._history import History, history_of
from ._shared_errors import shared_errors
from ._sisters import judge_sisters
from ._watch import watch
from ._words import watch_sentences

__all__ = [
    "Finding",
    "History",
    "differ",
    "history_of",
    "judge_sisters",
    "shared_errors",
    "watch",
    "watch_sentences",
]
