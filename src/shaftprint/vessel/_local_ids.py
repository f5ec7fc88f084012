"""Local ids of ISO 19848 for channels of a vessel file, by which a data server on board knows them."""

from collections.abc import Iterator, Mapping

from shaftprint.local_ids import LocalId
from shaftprint.settings import Name, Settings, names_twice


class ChannelName(Settings):
    """What a channel is called by ISO 19848."""

    channel: Name
    """Name of the channel in the recording."""
    local_id: Name
    """Its local id, such as ``/dnv-v2/vis-3-4a/411.1/C101/meta/qty-rotational.frequency``."""


def wrong_local_ids(names: tuple[ChannelName, ...], meant: Mapping[str, str | None]) -> Iterator[str]:
    """Yield what is wrong with local ids, a sentence each.

    ``meant``: by channel of a sensor, ``SPEED``, ``torque``, ``set point`` or, of any quantity, None.
    """
    channels = [name.channel for name in names]
    for channel in names_twice(channels):
        yield f"expected one local id of {channel}, found {channels.count(channel)}."
    for channel, text in ((name.channel, name.local_id) for name in names):
        if channel not in meant:
            yield f"expected local_ids of channels that a sensor has, found {channel}."
            continue
        try:
            local_id = LocalId.parse(text)
        except ValueError as error:
            yield f"{channel}: {error}"
            continue
        quantity = meant[channel]
        if quantity == "set point":
            if not local_id.is_set_point:
                yield f'{channel}: expected the local id of a set point, with "/type-set.point", found {text}.'
        elif quantity is not None:
            misfit = local_id.misfit(quantity)
            if misfit:
                yield f"{channel}: {misfit}"
