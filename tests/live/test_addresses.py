"""Which counterpart an address means, and what it says where a file or a protocol is missing."""

import pytest

from shaftprint.errors import LiveError, SettingsError
from shaftprint.live._play_on_board import counterpart_at
from shaftprint.live.counterparts._access import Access


@pytest.mark.parametrize(
    ("url", "name"),
    [
        ("mqtt://10.0.0.5/ship/line", "mqtt://10.0.0.5:1883/ship/line"),
        ("mqtts://10.0.0.5/ship/line", "mqtts://10.0.0.5:8883/ship/line"),
        ("sparkplug://10.0.0.5/ship/line/port", "sparkplug://10.0.0.5:1883/ship/line/port"),
    ],
)
def test_an_address_is_enough(url, name):
    assert counterpart_at(url, Access()).name == name


def test_modbus_needs_a_file(tmp_path):
    places = tmp_path / "map.toml"
    places.write_text('counter = 0\n[[channel]]\nname = "n_e"\nunit = "rpm"\naddress = 1\nkind = "float32"\n')
    counterpart = counterpart_at("modbus://10.0.0.5", Access(), places)
    assert counterpart.name == "modbus://10.0.0.5:502"
    assert [channel.name for channel in counterpart.channels] == ["n_e"]
    # without registers to command it, it is listened to
    assert not counterpart.abilities.can_be_armed
    with pytest.raises(LiveError, match=r"modbus: expected a file .*\(--places\)"):
        counterpart_at("modbus://10.0.0.5", Access())
    with pytest.raises(LiveError, match="mqtt: expected no file"):
        counterpart_at("mqtt://10.0.0.5/ship", Access(), places)
    places.write_text("counter = 0\n")
    with pytest.raises(SettingsError, match="channel"):
        counterpart_at("modbus://10.0.0.5", Access(), places)


def test_other_protocols_are_named():
    with pytest.raises(LiveError, match=r"begins with opc.tcp, mqtt, mqtts, sparkplug, .* can, found profinet"):
        counterpart_at("profinet://10.0.0.5", Access())
