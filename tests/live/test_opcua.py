"""OPC UA: a real server around a simulated ship, in the time of the clock."""

import asyncio
import importlib
import logging
from datetime import UTC, datetime, timedelta

import numpy as np
import pytest
from tests.live.mqtt_device import free_port
from tests.live.rehearsed import CAMPAIGN, ENVELOPE, TUG, VESSEL, leg

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.live._block import DeviceMode
from shaftprint.live._counterpart import SILENT_S
from shaftprint.live._engine import LiveTest
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live._watch import AbortRule
from shaftprint.live.counterparts import _opcua_server
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._faults import LinkFaults
from shaftprint.live.counterparts._opcua import QUEUE, OpcUaCounterpart
from shaftprint.live.counterparts._opcua_server import SimulatedServer

pytest.importorskip("asyncua", reason="belongs to the extra opcua")
# the library's own threads and sockets end after its server has
pytestmark = [pytest.mark.slow, pytest.mark.filterwarnings("ignore::ResourceWarning")]

ONE_LEG = CAMPAIGN.model_copy(
    update={
        "multisines": (
            type(CAMPAIGN.multisines[0]).model_validate(
                leg("M1", level_v=-4.9, start_s=1.5, settled_s=2.0, stop_s=4.1, period_s=1.0)
            ),
        ),
        "ramp_s": 0.5,
        "duration_s": 5.0,
    }
)


@pytest.fixture(autouse=True)
def _quiet():
    logging.disable(logging.CRITICAL)
    yield
    logging.disable(logging.NOTSET)


def free_address():
    return f"opc.tcp://127.0.0.1:{free_port()}"


def with_server(work, *, faults=None, is_insecure=True):
    """Run what is done with a counterpart at a server around a ship."""

    async def done():
        ship = simulated_ship_of(VESSEL, ONE_LEG, seed=1, faults=faults or LinkFaults(), tug=TUG)
        # compiled before the clock runs
        ship.sail()
        async with SimulatedServer(ship, free_address()) as server:
            counterpart = OpcUaCounterpart(server.url, access=Access(is_insecure=is_insecure))
            await counterpart.connect()
            try:
                return await work(counterpart, server)
            finally:
                await counterpart.close()

    return asyncio.run(done())


def played_at_last(tmp_path, wanted, **options):
    """Play until it ends as it should: where the computer stands still for half a second, refusing is right."""
    for number in range(4):
        folder = tmp_path / str(number)
        folder.mkdir()
        outcome, test, server = played(folder, **options)
        if wanted(outcome):
            break
    return outcome, test, server


def played(tmp_path, *, shown=lambda test, sight, server: None, **options):
    async def work(counterpart, server):
        record = LiveRecord(tmp_path / "test.nc", counterpart.channels, {})
        test = LiveTest(
            counterpart=counterpart,
            vessel=VESSEL,
            campaign=ONE_LEG,
            envelope=ENVELOPE,
            record=record,
            alive_s=1.0,
            shown=lambda test, sight: shown(test, sight, server),
        )
        try:
            return await test.run(), test, server
        finally:
            record.close()

    return with_server(work, **options)


def test_a_test_is_played_over_the_network_and_no_block_is_lost(tmp_path):
    outcome, test, server = played_at_last(tmp_path, lambda one: one.word == "played")
    assert (outcome.word, outcome.is_back) == ("played", True)
    assert server.ship.device.mode is DeviceMode.LEVER
    assert not {"lost", "doubled", "link", "clock"} & {event.kind for event in test.record.events}
    assert [one.periods for one in outcome.judgements] == [2, 2, 2]
    # what was put out is the campaign: its largest set point is that of the waveform
    volts = [volts for _, volts, *_ in server.ship.trace]
    level, high = ONE_LEG.multisines[0].extremes_v
    assert min(volts) == pytest.approx(min(level, -5.0), abs=0.05)
    assert max(volts) == pytest.approx(high, abs=0.05)


def test_a_server_that_goes_silent_is_noticed_and_the_ship_reverts(tmp_path):
    def freeze(test, sight, server):
        if test.is_ruling and test.campaign_s > 4.3:
            server.is_frozen = True

    outcome, _, server = played_at_last(tmp_path, lambda one: one.campaign is not None, shown=freeze)
    assert outcome.breach.rule is AbortRule.DATA
    assert not outcome.is_back
    # nobody has told it
    assert [name for name, _ in server.heard] == ["Take", "Take", "Play"]
    assert server.ship.device.mode is DeviceMode.LEVER


def test_what_is_asked_of_a_silent_link_ends_within_its_time():
    async def work(counterpart, server):
        await counterpart.read(5.0)
        server.is_frozen = True
        loop = asyncio.get_running_loop()
        begun_s = loop.time()
        for asked in (counterpart.take, counterpart.release, lambda: counterpart.abort(2.0)):
            with pytest.raises(SilentLinkError):
                await asked()
        while True:
            try:
                await counterpart.read(SILENT_S)
            except SilentLinkError:
                return loop.time() - begun_s

    assert with_server(work) < 60.0


@pytest.mark.parametrize("kind", ["UInt32", "Double"])
def test_the_heartbeat_is_a_number_of_the_kind_that_the_server_has(monkeypatch, kind):
    monkeypatch.setattr(_opcua_server, "HEARTBEAT", kind)

    async def work(counterpart, server):
        await counterpart.beat(70_000)
        node = server._heartbeat
        return (await node.read_data_value()).Value

    written = with_server(work)
    assert (written.VariantType.name, written.Value) == (kind, 70_000)


def test_a_heartbeat_that_would_overflow_is_refused(monkeypatch):
    monkeypatch.setattr(_opcua_server, "HEARTBEAT", "UInt16")
    with pytest.raises(LiveError, match=r"expected a Heartbeat of the kind Int64, .*, found UInt16"):
        with_server(lambda counterpart, server: asyncio.sleep(0))


def test_nothing_is_written_without_user_and_encryption():
    async def work(counterpart, server):
        # who may not take over has nothing to give back either
        commands = (counterpart.take, lambda: counterpart.beat(1), lambda: counterpart.abort(2.0), counterpart.release)
        for asked in commands:
            with pytest.raises(LiveError, match="--insecure"):
                await asked()
        return server.heard

    assert with_server(work, is_insecure=False) == []


def made_certificate(path, name):
    """A certificate that signs itself, with its key behind it; and one file with the certificate alone."""
    x509 = pytest.importorskip("cryptography.x509")
    from_library = importlib.import_module
    rsa = from_library("cryptography.hazmat.primitives.asymmetric.rsa")
    hashes = from_library("cryptography.hazmat.primitives.hashes")
    forms = from_library("cryptography.hazmat.primitives.serialization")
    key = rsa.generate_private_key(public_exponent=65537, key_size=2048)
    subject = x509.Name([x509.NameAttribute(x509.oid.NameOID.COMMON_NAME, name)])
    now = datetime.now(UTC)
    certificate = (
        x509.CertificateBuilder()
        .subject_name(subject)
        .issuer_name(subject)
        .public_key(key.public_key())
        .serial_number(x509.random_serial_number())
        .not_valid_before(now - timedelta(days=1))
        .not_valid_after(now + timedelta(days=1))
        .add_extension(x509.SubjectAlternativeName([x509.UniformResourceIdentifier(f"urn:{name}")]), critical=False)
        .sign(key, hashes.SHA256())
    ).public_bytes(forms.Encoding.PEM)
    private = key.private_bytes(forms.Encoding.PEM, forms.PrivateFormat.PKCS8, forms.NoEncryption())
    both, alone = path / f"{name}.pem", path / f"{name}-alone.pem"
    both.write_bytes(certificate + private)
    alone.write_bytes(certificate)
    return both, alone


def test_a_server_is_known_by_its_certificate(tmp_path):
    mine, _ = made_certificate(tmp_path, "client")
    servers, its_own = made_certificate(tmp_path, "server")
    _, of_another = made_certificate(tmp_path, "another")

    async def asked(address, authority):
        counterpart = OpcUaCounterpart(address, access=Access(certificate=mine, authority=authority))
        try:
            await counterpart.connect()
            await counterpart.beat(1)
            await asyncio.sleep(0.2)
            await counterpart.take()
        finally:
            await counterpart.close()

    async def done():
        ship = simulated_ship_of(VESSEL, ONE_LEG, seed=1, faults=LinkFaults(), tug=TUG)
        ship.sail()
        async with SimulatedServer(ship, free_address(), certificate=servers) as server:
            await asked(server.url, its_own)
            with pytest.raises(LiveError, match="--authority"):
                await asked(server.url, None)
            with pytest.raises(LiveError):
                await asked(server.url, of_another)
            return [name for name, _ in server.heard]

    assert asyncio.run(done()) == ["Take"]


def test_a_queue_that_overflows_is_a_finding_with_a_gap():
    async def work(counterpart, server):
        found = []
        first = await counterpart.read(5.0)
        # the server publishes nothing for longer than its queue holds
        held = server.heard
        payload = bytes(await server._block.read_value())
        counterpart.take_value(payload, overflowed=True)
        # what nobody reads does not fill the memory: the oldest go, and the counter has a gap
        for _ in range(2 * QUEUE):
            counterpart.take_value(payload, overflowed=len(counterpart._blocks) == QUEUE)
        assert len(counterpart._blocks) == QUEUE
        while not found:
            block = await counterpart.read(5.0)
            found = [block] if block.findings else []
        return first, found[0], held

    first, block, _ = with_server(work)
    assert QUEUE * first.span_s >= 10.0
    assert block.findings == ("the queue of the server has overflowed: blocks before this were lost",)
    assert np.isfinite(block.source_s)


@pytest.mark.parametrize("url", ["opc.tcp://me:secret@host", "http://host", "opc.tcp://"])
def test_addresses_that_are_none_or_hold_a_secret_are_refused_without_it(url):
    with pytest.raises(LiveError) as found:
        OpcUaCounterpart(url)
    assert "secret" not in str(found.value)
