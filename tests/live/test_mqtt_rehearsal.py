"""A whole test over a real broker: the simulated ship and its device behind plain blocks of MQTT."""

import asyncio

import numpy as np
import pytest

pytest.importorskip("aiomqtt", reason='MQTT needs "shaftprint[mqtt]"')

from tests.live.mqtt_device import PlainFront, broker, mosquitto, on_board
from tests.live.rehearsed import CAMPAIGN, ENVELOPE, TUG, VESSEL

import shaftprint as sp
from shaftprint.errors import LiveError
from shaftprint.live._engine import LiveTest
from shaftprint.live._play_on_board import counterpart_at
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import rehearse, simulated_ship_of
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._faults import LinkFaults, Spell

pytestmark = pytest.mark.skipif(mosquitto() is None, reason="mosquitto is not installed")
# twice as fast as a ship
EVERY_S = 0.025


class Ship:
    """A simulated ship that does what comes over the broker."""

    is_frozen, drop, twice = False, (), ()

    def __init__(self, ship):
        self.ship = ship

    def beat(self, count):
        self.ship.hear(count)

    def obey(self, word, content):
        try:
            self.ship.obey(word, content)
        except LiveError as error:
            return str(error)
        return ""

    def block(self):
        return self.ship.sail()[0]


def played(folder, faults):
    ship = simulated_ship_of(VESSEL, CAMPAIGN, seed=1, faults=faults, tug=TUG)

    # what it compiles at its first block would look like a link that is silent
    ship.sail()

    async def both(port):
        front = PlainFront(Ship(ship), channels=ship.channels)
        counterpart = counterpart_at(f"mqtt://127.0.0.1:{port}/ship/line", Access(is_insecure=True))
        async with on_board(front, port, EVERY_S):
            await counterpart.connect()
            record = LiveRecord(folder / "test.nc", counterpart.channels, {"vessel": VESSEL.name})
            slope = TUG.set_point_slope_rpm_per_v
            test = LiveTest(
                counterpart=counterpart,
                vessel=VESSEL,
                campaign=CAMPAIGN,
                envelope=ENVELOPE,
                record=record,
                slope_rpm_per_v=slope,
            )
            try:
                outcome = await test.run()
            finally:
                record.close()
                await counterpart.close()
            # what the device does when the program is gone
            await asyncio.sleep(1.0)
        return outcome

    with broker(folder) as (_, port):
        return asyncio.run(asyncio.wait_for(both(port), 300.0)), ship


@pytest.mark.long
def test_a_test_is_played_over_a_broker(tmp_path):
    outcome, ship = played(tmp_path, LinkFaults())
    assert outcome.word == "played", outcome
    put_out = np.array([row[1] for row in ship.trace])
    assert put_out.max() > -4.3
    assert ship.trace[-1][4] == "lever"


@pytest.mark.long
def test_a_heartbeat_that_is_not_heard_ends_it(tmp_path):
    outcome, ship = played(tmp_path, LinkFaults(deaf=Spell(start_s=25.0)))
    assert outcome.word == "aborted", outcome
    assert ship.trace[-1][4] == "lever"
    assert abs(ship.trace[-1][1] - CAMPAIGN.offset_v) < 1e-9


@pytest.mark.long
@pytest.mark.parametrize("over", ["mqtt", "opcua"])
def test_a_rehearsal_goes_over_a_real_server(tmp_path, over):
    pytest.importorskip("asyncua", reason='OPC UA needs "shaftprint[opcua]"')
    outcome, left = rehearse(VESSEL, CAMPAIGN, ENVELOPE, tmp_path / "test.nc", over=over)
    assert (outcome.word, outcome.reason, outcome.is_back) == ("played", "", True)
    with sp.recording.read_recording(left.recording) as recording:
        found = sp.signals.find_tests(recording, VESSEL, sp.campaign.load_campaign(left.campaign))
        assert [abs(one.later_s) < 0.01 for one in found] == [True, True]
