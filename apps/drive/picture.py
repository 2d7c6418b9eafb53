"""The picture of a simulation at one of its ticks: the robot, its marks, and the values of its charts."""

import math
from collections import deque
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from surefoot.apps.drive.session import PUSH_TIME, PushInput
from surefoot.engines.windowless import mujoco
from surefoot.models.pinocchio import pinocchio_model
from surefoot.planner.geometry.plane import headings, points_seen_from
from surefoot.planner.model.dcm import dcm
from surefoot.planner.types import Foot, Footstep, PhaseKind
from surefoot.scenarios import palette
from surefoot.scenarios.run.simulation import Tick
from surefoot.scenarios.setup.robot.body import frames_of
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.show.logview import FOOT_NAMES
from surefoot.scenarios.show.replay.content import PUSH_SHOWN, Array, Facts, Replay, Track, sole_corners, tracks
from surefoot.scenarios.show.replay.extract import surfaces
from surefoot.sim.bodies import BodyPoses
from surefoot.sim.scene import world_mjcf
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.contact.zmp import centre_of_pressure, measured_zmp

FOLLOW_TIME = 0.4
"""Time constant with which the camera follows the robot [s]."""

FOOTPRINTS = 12
"""Footprints of each foot that stay in sight."""

_NOWHERE = np.full((4, 3), np.nan)
_NO_STEP = (math.nan,) * 4
_NO_POINT, _NO_POLYGON = np.full(3, np.nan), np.full((8, 2), np.nan)


@dataclass(frozen=True, slots=True)
class Picture(Replay):
    """A replay of one frame, whose camera cannot look ahead.

    Attributes:
        look_at: what the camera looks at, shape (3,) [m].
    """

    look_at: Array

    def followed(self) -> Array:
        """See `Replay`."""
        return self.look_at[None]


class Pictures:
    """Makes the pictures of a walk's runs.

    Attributes:
        walk: what is simulated, in full physics.
        sole: length and width of the robot's [m].
    """

    def __init__(self, walk: Walk) -> None:
        robot = walk.true_robot
        self.walk, self.sole = walk, (float(robot.sole_length), float(robot.sole_width))
        self._mjcf = world_mjcf(robot, walk.ground.true_terrain, 1.0 / walk.rates.physics)
        model = mujoco.MjModel.from_xml_string(self._mjcf)
        self._poses, self._surfaces = BodyPoses(model), surfaces(model)
        self._offsets = model.body_ipos[1:].copy()
        self._terms = RobotTerms(pinocchio_model(robot), frames_of(walk.robot))
        self.begin()

    def begin(self) -> None:
        """Forget the run before."""
        self._look_at: Array | None = None
        self._time = 0.0
        self._push: tuple[float, Array, str] | None = None
        self._taken: tuple[deque[Array], deque[Array]] = (deque(maxlen=FOOTPRINTS), deque(maxlen=FOOTPRINTS))
        self._stood: list[Footstep | None] = [None, None]
        self._alone: Foot | None = None
        self._placed = [Footstep(foot, np.zeros(3), 0.0) for foot in Foot]
        self._on_ground = (False, False)

    def pushed(self, push: PushInput, time: float) -> None:
        """Show a push that begins at a simulated time [s]."""
        self._push = (time + PUSH_TIME + PUSH_SHOWN, np.array(push.impulse) / PUSH_TIME, push.body)

    def picture(self, tick: Tick) -> Picture:
        """The picture of a tick; in order of time."""
        measurement = tick.measurement
        assert measurement is not None, "a pendulum has no body to show"
        self._poses.update(measurement.q)
        self._terms.update(measurement.q, measurement.v)
        position = np.vstack([np.zeros(3), self._poses.position])
        self._follow(position[1], tick.time)
        self._note_footprints(self._footholds(tick))
        return Picture(
            title=self.walk.name,
            frame_rate=1.0,
            time=np.array([tick.time]),
            configuration=measurement.q[None],
            body_names=("world", *self._poses.names),
            body_position=position[None],
            body_quaternion=np.vstack([[1.0, 0.0, 0.0, 0.0], self._poses.quaternion])[None],
            surfaces=self._surfaces,
            tracks=tuple(self._tracks(tick)),
            footprints=(),
            mjcf=self._mjcf,
            look_at=np.array(self._look_at),
        )

    def values(self, tick: Tick) -> tuple[list[float], ...]:
        """Values of the charts: ZMP, CoM, DCM, then as planned, ahead and left of the stance foot; margins; forces.

        After `picture` of the same tick.
        """
        measurement = tick.measurement
        assert measurement is not None
        points, margins = np.full((6, 2), np.nan), [math.nan, math.nan]
        points[:2] = tick.zmp, tick.com[:2]
        if tick.planned is not None:
            plan, now = tick.planned
            points[2:] = _dcm(tick), now.zmp, now.com[:2], now.dcm
            margins = [plan.balance.planned, plan.balance.movable]
        if tick.phase.stance is not None:
            self._alone = tick.phase.stance
        stands = self._footholds(tick)
        feet = stands if self._alone is None else (stands[self._alone],)
        ahead, left = points_seen_from(np.mean([_pose(foot) for foot in feet], axis=0), points).T
        return ahead.tolist(), left.tolist(), margins, measurement.wrench[:, 2].tolist()

    @property
    def alone(self) -> int:
        """The foot that bore alone last, from which the charts are seen; -1 before there is one."""
        return -1 if self._alone is None else int(self._alone)

    def _tracks(self, tick: Tick) -> Iterator[Track]:
        """Marks as in a replay, and the footprints, which come and go here."""
        measurement, terms = tick.measurement, self._terms
        assert measurement is not None
        planned = tick.planned
        zmp = measured_zmp(measurement.wrench, terms.sole_position, terms.sole_rotation)
        cop = [centre_of_pressure(wrench) for wrench in measurement.wrench]
        steps = () if planned is None else planned[0].footsteps
        free = 3 - len(steps)
        push, pushed = self._push_at(tick.time)
        yield from tracks(
            Facts(
                com=tick.com[None],
                dcm=_dcm(tick)[None],
                zmp=np.array([zmp]),
                planned_com=_NO_POINT[None] if planned is None else planned[1].com[None],
                planned_dcm=_NO_POINT[None, :2] if planned is None else planned[1].dcm[None],
                planned_zmp=_NO_POINT[None, :2] if planned is None else planned[1].zmp[None],
                polygon=_NO_POLYGON[None] if planned is None else _eight(planned[0].support_polygon)[None],
                contacts=np.array([_contacts(tick)]),
                soles=terms.sole_pose[None],
                cop=np.array([cop]),
                force=measurement.wrench[None, :, :3],
                ahead=np.array([[_pose(step) for step in steps] + [_NO_STEP] * free]),
                ahead_foot=np.array([[int(step.foot) for step in steps] + [-1] * free]),
                push=push[None],
                pushed=pushed[None],
                sole=self.sole,
            )
        )
        for foot, name in enumerate(FOOT_NAMES):
            corners = [*self._taken[foot], *[_NOWHERE] * FOOTPRINTS][:FOOTPRINTS]
            for number, sole in enumerate(corners):
                yield Track("Taken footprints", f"{name} {number}", "outline", palette.FEET[foot], 0.003, sole[None])

    def _push_at(self, time: float) -> tuple[Array, Array]:
        """Force of the push that is to be seen [N], and where it acts, shape (3,) each [m]."""
        if self._push is None or time >= self._push[0]:
            return np.zeros(3), np.zeros(3)
        _, force, body = self._push
        index = self._poses.names.index(body)
        turned = Rotation.from_quat(self._poses.quaternion[index], scalar_first=True).apply(self._offsets[index])
        return force, self._poses.position[index] + turned

    def _follow(self, base: Array, time: float) -> None:
        if self._look_at is None:
            self._look_at = base.copy()
        share = 1.0 - math.exp(-(time - self._time) / FOLLOW_TIME)
        self._look_at, self._time = self._look_at + share * (base - self._look_at), time

    def _footholds(self, tick: Tick) -> tuple[Footstep, ...]:
        """Footholds of the feet by the plan, or, without one, those of the feet that have come to the ground."""
        if tick.planned is not None:
            return tuple(tick.planned[0].footholds)
        contacts = _contacts(tick)
        for foot in Foot:
            if contacts[foot] and (not self._on_ground[foot] or self._stood[foot] is None):
                x, y, z, *turned = self._terms.sole_pose[foot].tolist()
                self._placed[foot] = Footstep(foot, np.array([x, y, z]), float(headings(np.array(turned))))
        self._on_ground = contacts
        return tuple(self._placed)

    def _note_footprints(self, footholds: Sequence[Footstep]) -> None:
        """Note where a foot stands that stood elsewhere before."""
        for foot, stands in enumerate(footholds):
            before = self._stood[foot]
            if before is None or not np.allclose(_pose(stands), _pose(before), atol=1e-3):
                self._taken[foot].append(sole_corners(np.array([_pose(stands)]), self.sole)[0])
                self._stood[foot] = stands


def _dcm(tick: Tick) -> Array:
    """The DCM, which is nowhere to be seen without the plan's pendulum, shape (2,) [m]."""
    if tick.planned is None:
        return np.full(2, np.nan)
    return dcm(tick.com[:2], tick.com_velocity[:2], tick.planned[1].omega)


def _contacts(tick: Tick) -> tuple[bool, bool]:
    """Feet on the ground, as planned, or as felt without a plan, (left, right)."""
    if tick.planned is not None:
        return tick.planned[1].contacts
    phase = tick.phase
    if phase.kind is not PhaseKind.SINGLE:
        return True, True
    return phase.stance is Foot.LEFT, phase.stance is Foot.RIGHT


def _pose(step: Footstep) -> tuple[float, ...]:
    return (*step.position.tolist(), step.yaw)


def _eight(polygon: Array) -> Array:
    """A polygon of as many vertices as two soles can have, the last one repeated."""
    missing: Sequence[Array] = [polygon[-1:]] * (8 - len(polygon))
    return np.concatenate([polygon, *missing])
