"""A whole test over a real broker: the simulated ship and its device behind plain blocks of MQTT."""

import asyncio

import numpy as np
import pytest

pytest.importorskip("aiomqtt", reason='MQTT needs "shaftprint[mqtt]"')

from tests.live.mqtt_device import PlainFront, broker, mosquitto, on_board
from tests.live.rehearsed import CAMPAIGN, ENVELOPE, TUG, VESSEL

from shaftprint.errors import LiveError
from shaftprint.live._engine import LiveTest
from shaftprint.live._play import Play
from shaftprint.live._play_on_board import counterpart_at
from shaftprint.live._record import LiveRecord
from shaftprint.live._rehearse import simulated_ship_of
from shaftprint.live.counterparts._access import Access
from shaftprint.live.counterparts._faults import LinkFaults, Spell

pytestmark = pytest.mark.skipif(mosquitto() is None, reason="mosquitto is not installed")
# twice as fast as a ship
EVERY_S = 0.025


class Ship:
    """A simulated ship that does what comes over the broker."""

    is_frozen, drop, twice = False, (), ()

    def __init__(self, ship):
        self.ship, self.device = ship, ship.device

    def beat(self, count):
        if not self.ship.faults.deaf.holds(self.ship.time_s):
            self.device.hear(count, self.ship.time_s)

    def obey(self, word, content):
        now_s = self.ship.time_s
        try:
            if word == "take":
                self.device.take(now_s)
            elif word == "write":
                self.device.write(content["volts"])
            elif word == "play":
                volts = np.array(content["volts"])
                self.device.play(
                    Play(name="", start_s=content["start_s"], rate_hz=content["rate_hz"], volts=volts), now_s
                )
            elif word == "abort":
                self.device.abort(content["ramp_s"], now_s)
            else:
                self.device.release()
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
