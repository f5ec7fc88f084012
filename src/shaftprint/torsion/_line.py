"""The noun of the room: bodies and the links between them, all referred to the propeller shaft."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from shaftprint.arrays import FloatArray, frozen_float
from shaftprint.errors import SettingsError, StructureError
from shaftprint.notebook._shown import Shown
from shaftprint.units import rev_s_from_rpm

if TYPE_CHECKING:
    from shaftprint.vessel._inertia import InertiaRow
    from shaftprint.vessel._links import ShaftLink
    from shaftprint.vessel._vessel import Vessel

QUADRATIC_LAW = 2.0


@dataclass(frozen=True, kw_only=True, slots=True)
class LineLink:
    """A shaft, coupling or damper between two bodies."""

    between: tuple[int, int]
    """Places of its bodies, the one towards the engine first."""
    stiffness_nm_rad: float
    """Stiffness [N m/rad]; 0 for a damper without spring."""
    stiffness_std_nm_rad: float = 0.0
    """Standard deviation [N m/rad] of the stiffness."""
    relative_damping: float = 0.0
    """``psi`` [-]."""
    damping_nm_s_rad: float = 0.0
    """Viscous damping [N m s/rad]."""

    def viscous_nm_s_rad(self, omega_rad_s: float) -> float:
        """Return the viscous damping that loses as much energy in a cycle at one frequency [N m s/rad].

        ``c + k psi / (2 pi omega)``: the complex stiffness ``k (1 + j psi / (2 pi))`` and a damping ``c`` have the same
        imaginary part at ``omega`` (Den Hartog, Mechanical Vibrations, section 2.8, energy of a cycle).
        """
        return self.damping_nm_s_rad + self.stiffness_nm_rad * self.relative_damping / (2.0 * math.pi * omega_rad_s)


@dataclass(frozen=True, kw_only=True, slots=True, eq=False, repr=False)
class TorsionalLine(Shown):
    """A tree of bodies joined by springs and dampers, referred to the propeller shaft."""

    bodies: tuple[str, ...]
    """Names of the bodies: of the largest mass of each."""
    inertia_kg_m2: FloatArray
    """Inertia of each body [kg m2], shape (bodies,)."""
    links: tuple[LineLink, ...]
    """The links."""
    gauge: int | None
    """Place of the link whose torque the gauge shows; None where it sits on a body that turns as one."""
    load_nm_s_rad: FloatArray
    """Viscous damping against the surroundings [N m s/rad], shape (bodies,): the slope of the propeller torque."""
    inertia_std_kg_m2: FloatArray
    """Standard deviation of the inertia of each body [kg m2], shape (bodies,)."""
    body_of: Mapping[str, int]
    """Place of the body that holds each mass, by the name of the mass."""

    def __post_init__(self) -> None:
        """Make the arrays read-only and check that the parts belong together.

        Raises StructureError if they do not.
        """
        count = len(self.bodies)
        for name in ("inertia_kg_m2", "load_nm_s_rad", "inertia_std_kg_m2"):
            values = frozen_float(getattr(self, name))
            if values.shape != (count,):
                raise StructureError(
                    f"torsional line: expected {name} of {count} bodies, found an array of shape {values.shape}."
                )
            object.__setattr__(self, name, values)
        if not np.all(self.inertia_kg_m2 > 0.0):
            at = self.bodies[int(np.argmin(self.inertia_kg_m2))]
            raise StructureError(
                f"torsional line: expected every body to have inertia, found none in {at}; join it rigidly to another."
            )
        on_a_link = self.gauge is None or 0 <= self.gauge < len(self.links)
        if len(self.links) != count - 1 or not on_a_link:
            raise StructureError(
                f"torsional line: expected {count - 1} links for {count} bodies and the gauge on one of them, found "
                f"{len(self.links)} links and the gauge on link {self.gauge}."
            )

    @property
    def incidence(self) -> FloatArray:
        """Twist of each link from the angles of the bodies: 1 on the engine side, -1 on the other; (links, bodies)."""
        table = np.zeros((len(self.links), len(self.bodies)))
        for row, link in enumerate(self.links):
            table[row, list(link.between)] = 1.0, -1.0
        return table

    @property
    def stiffness_nm_rad(self) -> FloatArray:
        """Stiffness of each link [N m/rad], shape (links,)."""
        return np.array([link.stiffness_nm_rad for link in self.links])

    def viscous_nm_s_rad(self, omega_rad_s: float) -> FloatArray:
        """Return the equivalent viscous damping of each link at a frequency [N m s/rad], shape (links,)."""
        return np.array([link.viscous_nm_s_rad(omega_rad_s) for link in self.links])

    def link_name(self, link: int) -> str:
        """Return both bodies of a link."""
        return " - ".join(self.bodies[body] for body in self.links[link].between)

    def place(self, mass: str) -> int:
        """Return the place of the body that holds a mass.

        Raises
        ------
        StructureError
            If there is no such mass.
        """
        if mass not in self.body_of:
            raise StructureError(f"torsional line: there is no mass {mass!r}; it has {', '.join(self.body_of)}.")
        return self.body_of[mass]

    @property
    def without_damping(self) -> "TorsionalLine":
        """Return the same masses and springs without any damping, of links or load."""
        links = tuple(replace(link, relative_damping=0.0, damping_nm_s_rad=0.0) for link in self.links)
        return replace(self, links=links, load_nm_s_rad=np.zeros(len(self.bodies)))

    @property
    def gauge_link(self) -> int:
        """Return the place of the link whose torque the gauge shows.

        Raises
        ------
        StructureError
            If the gauge sits on a body that turns as one: then no link has its torque.
        """
        if self.gauge is None:
            raise StructureError(
                "torsional line: expected a stiffness of the link across the torque gauge, found a rigid one; state "
                "that of the shaft in the vessel file."
            )
        return self.gauge

    @property
    def is_downstream(self) -> FloatArray:
        """1 for bodies on the propeller's side of the gauge, 0 for others; shape (bodies,).

        Raises
        ------
        StructureError
            If the gauge sits on a body, which then lies on both sides.
        """
        _, behind = self.sides_of(self.gauge_link)
        return behind

    def sides_of(self, link: int) -> tuple[FloatArray, FloatArray]:
        """Return 1 for bodies ahead of a link and 0 for those behind it, and the other way round; shape (bodies,)."""
        others = [one.between for index, one in enumerate(self.links) if index != link]
        reached = {self.links[link].between[1]}
        while True:
            more = {body for pair in others if reached & set(pair) for body in pair} - reached
            if not more:
                behind = np.array([float(body in reached) for body in range(len(self.bodies))])
                return 1.0 - behind, behind
            reached |= more


def torsional_line(vessel: "Vessel") -> TorsionalLine:
    """Return the torsional line of a vessel file.

    The propeller damps by ``d ln M_p / d ln n`` of its torque at the working point, here of the quadratic law: a
    damping ``slope M_s0 / omega_s0`` acts on the largest body downstream of the gauge.

    Parameters
    ----------
    vessel
        The installation, with its links.

    Raises
    ------
    SettingsError
        If the vessel file has no links.
    """
    if not vessel.links:
        raise SettingsError(
            f"{vessel.name}: expected [[links]] between the rows of the inertia table, found none; add the stiffness "
            "of shafts and couplings to the vessel file."
        )
    ratio = vessel.gearbox.ratio
    groups = _bodies(vessel)
    body_of = {row.name: index for index, rows in enumerate(groups) for row in rows}
    inertia = np.array([math.fsum(row.referred_kg_m2(ratio) for row in rows) for rows in groups])
    names = tuple(max(rows, key=lambda row: row.referred_kg_m2(ratio)).name for rows in groups)
    links = _links(vessel, body_of)
    behind = np.array(
        [math.fsum(row.referred_kg_m2(ratio) for row in rows if row.gauge == "downstream") for rows in groups]
    )
    propeller = int(np.argmax(behind))
    point = vessel.working_point
    shaft_rad_s = 2.0 * math.pi * rev_s_from_rpm(point.engine_speed_rpm) / ratio
    load = np.zeros(len(groups))
    load[propeller] = QUADRATIC_LAW * point.driving_torque_nm / shaft_rad_s
    return TorsionalLine(
        bodies=names,
        inertia_kg_m2=inertia,
        links=links,
        gauge=_gauge_of(groups, links),
        load_nm_s_rad=load,
        inertia_std_kg_m2=np.array([math.hypot(*(row.referred_std_kg_m2(ratio) for row in rows)) for rows in groups]),
        body_of=body_of,
    )


def _gauge_of(groups: "list[list[InertiaRow]]", links: tuple[LineLink, ...]) -> int | None:
    """Return the link across the gauge; None where that is rigid, so that one body has masses on both of its sides."""
    sides = [{row.gauge for row in rows} for rows in groups]
    if any(len(side) > 1 for side in sides):
        return None
    return next(i for i, link in enumerate(links) if sides[link.between[0]] != sides[link.between[1]])


def _bodies(vessel: "Vessel") -> "list[list[InertiaRow]]":
    """Return the rows that turn as one, body by body, in the order of the table."""
    body = {row.name: row.name for row in vessel.inertia}
    for link in vessel.links:
        if link.is_rigid:
            first, second = (body[name] for name in link.between)
            body = {name: first if where == second else where for name, where in body.items()}
    groups: dict[str, list[InertiaRow]] = {}
    for row in vessel.inertia:
        groups.setdefault(body[row.name], []).append(row)
    return list(groups.values())


def _links(vessel: "Vessel", body_of: Mapping[str, int]) -> tuple[LineLink, ...]:
    engine = {row.name for row in vessel.inertia if row.shaft == "engine"}
    downstream = {row.name for row in vessel.inertia if row.gauge == "downstream"}
    links = []
    for link in vessel.links:
        if link.is_rigid:
            continue
        turned = link.between[0] in downstream and link.between[1] not in downstream
        first, second = reversed(link.between) if turned else link.between
        links.append(
            _referred(link, vessel.gearbox.ratio**2 if first in engine else 1.0, (body_of[first], body_of[second]))
        )
    return tuple(links)


def _referred(link: "ShaftLink", factor: float, between: tuple[int, int]) -> LineLink:
    return LineLink(
        between=between,
        stiffness_nm_rad=(link.stiffness_nm_rad or 0.0) * factor,
        stiffness_std_nm_rad=(link.stiffness_std_nm_rad or 0.0) * factor,
        relative_damping=link.relative_damping,
        damping_nm_s_rad=link.damping_nm_s_rad * factor,
    )
