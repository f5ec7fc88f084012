"""Who is told of lines that change: a file of its owner, in which passwords and addresses of hooks stand alone."""

import os
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Final
from urllib.parse import urlsplit

from shaftprint.errors import ServerError
from shaftprint.files import reason

_MAIL: Final = frozenset({"to", "from", "host", "port", "tls", "user", "password"})
_HOOK: Final = frozenset({"url"})
_TLS: Final = ("starttls", "tls", "none")
_READABLE_BY_OTHERS: Final = 0o077


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Mail:
    """Where a mail goes, and through which server."""

    to: str
    sender: str
    host: str
    port: int
    tls: str
    user: str
    password: str


@dataclass(frozen=True, kw_only=True, slots=True, repr=False)
class Alerts:
    """Where alerts go."""

    mail: Mail | None
    """By mail; None where not."""
    hook: str | None
    """Address of a hook that takes JSON; None where there is none."""
    pages: str
    """What stands before the address of a page in an alert, such as ``https://yard.example``; empty for nothing."""


def read_alerts(path: Path) -> Alerts:
    """Return where alerts go, from a file that its owner alone can read.

    Raises ServerError if it cannot be used.
    """
    try:
        mode, content = path.stat().st_mode, path.read_bytes()[: 2**16]
    except OSError as refusal:
        raise ServerError(f"{path}: expected a file of alerts, but it cannot be read: {reason(refusal)}.") from None
    if os.name == "posix" and mode & _READABLE_BY_OTHERS:
        raise ServerError(f"{path}: expected a file that you alone can read, since it may hold a password; chmod 600.")
    try:
        table = tomllib.loads(content.decode())
    except (tomllib.TOMLDecodeError, UnicodeDecodeError, RecursionError):
        # what stands in it is no matter for a terminal
        raise ServerError(f"{path}: expected a file of alerts in TOML, found something else.") from None
    mail, hook, pages = table.pop("mail", None), table.pop("webhook", None), table.pop("pages", "")
    if table or not isinstance(pages, str) or (mail is None and hook is None):
        raise ServerError(f"{path}: expected the tables [mail] or [webhook] and the text pages, nothing else.")
    url = None if hook is None else _text(_table(hook, _HOOK, path, "webhook"), "url", path, "webhook")
    if url is not None and not _is_address(url):
        raise ServerError(f"{path}: [webhook] url: expected an address that begins with https:// or http://.")
    if url is not None and urlsplit(url).username is not None and urlsplit(url).scheme != "https":
        raise ServerError(
            f"{path}: [webhook] url: expected https:// where a user or password stands in it, found http."
        )
    return Alerts(mail=None if mail is None else _mail(mail, path), hook=url, pages=pages.rstrip("/"))


def _is_address(url: str) -> bool:
    try:
        place = urlsplit(url)
        return place.scheme in ("https", "http") and bool(place.hostname) and place.port != 0
    except ValueError:
        # brackets of an address that do not close, or a port that is none
        return False


def _mail(content: Any, path: Path) -> Mail:
    table = _table(content, _MAIL, path, "mail")
    tls, port = table.get("tls", _TLS[0]), table.get("port", 587)
    if tls not in _TLS:
        raise ServerError(f"{path}: [mail] tls: expected one of {', '.join(_TLS)}.")
    if not isinstance(port, int) or not 0 < port < 2**16:
        raise ServerError(f"{path}: [mail] port: expected a port such as 587.")
    to, sender, host = (_text(table, name, path, "mail") for name in ("to", "from", "host"))
    user, password = (_text(table | {name: table.get(name, "")}, name, path, "mail") for name in ("user", "password"))
    if password and tls == "none":
        raise ServerError(f"{path}: [mail] tls: expected starttls or tls where there is a password, found none.")
    return Mail(to=to, sender=sender, host=host, port=port, tls=tls, user=user, password=password)


def _table(content: Any, fields: frozenset[str], path: Path, name: str) -> dict[str, Any]:
    if not isinstance(content, dict) or set(content) - fields:
        raise ServerError(f"{path}: [{name}] expected a table of {', '.join(sorted(fields))}, found something else.")
    return content


def _text(table: dict[str, Any], name: str, path: Path, of: str) -> str:
    text = table.get(name)
    # a line break in an address would be another head of the mail
    if not isinstance(text, str) or not text.isprintable() or (not text and name not in ("user", "password")):
        raise ServerError(f"{path}: [{of}] {name}: expected a text in one line, found none.")
    return text
