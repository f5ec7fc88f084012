"""Noise of the simulated ships, for plans without a recording of the ship itself: tables in the folder beside this.

``benchmarks/stored_noise.py`` and ``stored_noise_beside.py`` make their rows.
"""

from collections.abc import Mapping
from types import MappingProxyType
from typing import Any

from shaftprint.catalogue._roles import ShipRole
from shaftprint.files import shipped_table
from shaftprint.identify.prediction._noise_levels import NoiseLevels, stated_noise
from shaftprint.models._role import Role


def _table(name: str) -> dict[str, Any]:
    return shipped_table("shaftprint.survey", f"shipped_noise/{name}.toml")


def _by_speed(table: Mapping[str, Any]) -> Mapping[float, NoiseLevels]:
    """Return the noise levels of a file by the share of the working-point speed; one volt is as many rpm at each."""
    first = 1 + len(table["outputs"])
    return MappingProxyType(
        {
            share: stated_noise(
                [row[0] for row in rows],
                [row[1:first] for row in rows],
                [[complex(*pair) for pair in zip(row[first::2], row[first + 1 :: 2], strict=True)] for row in rows],
                set_point_per_v=table["set_point_per_v"] / share,
                orders_hz=[share * order for order in table["orders_hz"]],
                outputs=table["outputs"],
            )
            for share, rows in ((one["speed_share"], one["rows"]) for one in table["levels"])
        }
    )


_IN_LEGS = _table("stan-tug-1205-at-speeds")
STAN_TUG_NOISE: NoiseLevels = _by_speed(_table("stan-tug-1205"))[1.0]
"""Noise levels of the Stan Tug 1205 up to 7.2 Hz; one volt of set point is 251 rpm of 1183.8 rpm."""
STAN_TUG_NOISE_AT_SPEEDS: Mapping[float, NoiseLevels] = _by_speed(_IN_LEGS)
"""Noise levels of the Stan Tug 1205 in legs, by share of the working-point speed of 1183.8 rpm."""
STAN_TUG_LINE: Mapping[Role, float] = MappingProxyType(
    {getattr(ShipRole, name.upper()): value for name, value in _IN_LEGS["line"].items()}
)
"""The line that has this noise, normalised at the same working point: its parameters by their roles."""
STAN_TUG_NOISE_UNDERWAY: NoiseLevels = _by_speed(_table("stan-tug-1205-underway"))[1.0]
"""Noise levels of the Stan Tug 1205 underway up to 7.2 Hz; one volt of set point is 251 rpm of 1600 rpm."""
RESEARCH_VESSEL_NOISE: NoiseLevels = _by_speed(_table("research-vessel"))[1.0]
"""Noise levels of the simulated research vessel up to 3.5 Hz; one volt of set point is 127 rpm of 600 rpm."""
PITCH_NOISE: NoiseLevels = _by_speed(_table("research-vessel-pitch"))[1.0]
"""Noise levels of the simulated research vessel up to 2.6 Hz; one volt is 0.14 of the pitch ratio of 0.80."""
COMBINATOR_NOISE: NoiseLevels = _by_speed(_table("research-vessel-combinator"))[1.0]
"""Noise levels of the simulated research vessel with a combinator up to 3.5 Hz."""
