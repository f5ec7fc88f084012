"""Whether whoever asked for a job may still write to its line: asked when it is begun, and again when it ends."""

from collections.abc import Callable

from shaftprint.store._job import Job
from shaftprint.store._nouns import Ship
from shaftprint.web._kept import Kept
from shaftprint.web.access._person import Role
from shaftprint.web.access._users import Users


def forbidden_by(kept: Kept, users: Users | None) -> Callable[[Job], str | None]:
    """Return what says why a job must not be done, or None.

    ``kept``: the server's own file, which says who asked for which job. ``users``: who may sign in; None where nobody
    has to.
    """

    def forbidden(job: Job) -> str | None:
        asked = kept.job(job.id)
        if asked is None or users is None:
            return None
        person = users.named(asked.person)
        ship = Ship(name=asked.ship, imo_number=asked.imo)
        if person is not None and person.role >= Role.TESTER and person.sees(ship):
            return None
        return (
            f"{asked.person}, who asked for it, may not write to this line any more; somebody who may tries it again."
        )

    return forbidden
