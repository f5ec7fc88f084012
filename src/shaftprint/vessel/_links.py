"""What joins two rows of the inertia table: a shaft, a coupling, a damper, a gear mesh."""

from collections.abc import Mapping, Sequence
from typing import Literal, Self

from pydantic import model_validator

from shaftprint.settings import Name, NotNegativeNumber, PositiveNumber, Settings
from shaftprint.vessel._inertia import InertiaRow
from shaftprint.vessel._usual import COUPLING_DAMPING_STD, COUPLING_STIFFNESS_STD


class ShaftLink(Settings):
    """An elastic, viscous or rigid connection between two masses of the inertia table.

    Elastic with a stiffness, viscous with a damping alone (the silicone of a torsional damper), rigid with neither (a
    gear mesh, a bolted flange, the water around the propeller). Between engine and propeller shaft: a gear mesh.
    """

    between: tuple[Name, Name]
    """Names of the two rows of the inertia table."""
    stiffness_nm_rad: PositiveNumber | None = None
    """Torsional stiffness [N m/rad] at the speed of the link's own shaft."""
    stiffness_std_nm_rad: NotNegativeNumber | None = None
    """Standard deviation [N m/rad] of the stiffness; absent where nobody has judged it."""
    relative_damping: NotNegativeNumber = 0.0
    """``psi`` [-]: energy lost in one cycle over the largest elastic energy in it; 0.8 to 1.2 for a rubber coupling."""
    relative_damping_std: NotNegativeNumber | None = None
    """Standard deviation [-] of ``psi``; absent where nobody has judged it."""
    damping_nm_s_rad: NotNegativeNumber = 0.0
    """Viscous damping [N m s/rad] at the speed of the link's own shaft."""
    damping_std_nm_s_rad: NotNegativeNumber | None = None
    """Standard deviation [N m s/rad] of the viscous damping; absent where nobody has judged it."""
    source: Literal["table", "reconstructed", "assumed", "estimated"]
    """Read from a table, derived from its other numbers, assumed, or estimated with a formula."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        errors = []
        first, second = self.between
        if first == second:
            errors.append(f"expected two different masses in between, found {first} twice.")
        if self.stiffness_nm_rad is None and self.relative_damping > 0.0:
            errors.append("expected stiffness_nm_rad beside relative_damping, a share of its energy, found none.")
        if self.stiffness_nm_rad is None and self.stiffness_std_nm_rad is not None:
            errors.append("expected stiffness_nm_rad beside stiffness_std_nm_rad, found none.")
        if self.relative_damping == 0.0 and self.relative_damping_std is not None:
            errors.append("expected relative_damping beside relative_damping_std, found none.")
        if self.damping_nm_s_rad == 0.0 and self.damping_std_nm_s_rad is not None:
            errors.append("expected damping_nm_s_rad beside damping_std_nm_s_rad, found none.")
        if errors:
            raise ValueError(" ".join(errors))
        return self

    @property
    def is_rigid(self) -> bool:
        """Whether both masses turn as one."""
        return self.stiffness_nm_rad is None and self.damping_nm_s_rad == 0.0

    @property
    def stiffness_std_share(self) -> float:
        """Standard deviation of the stiffness over it, as stated or as usual; 0 for a link without stiffness."""
        return _share(self.stiffness_std_nm_rad, self.stiffness_nm_rad or 0.0, COUPLING_STIFFNESS_STD)

    @property
    def relative_damping_std_share(self) -> float:
        """Standard deviation of ``psi`` over it, as stated or as usual; 0 where it is 0."""
        return _share(self.relative_damping_std, self.relative_damping, COUPLING_DAMPING_STD)

    @property
    def damping_std_share(self) -> float:
        """Standard deviation of the viscous damping over it, as stated or as usual; 0 where it is 0."""
        return _share(self.damping_std_nm_s_rad, self.damping_nm_s_rad, COUPLING_DAMPING_STD)


def _share(std: float | None, value: float, usual: float) -> float:
    if value == 0.0:
        return 0.0
    return usual if std is None else std / value


def wrong_links(links: Sequence[ShaftLink], rows: Sequence[InertiaRow]) -> list[str]:
    """Return what is wrong with the links of an inertia table; nothing for a tree that joins all rows.

    ``links``: the connections; none at all is no mistake. ``rows``: the inertia table.
    """
    if not links:
        return []
    by_name = {row.name: row for row in rows}
    unknown = sorted({name for link in links for name in link.between if name not in by_name})
    if unknown:
        return [f"expected the names of inertia rows in links, found {', '.join(unknown)}."]
    return [*_not_a_tree(links, tuple(by_name)), *_wrong_gears(links, by_name), *_wrong_gauge(links, by_name)]


def _not_a_tree(links: Sequence[ShaftLink], names: Sequence[str]) -> list[str]:
    body = {name: name for name in names}
    for link in links:
        first, second = (body[name] for name in link.between)
        if first == second:
            return [f"expected one way from each mass to another, found a second one by {_words(link)}."]
        body = {name: first if where == second else where for name, where in body.items()}
    first = body[names[0]]
    apart = [name for name, where in body.items() if where != first]
    return [f"expected links that join all inertia rows, found no way from {names[0]} to {apart[0]}."] if apart else []


def _wrong_gears(links: Sequence[ShaftLink], rows: Mapping[str, InertiaRow]) -> list[str]:
    return [
        f"expected no stiffness and damping between engine and propeller shaft, where a gear mesh is, found them in "
        f"{_words(link)}."
        for link in links
        if rows[link.between[0]].shaft != rows[link.between[1]].shaft and not link.is_rigid
    ]


def _wrong_gauge(links: Sequence[ShaftLink], rows: Mapping[str, InertiaRow]) -> list[str]:
    """Return what is wrong where the gauge sits: one link is cut by it, elastic, or rigid beside elastic ones."""
    across = [link for link in links if rows[link.between[0]].gauge != rows[link.between[1]].gauge]
    if len(across) != 1 or (across[0].stiffness_nm_rad is None and not across[0].is_rigid):
        links_across = ", ".join(_words(link) for link in across) or "none"
        return [
            "expected one link from upstream to downstream of the torque gauge, elastic or rigid, found "
            f"{links_across}."
        ]
    if all(link.stiffness_nm_rad is None for link in links):
        return ["expected stiffness_nm_rad in one of the links at least, found none; leave out links of a rigid line."]
    return []


def _words(link: ShaftLink) -> str:
    return " - ".join(link.between)
