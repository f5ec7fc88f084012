from ._envelope import envelope_of
from ._play_on_board import play_on_board
from ._proof import prove
from ._rehearse import rehearse
from ._replay import replayed
from .counterparts._channel_list import read_channel_list

__all__ = ["envelope_of", "play_on_board", "prove", "read_channel_list", "rehearse", "replayed"]
