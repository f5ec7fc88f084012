"""``shaftprint serve``: pages of the store for browsers and programs."""

import webbrowser
from contextlib import suppress
from dataclasses import replace
from functools import partial
from importlib.util import find_spec
from pathlib import Path
from typing import Final

import click

from shaftprint.cli._store_options import store_option
from shaftprint.cli._terminal import answer, echo, say
from shaftprint.errors import ServerError, StoreError
from shaftprint.late import late
from shaftprint.spelling import listed

with late():
    from shaftprint.store._store import create_store
    from shaftprint.web._server import serve
    from shaftprint.web._service import refusals
    from shaftprint.web._settings import Serving, listen_at
    from shaftprint.web.access import _password, _users
    from shaftprint.web.access._person import Person

_NEEDED: Final = ("starlette", "uvicorn", "argon2", "itsdangerous", "sqlalchemy")
_STATE: Final = "shaftprint-server"
_MEGABYTE: Final = 2**20


@click.command("serve")
@store_option
@click.option("--listen", default="127.0.0.1:8080", show_default=True, metavar="HOST:PORT", help="Where to listen.")
@click.option("--users", type=click.Path(path_type=Path), help="File of users; needed where other computers reach it.")
@click.option("--add-user", metavar="NAME", help="Ask for a password, put a user into the file of --users, and end.")
@click.option(
    "--role", type=click.Choice(("reader", "tester", "owner")), default="reader", show_default=True,
    help="Role of that user.",
)  # fmt: skip
@click.option(
    "--ship", "ships", multiple=True, metavar="IMO",
    help="A ship that this user sees, or all; one without IMO number by its name. May be repeated.",
)  # fmt: skip
@click.option(
    "--state", type=click.Path(path_type=Path), default=Path(_STATE), show_default=True,
    help="Folder for uploads, reports and what the server itself keeps.",
)  # fmt: skip
@click.option(
    "--folder", "folders", multiple=True, type=click.Path(path_type=Path),
    help="Folder whose recordings may be identified where they lie. May be repeated.",
)  # fmt: skip
@click.option(
    "--alerts", type=click.Path(path_type=Path), help="File that says who is told, by mail or webhook, of a change."
)
@click.option(
    "--host", "hosts", multiple=True, metavar="NAME", help="A name by which browsers reach it. May be repeated."
)
@click.option(
    "--open", "is_opened", is_flag=True, help="Open the first page in the browser; make the store where there is none."
)
@click.option("--workers", type=click.IntRange(0, 64), default=1, show_default=True, help="Processes that identify.")
@click.option("--certificate", type=click.Path(path_type=Path), help="Certificate for TLS.")
@click.option("--key", type=click.Path(path_type=Path), help="Key of the certificate.")
@click.option("--behind-tls", is_flag=True, help="A proxy on this computer speaks TLS in front of it.")
@click.option(
    "--overdue-days", type=click.IntRange(1, 3650), default=365, show_default=True,
    help="After so many days a test is overdue.",
)  # fmt: skip
@click.option(
    "--most-upload", type=click.IntRange(1, 100_000), default=2048, show_default=True, metavar="MB",
    help="Largest recording that is taken.",
)  # fmt: skip
def command(
    url: str,
    *,
    listen: str,
    users: Path | None,
    add_user: str | None,
    role: str,
    ships: tuple[str, ...],
    state: Path,
    folders: tuple[Path, ...],
    alerts: Path | None,
    hosts: tuple[str, ...],
    workers: int,
    certificate: Path | None,
    key: Path | None,
    behind_tls: bool,
    overdue_days: int,
    most_upload: int,
    is_opened: bool,
) -> None:
    """Serve pages of the store: how each ship stands, histories, comparisons, uploads and jobs.

    Without other options for this computer alone. Every page has a twin for programs below /api/v1.
    """
    _expect_packages()
    if add_user is not None:
        _add(users, add_user, role, ships)
        return
    if (certificate is None) != (key is None):
        raise click.UsageError("--certificate and --key belong together: state both, or neither.")
    local = Serving(
        store=url,
        state=state,
        users=users,
        folders=folders,
        alerts=alerts,
        hosts=hosts,
        certificate=None if certificate is None or key is None else (certificate, key),
        behind_tls=behind_tls,
        workers=workers,
        overdue_days=overdue_days,
        most_upload=most_upload * _MEGABYTE,
    )
    where = listen_at(listen)
    try:
        serving = replace(local, listen=where)
    except ServerError as refusal:
        # what else is missing is said with it
        raise ServerError(" ".join(map(str, [refusal, *refusals(local)]))) from None
    if not serving.listen.is_local and not serving.is_secure:
        say("Passwords and pages go over the network as they are: state --certificate and --key, or --behind-tls.\n")
    if is_opened:
        # one that is there is refused and opened by the pages, which say what else is wrong with the place
        with suppress(StoreError):
            create_store(url).close()
    serve(serving, begun=partial(_begun, is_opened=is_opened))


def _begun(address: str, *, is_opened: bool) -> None:
    answer(f"Open {address}")
    if is_opened:
        webbrowser.open(address)
    echo("Ctrl-C ends it; jobs that are open go on when it is begun again.")


def _expect_packages() -> None:
    missing = [name for name in _NEEDED if find_spec(name) is None]
    if missing:
        packages = f"the package{'s' if len(missing) > 1 else ''} {listed(missing)}"
        raise ServerError(f'serve: expected {packages}, found none; pip install "shaftprint[web]".')


def _add(users: Path | None, name: str, role: str, ships: tuple[str, ...]) -> None:
    if users is None or not ships:
        raise click.UsageError("--add-user needs --users FILE and --ship, which may be all.")
    password = click.prompt("Password", hide_input=True, confirmation_prompt=True)
    shortest, longest = _password.SHORTEST, _password.LONGEST
    if not shortest <= len(password) <= longest:
        raise click.UsageError(f"expected a password of {shortest} to {longest} letters, found {len(password)}.")
    person = Person(name=name, role=_users.ROLES[role], ships=ships, password=_password.hashed(password))
    _users.with_user(users, person)
    answer(f"{name} is in {users} as {role}, ships: {', '.join(ships)}.")
