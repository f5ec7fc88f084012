"""How a server is set up: where it listens, what it keeps, and its limits."""

from dataclasses import dataclass
from ipaddress import ip_address
from pathlib import Path
from typing import Final

from shaftprint.errors import ServerError

MEGABYTE: Final = 2**20
DAYS: Final = 365
LOCAL_NAMES: Final = ("127.0.0.1", "localhost", "[::1]")


@dataclass(frozen=True, kw_only=True, slots=True)
class Listen:
    """Where a server listens."""

    host: str
    """Address of this computer, without brackets."""
    port: int
    """Port; 0 for a free one."""

    @property
    def is_local(self) -> bool:
        """Whether only this computer reaches it."""
        try:
            return ip_address(self.host).is_loopback
        except ValueError:
            return self.host == "localhost"

    @property
    def shown(self) -> str:
        """Host and port as they stand in an address."""
        return f"[{self.host}]:{self.port}" if ":" in self.host else f"{self.host}:{self.port}"


@dataclass(frozen=True, kw_only=True, slots=True)
class Serving:
    """What a server serves."""

    store: str
    """Path of the store's file, or URL of its database."""
    state: Path
    """Folder for what the server itself keeps: recordings that were uploaded, reports, its secret, who did what."""
    listen: Listen = Listen(host="127.0.0.1", port=8080)
    """Where it listens."""
    users: Path | None = None
    """File of users; None where nobody signs in."""
    alerts: Path | None = None
    """File that says who is told of changes; None where nobody is."""
    folders: tuple[Path, ...] = ()
    """Folders whose recordings may be used where they lie."""
    hosts: tuple[str, ...] = ()
    """Names under which browsers reach it, beside that of ``listen``."""
    certificate: tuple[Path, Path] | None = None
    """Files of certificate and key, for TLS."""
    behind_tls: bool = False
    """Whether a proxy in front of it speaks TLS."""
    workers: int = 1
    """Processes that identify."""
    overdue_days: int = DAYS
    """After so many days without a test a line is overdue."""
    most_upload: int = 2048 * MEGABYTE
    """Bytes of the largest recording that is taken."""
    most_memory: int = 4096 * MEGABYTE
    """Memory that a process may take which reads a user's file [bytes]."""
    longest_s: float = 600.0
    """How long such a process may take for one file [s]."""

    @property
    def most_file(self) -> int:
        """Bytes of the largest file that may be written for one recording: unpacked it is longer."""
        return 4 * self.most_upload

    def __post_init__(self) -> None:
        """Refuse what would let strangers in.

        Raises ServerError if other computers reach it and nobody has to sign in.
        """
        if self.users is None and not self.listen.is_local:
            raise ServerError(
                f"--listen {self.listen.shown}: other computers reach it, so that it needs --users FILE; make one with "
                "shaftprint serve --add-user NAME --users FILE, or listen on 127.0.0.1."
            )

    @property
    def is_secure(self) -> bool:
        """Whether browsers reach it by TLS only."""
        return self.behind_tls or self.certificate is not None

    @property
    def host_names(self) -> frozenset[str]:
        """Names that a request may call this server by, without a port."""
        own = f"[{self.listen.host}]" if ":" in self.listen.host else self.listen.host
        local = LOCAL_NAMES if self.listen.is_local else ()
        return frozenset(one.lower() for one in (own, *local, *self.hosts))


def listen_at(text: str) -> Listen:
    """Return host and port of a text such as ``0.0.0.0:8443`` or ``[::1]:8080``.

    Raises ServerError if it is no such text.
    """
    host, mark, port = text.rpartition(":")
    host = host.removeprefix("[").removesuffix("]")
    most = 65535
    if not mark or not host or not port.isascii() or not port.isdigit() or int(port) > most:
        raise ServerError(f"--listen: expected HOST:PORT, such as 127.0.0.1:8080, found {text[:60]!r}.")
    return Listen(host=host, port=int(port))
