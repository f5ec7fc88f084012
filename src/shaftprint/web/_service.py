"""What a running server has: the store, its own files, who may sign in, and the processes beside it."""

import contextlib
import os
import secrets
import shutil
from collections.abc import Callable
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Self

from shaftprint.errors import ServerError, ShaftprintError
from shaftprint.files import reason
from shaftprint.store._store import Store, open_store
from shaftprint.web._alerts import Alerts, read_alerts
from shaftprint.web._kept import Kept
from shaftprint.web._lines import Lines
from shaftprint.web._settings import Serving
from shaftprint.web._waking import Waking
from shaftprint.web.access._audit import Audit
from shaftprint.web.access._sessions import Sessions
from shaftprint.web.access._throttle import Throttle
from shaftprint.web.access._users import Users, read_users
from shaftprint.web.calculator._client import Calculator

_KEY_BYTES = 32


def utc_now() -> datetime:
    """Return the present time."""
    return datetime.now(UTC)


@dataclass(frozen=True, kw_only=True, slots=True)
class Service:
    """What every endpoint may use."""

    serving: Serving
    """How the server is set up."""
    store: Store
    """The store."""
    kept: Kept
    """The server's own file."""
    sessions: Sessions
    """Who is behind a cookie."""
    throttle: Throttle
    """Who has to wait before he may try a password again."""
    audit: Audit
    """Who did what."""
    lines: Lines
    """The lines of the store."""
    desk: Calculator
    """What pages wait for."""
    bench: Calculator
    """What is calculated beside them."""
    now: Callable[[], datetime] = utc_now
    """The present time."""
    alerts: Alerts | None = None
    """Who is told of changes; None where nobody is."""
    alerting: Waking = field(default_factory=Waking)
    """Wakes what tells of changes."""
    judging: Waking = field(default_factory=Waking)
    """Wakes what judges lines."""
    making: Waking = field(default_factory=Waking)
    """Wakes what makes reports and looks at recordings."""

    @classmethod
    def begun(cls, serving: Serving, *, now: Callable[[], datetime] = utc_now) -> Self:
        """Return what a server has that is set up.

        Raises ServerError if the users, the alerts, a folder or the server's own folder cannot be used; StoreError if
        the store cannot be used.
        """
        found = refusals(serving)
        if found:
            raise found[0] if len(found) == 1 else ServerError(" ".join(map(str, found)))
        users = None if serving.users is None else Users(path=serving.users)
        alerts = None if serving.alerts is None else read_alerts(serving.alerts)
        store = open_store(serving.store)
        try:
            key = _prepared(serving.state)
            kept = Kept.at(serving.state / "server.db")
        except BaseException:
            store.close()
            raise
        return cls(
            serving=serving,
            store=store,
            kept=kept,
            sessions=Sessions(key=key, users=users, _ended=kept.ended()),
            throttle=Throttle(),
            lines=Lines(store=store),
            audit=Audit(path=serving.state / "audit.jsonl"),
            desk=Calculator(store=serving.store, most_memory=serving.most_memory, scratch=_scratch(serving) / "desk"),
            bench=Calculator(store=serving.store, most_memory=serving.most_memory, scratch=_scratch(serving) / "bench"),
            now=now,
            alerts=alerts,
        )

    @property
    def recordings(self) -> Path:
        """Folder of what was uploaded."""
        return self.serving.state / "recordings"

    @property
    def reports(self) -> Path:
        """Folder of reports."""
        return self.serving.state / "reports"

    @property
    def scratch(self) -> Path:
        """Folder of the temporary files of the processes beside it."""
        return _scratch(self.serving)

    async def close(self) -> None:
        """Close its files, and end the processes beside it."""
        await self.desk.close()
        await self.bench.close()
        self.kept.close()
        self.store.close()


def _scratch(serving: Serving) -> Path:
    return serving.state / "scratch"


def refusals(serving: Serving) -> list[ShaftprintError]:
    """Return all for which a server of these settings cannot be begun: each file that is missing or cannot be read."""
    found: list[ShaftprintError] = [
        *(
            ServerError(f"--folder: expected a folder, found none at {folder}.")
            for folder in serving.folders
            if not folder.is_dir()
        ),
        *(
            ServerError(f"--certificate and --key: expected a file, found none at {file}.")
            for file in serving.certificate or ()
            if not file.is_file()
        ),
    ]
    for read in (_expect_users, _expect_alerts, _expect_store):
        try:
            read(serving)
        except ShaftprintError as refusal:
            found.append(refusal)
    return found


def _expect_users(serving: Serving) -> None:
    if serving.users is not None and not read_users(serving.users):
        raise ServerError(f"{serving.users}: expected one user at least, found none.")


def _expect_alerts(serving: Serving) -> None:
    if serving.alerts is not None:
        read_alerts(serving.alerts)


def _expect_store(serving: Serving) -> None:
    open_store(serving.store).close()


def _take_away_leftovers(state: Path) -> None:
    """Take away what a server that was killed has left: half uploads with their folders, and temporary files."""
    for left in (state / "recordings").glob("*/*.part"):
        left.unlink(missing_ok=True)
    for home in (state / "recordings").iterdir():
        # one in which a file lies is no folder that goes
        with contextlib.suppress(OSError):
            home.rmdir()
    shutil.rmtree(state / "scratch", ignore_errors=True)


def _prepared(state: Path) -> bytes:
    """Make the server's own folder for nobody else, and return its secret."""
    try:
        state.mkdir(mode=0o700, parents=True, exist_ok=True)
        for name in ("recordings", "reports", "made"):
            (state / name).mkdir(mode=0o700, exist_ok=True)
        _take_away_leftovers(state)
        secret = state / "secret"
        if not secret.exists():
            part = state / "secret.part"
            with os.fdopen(os.open(part, os.O_WRONLY | os.O_CREAT | os.O_TRUNC, 0o600), "wb") as file:
                file.write(secrets.token_bytes(_KEY_BYTES))
                os.fsync(file.fileno())
            part.replace(secret)
        key = secret.read_bytes()
    except OSError as refusal:
        raise ServerError(f"{state}: the server's own folder cannot be used: {reason(refusal)}.") from None
    if len(key) != _KEY_BYTES:
        raise ServerError(f"{secret}: expected {_KEY_BYTES} bytes, found {len(key)}; delete it, and all sign in anew.")
    return key
