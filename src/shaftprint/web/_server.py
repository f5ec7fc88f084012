"""The server is begun: its application behind the guard, what runs beside it, and the workers that identify."""

import asyncio
import contextlib
import os
import socket
from collections.abc import AsyncIterator, Callable, Iterator
from datetime import datetime
from typing import Final

import anyio.to_thread
import uvicorn

from shaftprint.errors import ServerError
from shaftprint.web._background import keep_judging, keep_making
from shaftprint.web._door import Door, patient_protocol
from shaftprint.web._guard import Guard
from shaftprint.web._routes import application
from shaftprint.web._service import Service, utc_now
from shaftprint.web._settings import Listen, Serving
from shaftprint.web._telling import keep_alerting
from shaftprint.web._workers import keep_workers

_THREADS: Final = 4
_MOST_HEAD: Final = 16 * 1024
_MOST_CONNECTIONS: Final = 200
_IDLE_S: Final = 15
_LAST_PORT: Final = 65535


def guarded(service: Service) -> Guard:
    """Return an application that a server of ASGI runs."""
    serving = service.serving
    return Guard(application(service), hosts=serving.host_names, is_secure=serving.is_secure)


def serve(serving: Serving, *, begun: Callable[[str], None], now: Callable[[], datetime] = utc_now) -> None:
    """Serve pages until the process is ended.

    Parameters
    ----------
    serving
        How the server is set up.
    begun
        Is told the address of the first page, once it can be opened.
    now
        The present time.

    Raises
    ------
    ShaftprintError
        If the store, the users or the server's own folder cannot be used.
    """
    _expect_free(serving.listen)
    # what it and the processes beside it make is for nobody else to read, from the first byte on
    os.umask(0o077)
    service = Service.begun(serving, now=now)
    asyncio.run(_serve(service, begun))


def _expect_free(listen: Listen) -> None:
    """Raise ServerError if another program listens there, or the address is not of this computer."""
    with socket.socket(socket.AF_INET6 if ":" in listen.host else socket.AF_INET) as trial:
        if os.name == "posix":
            # what has just ended leaves its port for a while
            trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((listen.host, listen.port))
        except OSError as refusal:
            raise ServerError(
                f"--listen {listen.host}:{listen.port}: expected an address of this computer that is free, found one "
                f"that is not ({refusal.strerror or refusal}); end the program that listens there, or name another "
                f"port, such as --listen {listen.host}:{listen.port % _LAST_PORT + 1}."
            ) from None


async def _serve(service: Service, begun: Callable[[str], None]) -> None:
    # each thread of a page has its stack and its connection
    anyio.to_thread.current_default_thread_limiter().total_tokens = _THREADS
    serving = service.serving
    files = serving.certificate or (None, None)
    config = uvicorn.Config(
        guarded(service),
        host=serving.listen.host,
        port=serving.listen.port,
        ssl_certfile=files[0],
        ssl_keyfile=files[1],
        # not each strange request: whoever sends many must not fill the disk
        log_level="error",
        access_log=False,
        server_header=False,
        date_header=False,
        proxy_headers=serving.behind_tls,
        forwarded_allow_ips="127.0.0.1",
        lifespan="off",
        ws="none",
        http=patient_protocol(Door(behind_proxy=serving.behind_tls)),
        h11_max_incomplete_event_size=_MOST_HEAD,
        limit_concurrency=_MOST_CONNECTIONS,
        timeout_keep_alive=_IDLE_S,
        timeout_graceful_shutdown=3,
    )
    server = _Server(config)
    async with _beside(service):
        telling = asyncio.create_task(_tell(server, serving, begun))
        try:
            await server.serve()
        finally:
            telling.cancel()


class _Server(uvicorn.Server):
    """A server that ends what is beside it when it is asked to end; uvicorn's own lets the signal end the process."""

    @contextlib.contextmanager
    def capture_signals(self) -> Iterator[None]:
        """Note a request to end, and no more."""
        with super().capture_signals():
            try:
                yield
            finally:
                self._captured_signals.clear()


async def _tell(server: uvicorn.Server, serving: Serving, begun: Callable[[str], None]) -> None:
    while not server.started:
        await asyncio.sleep(0.01)
    port = server.servers[0].sockets[0].getsockname()[1]
    scheme = "https" if serving.certificate is not None else "http"
    host = f"[{serving.listen.host}]" if ":" in serving.listen.host else serving.listen.host
    begun(f"{scheme}://{host}:{port}/")


@contextlib.asynccontextmanager
async def _beside(service: Service) -> AsyncIterator[None]:
    tasks = [asyncio.create_task(work(service)) for work in (keep_judging, keep_making, keep_workers, keep_alerting)]
    try:
        yield
    finally:
        for task in tasks:
            task.cancel()
        await asyncio.gather(*tasks, return_exceptions=True)
        await service.close()
