"""Rows of files whose SHA-256 is known."""

from collections.abc import Iterator, Sequence
from dataclasses import asdict
from typing import Final

import sqlalchemy as sa

from shaftprint.store._hashed_file import HashedFile
from shaftprint.store.database._tables import HASHED_FILE

_AT_A_TIME: Final = 500


class Hashes:
    """Files through one connection."""

    def __init__(self, connection: sa.Connection) -> None:
        self.connection = connection

    def of(self, paths: Sequence[str]) -> Iterator[HashedFile]:
        """Give what is known of files, in no order."""
        for start in range(0, len(paths), _AT_A_TIME):
            some = paths[start : start + _AT_A_TIME]
            for row in self.connection.execute(sa.select(HASHED_FILE).where(HASHED_FILE.c.path.in_(some))):
                yield HashedFile(**row._mapping)

    def keep(self, files: Sequence[HashedFile]) -> None:
        """Put in files, in the place of what was known of them before."""
        for start in range(0, len(files), _AT_A_TIME):
            some = files[start : start + _AT_A_TIME]
            self.connection.execute(HASHED_FILE.delete().where(HASHED_FILE.c.path.in_([one.path for one in some])))
            self.connection.execute(HASHED_FILE.insert(), [asdict(one) for one in some])
