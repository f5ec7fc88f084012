"""Local ids and lists of data channels by ISO 19848, in the words of the standard's own examples."""

import json
import re
import tomllib
from importlib.resources import files
from itertools import count

import pytest

from shaftprint.errors import SettingsError
from shaftprint.live.counterparts._channel_list import read_channel_list
from shaftprint.local_ids import SPEED, LocalId
from shaftprint.vessel import load_vessel

ENGINE = "/dnv-v2/vis-3-4a/411.1/C101/meta/qty-rotational.frequency"
TORQUE = "/dnv-v2/vis-3-11a/412.72/meta/qty-torque"
MIST = "/dnv-v2/vis-3-4a/411.1-1P/C101.31/sec/412.33i/CS6d/meta/qty~content/cnt-oil.mist/state-high/detail-no.1.to.6"


@pytest.mark.parametrize("text", [ENGINE, TORQUE, MIST, f"{ENGINE}/type-set.point"])
def test_a_local_id_is_written_as_it_is_read(text):
    assert str(LocalId.parse(text)) == text


def test_what_a_local_id_says():
    mist = LocalId.parse(MIST)
    assert (mist.version, mist.items, mist.second) == ("3-4a", ("411.1-1P", "C101.31"), ("412.33i", "CS6d"))
    assert list(mist.tags.items()) == [
        ("qty", "content"),
        ("cnt", "oil.mist"),
        ("state", "high"),
        ("detail", "no.1.to.6"),
    ]
    assert mist.own == {"qty"}
    # words for people are not part of the name
    assert str(LocalId.parse(ENGINE.replace("/meta", "/~main.engine/meta"))) == ENGINE


def test_its_topic_has_eight_places_for_tags():
    assert LocalId.parse(ENGINE).topic == "dnv-v2/vis-3-4a/411.1_C101/_/qty-rotational.frequency/_/_/_/_/_/_/_"
    assert LocalId.parse(MIST).topic.startswith("dnv-v2/vis-3-4a/411.1-1P_C101.31/412.33i_CS6d/qty~content/")


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("dnv-v2/vis-3-4a/411.1/meta/qty-torque", "a slash at its beginning"),
        ("/dnv-v3/vis-3-4a/411.1/meta/qty-torque", "/dnv-v2/"),
        ("/dnv-v2/vis-3.4a/411.1/meta/qty-torque", "vis-3-4a"),
        ("/dnv-v2/vis-3-4a/meta/qty-torque", "codes of the thing"),
        ("/dnv-v2/vis-3-4a/411.1/Sf90.3/meta/qty-torque", 'not "Sf90.3"'),
        ("/dnv-v2/vis-3-4a/411.1/sec/meta/qty-torque", "codes behind"),
        ("/dnv-v2/vis-3-4a/411.1/C101/", '"/meta/"'),
        ("/dnv-v2/vis-3-4a/411.1/C101/meta/", "at least one tag"),
        ("/dnv-v2/vis-3-4a/411.1//C101/meta/qty-torque", "between two slashes"),
        ("/dnv-v2/vis-3-4a/411.1/meta/qtytorque", 'not "qtytorque"'),
        ("/dnv-v2/vis-3-4a/411.1/meta/acnt-sea.water", 'not "acnt-sea.water"'),
        ("/dnv-v2/vis-3-4a/411.1/meta/qty-", 'behind "qty"'),
        ("/dnv-v2/vis-3-4a/411.1/meta/type-set.point/qty-torque", "in the order"),
        ("/dnv-v2/vis-3-4a/411.1/meta/qty-torque/qty-power", "each tag once"),
        ("/" + "a" * 2000, "at most 1000 letters"),
    ],
)
def test_what_is_no_local_id(text, wanted):
    with pytest.raises(ValueError, match="expected a local id") as error:
        LocalId.parse(text)
    assert wanted in str(error.value)
    assert len(str(error.value)) < 500


def test_a_local_id_that_is_of_another_quantity():
    engine, asked = LocalId.parse(ENGINE), LocalId.parse(f"{ENGINE}/type-set.point")
    assert engine.misfit(SPEED) == ""
    assert 'found "torque"' in LocalId.parse(TORQUE).misfit(SPEED)
    assert "expected a set point, found a measured value" in engine.misfit(SPEED, is_set_point=True)
    assert asked.misfit(SPEED, is_set_point=True) == ""
    # a word of one's own may mean anything
    assert LocalId.parse(ENGINE.replace("qty-", "qty~")).misfit("torque") == ""


# ---- lists ----

ROWS = [
    (ENGINE, "0010", "rpm", "Inst", "1"),
    (f"{ENGINE}/type-set.point", "0011", "1/min", "SetPoint", ""),
    (TORQUE, "", "kNm", "Inst", "0.5"),
    ("/jsmea_mac/MainEngine/ExhaustGas/Temp", "0100", "°C", "Average", "15"),
    ("/dnv-v2/vis-3-4a/411.1/C101/meta", "bad", "", "Inst", ""),
]


def as_json():
    return {
        "Package": {
            "Header": {"ShipID": "IMO1234567", "DataChannelListID": {"ID": "yard", "Version": "2", "TimeStamp": "x"}},
            "DataChannelList": {
                "DataChannel": [
                    {
                        "DataChannelID": {"LocalID": name, **({"ShortID": short} if short else {})},
                        "Property": {
                            "DataChannelType": {"Type": kind, **({"UpdateCycle": float(cycle)} if cycle else {})},
                            "Unit": {"UnitSymbol": unit, "QuantityName": "x"},
                            "Name": "words",
                        },
                    }
                    for name, short, unit, kind, cycle in ROWS
                ]
            },
        }
    }


def as_xml():
    channels = "".join(
        f"<s:DataChannel><s:DataChannelID><s:LocalID>{name}</s:LocalID>"
        + (f"<s:ShortID>{short}</s:ShortID>" if short else "")
        + "<s:NameObject><s:NamingRule>x</s:NamingRule><o:Tag xmlns:o='urn:own'>1</o:Tag></s:NameObject>"
        + f"</s:DataChannelID><s:Property><s:DataChannelType><s:Type>{kind}</s:Type>"
        + (f"<s:UpdateCycle>{cycle}</s:UpdateCycle>" if cycle else "")
        + f"</s:DataChannelType><s:Range><s:High/><s:Low/></s:Range><s:Unit><s:UnitSymbol>{unit}</s:UnitSymbol>"
        + "</s:Unit><s:Name>words</s:Name></s:Property></s:DataChannel>"
        for name, short, unit, kind, cycle in ROWS
    )
    return (
        '<?xml version="1.0" encoding="utf-8"?><s:Package xmlns:s="urn:ISO19848:SHIP_DATA_DEFINITION"><s:Header>'
        "<s:ShipID>IMO1234567</s:ShipID><s:DataChannelListID><s:ID>yard</s:ID><s:Version>2</s:Version>"
        "</s:DataChannelListID><s:VersionInformation/></s:Header><s:DataChannelList>"
        f"{channels}</s:DataChannelList></s:Package>"
    )


@pytest.fixture(params=["json", "xml"])
def channel_list(request, tmp_path):
    path = tmp_path / f"list.{request.param}"
    if request.param == "xml":
        pytest.importorskip("defusedxml")
    path.write_text(as_xml() if request.param == "xml" else json.dumps(as_json()), encoding="utf-8")
    return read_channel_list(path)


def test_a_list_says_the_same_in_both_languages(channel_list):
    assert (channel_list.ship, channel_list.version) == ("IMO1234567", "yard 2")
    rows = [(one.name, one.short_id, one.unit, one.kind) for one in channel_list.channels]
    assert rows == [
        (ENGINE, "0010", "rpm", "Inst"),
        (f"{ENGINE}/type-set.point", "0011", "rpm", "SetPoint"),
        (TORQUE, TORQUE, "kN m", "Inst"),
        ("/jsmea_mac/MainEngine/ExhaustGas/Temp", "0100", "°C", "Average"),
    ]
    assert [one.cycle_s for one in channel_list.channels] == pytest.approx([1.0, float("nan"), 0.5, 15.0], nan_ok=True)
    assert [one.local_id is None for one in channel_list.channels] == [False, False, False, True]
    assert list(channel_list.left_out) == ["/dnv-v2/vis-3-4a/411.1/C101/meta"]


def test_a_command_shows_a_list_and_what_is_wrong_in_it(run, tmp_path):
    content = as_json()
    rows = content["Package"]["DataChannelList"]["DataChannel"]
    rows.append(rows[0])
    rows.append({"DataChannelID": {"LocalID": TORQUE.replace("412.72", "412.73"), "ShortID": "0100"}})
    path, vessel = tmp_path / "list.json", tmp_path / "vessel.toml"
    path.write_text(json.dumps(content), encoding="utf-8")
    result = run("live", "channels", path, "--json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0, result.output
    assert len(document["tables"][0]["rows"]) == 5
    said = " ".join(document["answer"])
    assert "6 channels, 5 of them by the rule dnv-v2; 3 findings" in said
    assert 'at least one tag behind "/meta/"' in said
    assert f"{ENGINE}: expected a local id once, found it 2 times" in said
    assert "0100: expected values of one channel by that short id, found 2" in said
    for local_id, code, words in ((TORQUE, 0, "M_s"), (TORQUE.replace("412.72", "412.74"), 1, "not there")):
        vessel.write_text(
            f'{VESSEL}\n[[sensors.local_ids]]\nchannel = "{CHANNELS["shaft_torque"]}"\nlocal_id = "{local_id}"\n'
        )
        result = run("live", "channels", path, "--vessel", vessel)
        assert (result.exit_code, words in result.output) == (code, True), result.output


def test_channels_are_found_by_their_local_ids(channel_list):
    named = channel_list.named({"n_e": ENGINE, "torque": TORQUE})
    assert {name: channel.short_id for name, channel in named.items()} == {"n_e": "0010", "torque": TORQUE}
    with pytest.raises(SettingsError, match=r"among 4 channels, found rack: .*fuel.index not there"):
        channel_list.named({"n_e": ENGINE, "rack": "/dnv-v2/vis-3-4a/411.1/C101/meta/qty-fuel.index"})


DEEP = f'<Package xmlns="urn:ISO19848:SHIP_DATA_DEFINITION">{"<A>" * 3000}{"</A>" * 3000}</Package>'


@pytest.mark.parametrize(
    ("content", "sentence"),
    [
        (b"", "neither"),
        (b"{" * 50_000, "neither"),
        (b"[]", "found none in it"),
        (b'{"Package": {"DataChannelList": {"DataChannel": [1, {"DataChannelID": 5}]}}}', "found none among 2"),
        (b"<a", "expected XML"),
        (b"<!DOCTYPE a [<!ENTITY b 'c'>]><a>&b;</a>", "without a document type, found DTDForbidden"),
        (b"<Package/>", "found none in it"),
        (b'<?xml version="1.0" encoding="foo"?><Package/>', "found LookupError: unknown encoding: foo"),
        (DEEP.encode(), "found RecursionError"),
    ],
)
def test_what_is_no_list(tmp_path, content, sentence):
    pytest.importorskip("defusedxml")
    path = tmp_path / f"list{next(NUMBERS)}"
    path.write_bytes(content)
    with pytest.raises(SettingsError, match=sentence) as error:
        read_channel_list(path)
    assert str(path) in str(error.value)


NUMBERS = count()


# ---- in a vessel file ----

VESSEL = files("shaftprint.vessel").joinpath("shipped", "stan_tug_1205.toml").read_text(encoding="utf-8")
SENSORS = tomllib.loads(VESSEL)["sensors"]
CHANNELS = {name: SENSORS[name]["channel"] for name in ("shaft_torque", "set_point")}


@pytest.mark.parametrize(
    ("channel", "local_id", "sentence"),
    [
        ("torque", ENGINE, 'torque: expected the quantity "torque"'),
        ("set point", ENGINE, "expected the local id of a set point"),
        ("torque", "412.72", "torque: expected a local id"),
        ("nothing", TORQUE, "expected local_ids of channels that a sensor has, found nothing"),
    ],
)
def test_local_ids_of_a_vessel_file_are_checked(tmp_path, channel, local_id, sentence):
    names = {"torque": CHANNELS["shaft_torque"], "set point": CHANNELS["set_point"]}
    path = tmp_path / "vessel.toml"
    path.write_text(
        f'{VESSEL}\n[[sensors.local_ids]]\nchannel = "{names.get(channel, channel)}"\nlocal_id = "{local_id}"\n'
    )
    sentence = sentence.replace("torque:", f"{names['torque']}:")
    with pytest.raises(SettingsError, match=re.escape(sentence)):
        load_vessel(path)


def test_a_vessel_file_says_what_a_server_calls_its_channels(tmp_path):
    path = tmp_path / "vessel.toml"
    path.write_text(f'{VESSEL}\n[[sensors.local_ids]]\nchannel = "{CHANNELS["shaft_torque"]}"\nlocal_id = "{TORQUE}"\n')
    named = load_vessel(path).sensors.local_ids
    assert [(name.channel, name.local_id) for name in named] == [(CHANNELS["shaft_torque"], TORQUE)]
