"""Memory that a process may take: a file that asks for more ends in a refusal, not in a computer that stands still."""

import importlib
from importlib.util import find_spec


def limit_memory(most_bytes: int) -> None:
    """Let this process take no more memory; where the system has no such limit, nothing is done."""
    if find_spec("resource") is None:
        return
    resource = importlib.import_module("resource")
    resource.setrlimit(resource.RLIMIT_AS, (most_bytes, most_bytes))
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
