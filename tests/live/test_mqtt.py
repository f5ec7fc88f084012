"""A counterpart behind a real broker: what comes is what was sent, and a link that is silent is noticed."""

import asyncio
import gc
import os
import signal
import ssl
import subprocess

import numpy as np
import pytest

pytest.importorskip("aiomqtt", reason='MQTT needs "shaftprint[mqtt]"')

from tests.live.mqtt_device import (
    ABILITIES,
    CHANNELS,
    Device,
    PlainFront,
    SparkplugFront,
    broker,
    mosquitto,
    on_board,
    until_silent,
)

from shaftprint.errors import LiveError, SilentLinkError
from shaftprint.live._block import DeviceMode
from shaftprint.live._play import Play
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._mqtt import MqttCounterpart

pytestmark = pytest.mark.skipif(mosquitto() is None, reason="mosquitto is not installed")
ANYBODY = Access(is_insecure=True)
FRONTS = {"mqtt": (PlainFront, "ship/line"), "sparkplug": (SparkplugFront, "ship/line/device")}


@pytest.fixture(scope="module")
def port(tmp_path_factory):
    with broker(tmp_path_factory.mktemp("broker")) as (_, port):
        yield port


def run(test, port, dialect, *, access=ANYBODY, **faults):
    """Run a test of (counterpart, device) with both connected."""
    front, path = FRONTS[dialect]

    async def both():
        device = Device(**faults)
        async with on_board(front(device), port):
            counterpart = MqttCounterpart(f"{dialect}://127.0.0.1:{port}/{path}", access)
            try:
                await counterpart.connect()
                await test(counterpart, device)
            finally:
                await counterpart.close()

    asyncio.run(asyncio.wait_for(both(), 30.0))


async def blocks(counterpart, number):
    return [await counterpart.read(1.0) for _ in range(number)]


@pytest.mark.parametrize("dialect", FRONTS)
def test_blocks_come_as_they_were_sent(port, dialect):
    async def test(counterpart, _):
        assert (counterpart.channels, counterpart.abilities) == (CHANNELS, ABILITIES)
        came = await blocks(counterpart, 24)
        assert [block.counter for block in came] == list(range(came[0].counter, came[0].counter + 24))
        assert [one for block in came for one in block.findings] == []
        for block in came:
            index = np.arange(100) + 100 * block.counter
            assert block.samples["torque"].dtype == np.int16
            np.testing.assert_array_equal(block.values(CHANNELS[0]), (index % 1000) * 0.5 + 10.0)
            np.testing.assert_array_equal(block.values(CHANNELS[1]), 800.0 + index / 7.0)
            assert block.values(CHANNELS[2]).tolist() == ([4.25] if block.counter % 20 == 0 else [])
            assert block.source_s == 1000.0 + 0.05 * block.counter

    run(test, port, dialect)


@pytest.mark.parametrize("dialect", FRONTS)
def test_the_device_obeys_refuses_and_goes_back(port, dialect):
    async def test(counterpart, device):
        with pytest.raises(LiveError, match=r'refuses "take": no heartbeat'):
            await counterpart.take()
        await counterpart.beat(1)
        await asyncio.sleep(0.1)
        await counterpart.take()
        await counterpart.write(5.25)
        play = Play(name="M1", start_s=12.5, rate_hz=50.0, volts=np.array([5.0, 5.1, 1 / 3]))
        await counterpart.play(play)
        word, content = device.commands[-1]
        assert word == "play"
        assert list(content["volts"]) == [5.0, 5.1, 1 / 3]
        assert (content["start_s"], content["rate_hz"]) == (12.5, 50.0)
        while (last := (await counterpart.read(1.0)).device).mode is not DeviceMode.PLAYING:
            assert last.heartbeat <= 1
        assert (last.set_point_v, last.heartbeat) == (5.25, 1)
        # the heartbeat stays away
        while (await counterpart.read(1.0)).device.mode is not DeviceMode.LEVER:
            pass

    run(test, port, dialect)


@pytest.mark.parametrize("dialect", FRONTS)
def test_lost_and_double_blocks_are_named(port, dialect):
    async def test(counterpart, _):
        came = await blocks(counterpart, 18)
        counters = [block.counter for block in came]
        assert set(range(1, counters[-1])) - set(counters) - set(range(1, counters[0])) == {8, 9, 15}
        assert len(counters) == len(set(counters))
        findings = {block.counter: block.findings for block in came if block.findings}
        lost = {10: "2 messages", 16: "1 messages"} if dialect == "sparkplug" else {}
        assert {counter for counter, said in findings.items() if "lost" in said[0]} == set(lost)
        assert all(findings[counter][0].startswith(said) for counter, said in lost.items())
        # one that comes twice is given once, and said with the next
        assert findings[13] == ("block 12 came twice.",)

    run(test, port, dialect, drop=(8, 9, 15), twice=(12,))


@pytest.mark.parametrize("dialect", FRONTS)
def test_a_device_that_is_frozen_is_noticed(port, dialect):
    async def test(counterpart, device):
        await blocks(counterpart, 2)
        device.is_frozen = True
        with pytest.raises(SilentLinkError, match="expected a block within"):
            await until_silent(counterpart, 0.5)
        with pytest.raises(SilentLinkError, match='expected an answer to "abort" within'):
            await counterpart.abort(2.0)

    run(test, port, dialect)


def test_a_broker_that_answers_nothing_is_noticed(tmp_path):
    with broker(tmp_path) as (process, port):

        async def test(counterpart, _):
            await blocks(counterpart, 2)
            os.kill(process.pid, signal.SIGSTOP)
            with pytest.raises(SilentLinkError):
                await until_silent(counterpart, 0.5)
            with pytest.raises(SilentLinkError, match="expected the broker"):
                await counterpart.take()
            with pytest.raises(SilentLinkError, match="expected the broker"):
                await MqttCounterpart(f"mqtt://127.0.0.1:{port}/ship/line").connect()
            os.kill(process.pid, signal.SIGCONT)

        run(test, port, "mqtt")


def test_a_broker_that_dies_is_noticed_at_once(tmp_path):
    with broker(tmp_path) as (process, port):

        async def test(counterpart, _):
            await blocks(counterpart, 2)
            process.kill()
            with pytest.raises(SilentLinkError, match="the broker is gone"):
                await until_silent(counterpart, 5.0)

        run(test, port, "mqtt")


def test_a_command_that_came_late_is_not_obeyed(port):
    """A device that was away finds nothing: nothing is kept for it."""
    import aiomqtt

    async def test():
        device = Device()
        front = PlainFront(device, "ship/late")
        async with on_board(front, port):
            counterpart = MqttCounterpart(f"mqtt://127.0.0.1:{port}/ship/late", ANYBODY)
            await counterpart.connect()
        with pytest.raises(SilentLinkError, match="expected an answer"):
            await counterpart.write(9.0)
        async with on_board(front, port):
            await asyncio.sleep(0.2)
        assert device.commands == []
        await counterpart.close()
        async with aiomqtt.Client("127.0.0.1", port) as client:
            await client.publish("ship/late/describe", b"", retain=True)

    asyncio.run(asyncio.wait_for(test(), 30.0))


def test_what_is_no_block_is_left_out_and_named(port):
    import aiomqtt

    async def test(counterpart, _):
        await blocks(counterpart, 1)
        async with aiomqtt.Client("127.0.0.1", port) as client:
            for payload in (b"", b"SPLB", b"\x00" * 44, b"SPLB\x01\x00\x01\x03" + b"\xff" * 60, b"x" * 5000):
                await client.publish("ship/line/block", payload, qos=1)
            await client.publish("ship/line/answer", b'{"number": []}', qos=1)
        came = await blocks(counterpart, 6)
        said = [one for block in came for one in block.findings]
        assert len(said) == 6
        assert all(one.endswith("; left out.") for one in said)
        assert [block.counter for block in came] == list(range(came[0].counter, came[0].counter + 6))

    run(test, port, "mqtt")


@pytest.mark.parametrize("dialect", FRONTS)
def test_anybody_may_listen_but_not_write(port, dialect):
    async def test(counterpart, device):
        await blocks(counterpart, 1)
        asked = (counterpart.take(), counterpart.write(5.0), counterpart.abort(2.0), counterpart.beat(1))
        for command in asked:
            with pytest.raises(LiveError, match=r"expected encryption and a user or a certificate .* --insecure"):
                await command
        assert (device.commands, device.heartbeat) == ([], 0)

    run(test, port, dialect, access=Access())


@pytest.mark.parametrize(
    "url",
    ["mqtt://host", "mqtt://host/a/#", "http://host/a", "mqtt:///a", "sparkplug://host/a/b", "mqtt://user:x@host/a"],
)
def test_addresses_that_are_none(url):
    with pytest.raises(LiveError) as error:
        MqttCounterpart(url)
    assert "user:x" not in str(error.value)


def test_a_password_is_printed_nowhere():
    access = Access(user="yard", password="very secret")  # noqa: S106
    counterpart = MqttCounterpart("mqtts://host/a", access)
    assert "secret" not in f"{access!r} {counterpart.name} {counterpart!r}"


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore::pytest.PytestUnraisableExceptionWarning")
def test_over_tls_users_may_write_and_certificates_are_checked(tmp_path):
    openssl = ["openssl", "req", "-x509", "-newkey", "rsa:2048", "-nodes", "-days", "2", "-subj", "/CN=localhost"]
    openssl += ["-addext", "subjectAltName=DNS:localhost", "-keyout", "key.pem", "-out", "cert.pem"]
    try:
        subprocess.run(openssl, cwd=tmp_path, check=True, capture_output=True)
        subprocess.run(["mosquitto_passwd", "-b", "-c", "users", "yard", "secret"], cwd=tmp_path, check=True)
    except FileNotFoundError as error:
        pytest.skip(f"{error.filename} is not installed")
    lines = [f"password_file {tmp_path}/users", f"certfile {tmp_path}/cert.pem", f"keyfile {tmp_path}/key.pem"]
    with broker(tmp_path, *lines) as (_, port):

        async def connected(authority, password):
            tls = ssl.create_default_context(cafile=tmp_path / "cert.pem")
            tls.check_hostname = False
            options = {"username": "yard", "password": "secret", "tls_context": tls}
            async with on_board(PlainFront(Device()), port, **options):
                access = Access(user="yard", password=password, authority=authority)
                counterpart = MqttCounterpart(f"mqtts://localhost:{port}/ship/line", access)
                try:
                    await counterpart.connect()
                    await counterpart.beat(1)
                    await asyncio.sleep(0.1)
                    await counterpart.take()
                finally:
                    await counterpart.close()

        asyncio.run(connected(tmp_path / "cert.pem", "secret"))
        with pytest.raises(SilentLinkError, match="certificate verify failed"):
            asyncio.run(connected(None, "secret"))
        with pytest.raises(SilentLinkError, match="expected the broker") as refusal:
            asyncio.run(connected(tmp_path / "cert.pem", "wrong one"))
        assert "wrong one" not in str(refusal.value)
        # a handshake that fails leaves its socket to the collector
        gc.collect()
