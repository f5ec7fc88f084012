"""The pages of a running test: events carry the word, and nobody else is answered."""

import http.client
import json
from types import SimpleNamespace

import pytest

from shaftprint.live._block import DeviceMode, Event
from shaftprint.live._outcome import Ask, Operator
from shaftprint.live._page import LivePages
from shaftprint.live._state import State


def asked(pages, path, host=None):
    address = pages.url.removeprefix("http://").rstrip("/")
    connection = http.client.HTTPConnection(address, timeout=5.0)
    connection.request("GET", path, headers={"Host": host or address})
    return connection, connection.getresponse()


def first_event(pages):
    connection, answer = asked(pages, "/events")
    line = answer.fp.readline()
    connection.close()
    return json.loads(line.removeprefix(b"data: "))


def sight(mode):
    block = SimpleNamespace(device=SimpleNamespace(mode=mode))
    return SimpleNamespace(block=block, set_point_v=-5.0, speed_rpm=float("nan"), torque_nm=1725.0)


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_the_word_follows_the_state_and_an_alarm_outlives_it():
    with LivePages(0) as pages:
        assert first_event(pages)["word"] == "LEVER"
        pages.show(SimpleNamespace(state=State.LEG), sight(DeviceMode.PLAYING))
        shown = first_event(pages)
        assert (shown["word"], shown["lever"]) == ("TEST", "playing")
        # what is not known is not shown
        assert set(shown["numbers"]) == {"set point [V]", "torque [N m]"}
        pages.tell(Event(time_s=3.0, kind="abort", sentence="<b>limit</b>"))
        pages.show(SimpleNamespace(state=State.ABORT), sight(DeviceMode.RAMPING))
        assert first_event(pages)["word"] == "ABORT"
        pages.tell(Event(time_s=4.0, kind="alarm", sentence="nobody is there"))
        pages.show(SimpleNamespace(state=State.ABORT), sight(DeviceMode.PLAYING))
        assert first_event(pages)["word"] == "TAKE LOCAL CONTROL"
        pages.show(SimpleNamespace(state=State.IDLE), sight(DeviceMode.LEVER))
        assert first_event(pages)["word"] == "LEVER"


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_pages_are_for_this_computer_and_take_nothing_in():
    with LivePages(0) as pages:
        assert pages.url.startswith("http://127.0.0.1:")
        for path in ("/", "/engineer"):
            connection, answer = asked(pages, path)
            text = answer.read().decode()
            connection.close()
            assert answer.status == 200
            assert "default-src 'none'" in answer.headers["Content-Security-Policy"]
            assert "innerHTML" not in text
            assert "http" not in text
        for path, host, status in (("/", "elsewhere.example:80", 403), ("/../_page.py", None, 404)):
            connection, answer = asked(pages, path, host)
            answer.read()
            connection.close()
            assert answer.status == status


@pytest.mark.filterwarnings("ignore::ResourceWarning")
def test_the_engineer_asks_with_the_word_of_the_address_and_nobody_else_does():
    operator = Operator()

    def posted(pages, path, word=None, host=None):
        address = pages.url.removeprefix("http://").rstrip("/")
        connection = http.client.HTTPConnection(address, timeout=5.0)
        headers = {"Host": host or address} | ({} if word is None else {"X-Word": word})
        connection.request("POST", path, headers=headers)
        status = connection.getresponse().status
        connection.close()
        return status

    with LivePages(0, operator) as pages:
        word = pages.url_of_engineer.partition("#")[2]
        assert len(word) > 20
        connection, answer = asked(pages, "/engineer")
        # who reads the page does not read the word
        assert word not in answer.read().decode()
        connection.close()
        refused = [posted(pages, "/ask/skip"), posted(pages, "/ask/skip", "x" * len(word))]
        refused += [posted(pages, "/ask/skip", word, "elsewhere.example:80"), posted(pages, "/ask/abort", word)]
        assert refused == [403] * 4
        assert not operator.asks
        assert [posted(pages, "/ask/hold", word), posted(pages, "/ask/go%20on", word)] == [204, 204]
        assert list(operator.asks) == [Ask.HOLD, Ask.GO_ON]
    with LivePages(0) as pages:
        assert "#" not in pages.url_of_engineer
        assert posted(pages, "/ask/skip", "") == 403
