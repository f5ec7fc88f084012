"""Who asks, and how safely: users, certificates, and the refusal of writing without either."""

import ssl
from dataclasses import dataclass, field
from pathlib import Path
from urllib.parse import SplitResult, urlsplit

from shaftprint.errors import LiveError
from shaftprint.escape import printable


@dataclass(frozen=True, kw_only=True, slots=True)
class Access:
    """What a link shows of itself. Secrets are asked for or come from the environment, and are printed nowhere."""

    user: str | None = None
    """Name of the user."""
    password: str | None = field(default=None, repr=False)
    """What belongs to it."""
    authority: Path | None = None
    """Certificates of those who may vouch for the other side; those of the system where not given."""
    certificate: Path | None = None
    """Certificate of this side, with its key."""
    is_insecure: bool = False
    """Whether somebody has typed that writing needs neither user nor encryption."""

    def context(self, name: str) -> ssl.SSLContext:
        """Return how TLS is spoken: certificate and host name of the other side are checked.

        ``name``: the link, for messages. Raises LiveError if a certificate cannot be loaded.
        """
        try:
            context = ssl.create_default_context(cafile=self.authority)
            if self.certificate is not None:
                context.load_cert_chain(self.certificate)
        except (OSError, ssl.SSLError) as error:
            raise LiveError(
                f"{name}: expected certificates in {self.certificate or self.authority}, found none that can be loaded "
                f"({printable(str(error))})."
            ) from None
        return context

    def expect_writer(self, name: str, *, is_encrypted: bool) -> None:
        """Refuse to write where anybody could.

        Raises LiveError if the link is not encrypted or nobody has said who he is, and that was not asked for.
        """
        if self.is_insecure:
            return
        missing = [] if is_encrypted else ["encryption"]
        if self.certificate is None and self.password is None:
            missing.append("a user or a certificate")
        if missing:
            raise LiveError(
                f"{name}: expected {' and '.join(missing)} before anything is written, found none; --insecure writes "
                "without, on a network that nobody else is on."
            )


def address(url: str, ports: dict[str, int]) -> tuple[SplitResult, str, int]:
    """Return parts, host and port of an address.

    ``ports``: usual port by scheme. Raises LiveError if it is none, or holds a password.
    """
    try:
        parts = urlsplit(url)
        host, port = parts.hostname, parts.port
    except ValueError:
        raise LiveError(f"expected an address such as {next(iter(ports))}://host, found one that is none.") from None
    if parts.password is not None or parts.username is not None:
        # not shown: addresses are seen in lists of processes and in logs
        raise LiveError("expected an address without user and password, which others could read there, found one with.")
    if parts.scheme not in ports or not host or set(url) & set("?#"):
        raise LiveError(f"expected an address such as {next(iter(ports))}://host, found {printable(url)}.")
    return parts, host, port or ports[parts.scheme]
