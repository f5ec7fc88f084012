"""Names and sizes of the native container, which is NetCDF-4: what writer and reader agree on."""

FORMAT = "shaftprint recording"
"""Root attribute ``format`` of the container."""

VERSION = 1
"""Root attribute ``format_version``; a reader refuses later ones."""

VERSION_WITH_TIMES = 2
"""Version of a file in which a channel has times of its own."""

TIMES = "times"
"""Attribute of such a channel: name of the data set with its times [s]."""

UNEVEN = "is_uneven"
"""Attribute of such a channel: 1 where its samples lie at those times alone, on no clock."""

GROUP = "channels"
"""The group that holds one data set a channel."""

EDGES = "is_of_edges"
"""Attribute of such a channel: 1 where its samples were made of a list of edges."""

BEGAN = "began"
"""Root attribute with the date of second 0 as ISO 8601 has it, where it is known."""

JUMPS, JUMPS_S = "clock_jump_samples", "clock_jumps_s"
"""Attributes of a channel whose clock jumps: the first samples behind the jumps, and how far each is [s]."""

OWN = ("Conventions", "format", "format_version", BEGAN)
"""Root attributes that are the container's own; all others are facts on the recording."""

CHUNK_SAMPLES = 262_144
"""Samples of one compressed block: 131 s at 2000 Hz, 512 KiB of counts."""
