"""A server with a small store: two ships, each given to other people, and one job, upload and event of each."""

import shutil
from dataclasses import dataclass, replace
from datetime import UTC, datetime

import pytest
from tests.web.client import Browser

pytest.importorskip("starlette", reason="pages need starlette")
pytest.importorskip("sqlalchemy", reason="a store needs SQLAlchemy")

from benchmarks.store_documents import document

from shaftprint import __version__
from shaftprint.store import JobRequest, add_document, create_store, enqueue, open_store, record_event
from shaftprint.web import Listen, Serving, with_user
from shaftprint.web._kept import KeptJob, Upload
from shaftprint.web._server import guarded
from shaftprint.web._service import Service
from shaftprint.web.access._password import hashed
from shaftprint.web.access._person import Person, Role

NOW = datetime(2026, 11, 24, 12, tzinfo=UTC)
PASSWORD = "twelve letters"  # noqa: S105
ADA, HIDDEN = 9074729, 9000003


class Desk:
    """What a process beside the server would answer."""

    def __init__(self):
        self.asked = []

    async def ask(self, question, *, longest_s):
        self.asked.append(question)
        return {
            "word": "unchanged",
            "sentences": ["No."],
            "not_trustworthy": [],
            "causes": None,
            "differences": [],
            "files": [],
            "left_out": [],
            "tables": [],
        }

    async def rest(self):
        """Do nothing."""

    close = rest


@dataclass
class Site:
    """A server, and what is in it."""

    service: Service
    shas: dict[int, list[str]]
    jobs: dict[int, int]
    uploads: dict[int, str]

    def browser(self, **further):
        return Browser(application=guarded(self.service), **further)

    def person(self, name):
        return self.browser().signed_in(name, PASSWORD)


@pytest.fixture(scope="session")
def password_hash():
    return hashed(PASSWORD)


@pytest.fixture(scope="session")
def kept(tmp_path_factory, password_hash):
    """The store and the users' file that every server begins with a copy of, and the hashes of what is in the store."""
    folder = tmp_path_factory.mktemp("kept")
    shas = _filled(folder / "fleet.db")
    for role in Role:
        for who, ships in (("ada", (str(ADA),)), ("hidden", (str(HIDDEN),)), ("all", ("all",))):
            person = Person(name=f"{role.name.lower()}-{who}", role=role, ships=ships, password=password_hash)
            with_user(folder / "users.toml", person)
    return folder, shas


@pytest.fixture
def made(tmp_path, kept):
    """Give what makes a server."""
    services = []

    def make(*, users=True, **further):
        folder, shas = kept
        store = tmp_path / "fleet.db"
        shutil.copy(folder / "fleet.db", store)
        path = shutil.copy(folder / "users.toml", tmp_path / "users.toml") if users else None
        serving = Serving(
            store=str(store),
            state=tmp_path / "state",
            users=path,
            listen=Listen(host="127.0.0.1", port=8080),
            **further,
        )
        service = replace(Service.begun(serving, now=lambda: NOW), desk=Desk())
        services.append(service)
        site = Site(service=service, shas=shas, jobs={}, uploads={})
        _with_jobs(site)
        return site

    yield make
    for service in services:
        service.kept.close()
        service.store.close()


@pytest.fixture
def site(made):
    return made()


def _filled(path):
    shas = {}
    with create_store(str(path)) as store:
        for imo, name in ((ADA, "Ada"), (HIDDEN, "Hidden")):
            ship = {"name": name, "imo_number": imo, "line": "port", "class_name": "Stan Tug 1205"}
            shas[imo] = [
                add_document(
                    store,
                    document(
                        tested_at=f"20{year}-03-01T10:00:00+01:00", recording=f"{imo + year:064x}", ship=ship, seed=year
                    ),
                    named=name,
                    now=NOW,
                ).sha256
                for year in (25, 26)
            ]
            record_event(store, str(imo), "docking", at=datetime(2025, 9, 1, tzinfo=UTC), note=f"dock of {name}")
    return shas


def _with_jobs(site):
    with open_store(site.service.serving.store) as store:
        for imo, name in ((ADA, "Ada"), (HIDDEN, "Hidden")):
            args = {"recording": f"/data/{name}.nc", "vessel": "stan-tug-1205", "campaign": "short", "imo": imo}
            (job,) = enqueue(store, [JobRequest(key=f"{imo:064x}", args=args, version=__version__)], now=NOW)
            site.jobs[imo] = job.id
            kept = site.service.kept
            at = NOW.isoformat()
            kept.put_job(
                KeptJob(id=job.id, imo=imo, ship=name, line="port", name=f"{name}.nc", person="x", at=at, args=args)
            )
            site.uploads[imo] = f"{imo:016x}"
            folder = site.service.recordings / site.uploads[imo]
            folder.mkdir()
            (folder / f"{name}.nc").write_bytes(b"no recording")
            kept.put_upload(
                Upload(
                    id=site.uploads[imo],
                    imo=imo,
                    ship=name,
                    line="port",
                    name=f"{name}.nc",
                    size=12,
                    sha256="ab" * 32,
                    person="x",
                    at=at,
                )
            )
