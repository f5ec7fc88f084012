"""What every find prints with."""


def seen(line: str, as_stated: bool) -> None:
    """Print what was seen; end with 1 where it is no longer what the head of the find states."""
    print(line)  # noqa: T201
    if not as_stated:
        raise SystemExit(f"CHANGED: {line}")
