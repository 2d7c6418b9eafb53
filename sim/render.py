"""Off-screen pictures of a run: configurations in, RGB frames out. Slow, so never in the control loop."""

import math
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from itertools import repeat

import numpy as np
from numpy.typing import NDArray

from surefoot.engines.windowless import mujoco
from surefoot.models.convert import Coordinates
from surefoot.sim.gl import make_context
from surefoot.sim.marks import Mark, draw

Array = NDArray[np.float64]
Image = NDArray[np.uint8]
MAX_GEOMS = 4000
SHINE = 0.6
"""Share of a mark in the colour of what hides it."""

SMOOTHING = 0.1
"""Share of the way to the robot that a tracking camera goes per frame."""


@dataclass(frozen=True, slots=True)
class Camera:
    """A camera that looks at the floating base.

    Attributes:
        distance: from the point it looks at [m].
        azimuth: viewing direction about the world's z axis; 180 looks the robot in the face [deg].
        elevation: viewing direction against the horizontal, negative looks down [deg].
        tracking: whether it follows the robot, smoothly; otherwise it keeps looking at the place of the first frame.
    """

    distance: float = 3.2
    azimuth: float = 135.0
    elevation: float = -10.0
    tracking: bool = True


@dataclass(frozen=True, slots=True)
class Quality:
    """The quality of a picture; in software, at 1280x720, all of it takes 0.6 s, shadows and one sample alone 0.08 s.

    Attributes:
        shadows: cast shadows.
        reflections: of the floor; the scene is drawn twice.
        samples: per pixel, against jagged edges; 0 is one.
        shadow_size: side of the shadow map [px].
    """

    shadows: bool = True
    reflections: bool = True
    samples: int = 4
    shadow_size: int = 4096


def render_frames(
    mjcf: str,
    configurations: Iterable[Array],
    size: tuple[int, int] = (1280, 720),
    camera: Camera | None = None,
    quality: Quality | None = None,
    marks: Iterable[Iterable[Mark]] | None = None,
    look_at: Iterable[Array] | None = None,
) -> Iterator[Image]:
    """Draw the robot of a world in each configuration.

    Args:
        mjcf: text of the world, from `World.mjcf()` or a log.
        configurations: Pinocchio's convention, shape (7 + nj,) each.
        size: width and height of the pictures [px].
        camera: where to look from; a three-quarter view from the front by default.
        quality: how carefully to draw; all that there is by default.
        marks: what to draw beside the world, for each configuration; nothing by default.
        look_at: what the camera looks at in each configuration, whatever it tracks, shape (3,) each [m].

    Yields:
        one picture per configuration, shape (height, width, 3).

    Raises:
        RenderingUnavailableError: the machine has no off-screen OpenGL.
    """
    (width, height), quality = size, quality or Quality()
    model = _compiled(mjcf, width, height, quality)
    context = make_context(width, height)
    try:
        painter = _Painter(model, width, height, camera or Camera(), quality)
        beside, targets = repeat(()) if marks is None else marks, repeat(None) if look_at is None else look_at
        yield from painter.paint(configurations, beside, targets)
    finally:
        context.free()


def _compiled(mjcf: str, width: int, height: int, quality: Quality) -> mujoco.MjModel:
    model = mujoco.MjModel.from_xml_string(mjcf)
    model.vis.global_.offwidth = width
    model.vis.global_.offheight = height
    model.vis.quality.offsamples = quality.samples
    model.vis.quality.shadowsize = quality.shadow_size
    return model


class _Painter:
    """MuJoCo's scene and GPU resources for one sequence of frames, in the current OpenGL context."""

    def __init__(self, model: mujoco.MjModel, width: int, height: int, camera: Camera, quality: Quality) -> None:
        self._model, self._data, self._style = model, mujoco.MjData(model), camera
        self._scene = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        self._scene.flags[mujoco.mjtRndFlag.mjRND_SHADOW] = quality.shadows
        self._scene.flags[mujoco.mjtRndFlag.mjRND_REFLECTION] = quality.reflections
        self._beside = mujoco.MjvScene(model, maxgeom=MAX_GEOMS)
        for flag in (mujoco.mjtRndFlag.mjRND_SHADOW, mujoco.mjtRndFlag.mjRND_SKYBOX, mujoco.mjtRndFlag.mjRND_HAZE):
            self._beside.flags[flag] = False
        self._option, self._view = mujoco.MjvOption(), mujoco.MjvCamera()
        self._view.distance, self._view.azimuth = camera.distance, camera.azimuth
        self._view.elevation, self._view.lookat[:] = camera.elevation, math.nan
        self._context = mujoco.MjrContext(model, mujoco.mjtFontScale.mjFONTSCALE_100.value)
        mujoco.mjr_setBuffer(mujoco.mjtFramebuffer.mjFB_OFFSCREEN.value, self._context)
        self._area = mujoco.MjrRect(0, 0, width, height)

    def paint(
        self, configurations: Iterable[Array], marks: Iterable[Iterable[Mark]], look_at: Iterable[Array | None]
    ) -> Iterator[Image]:
        """One picture per configuration."""
        coordinates = Coordinates(self._model)
        rest = np.zeros(coordinates.size - 1)
        for q, beside, target in zip(configurations, marks, look_at, strict=False):
            coordinates.to_mujoco(q, rest, self._data.qpos, self._data.qvel)
            mujoco.mj_kinematics(self._model, self._data)
            mujoco.mj_comPos(self._model, self._data)
            mujoco.mj_camlight(self._model, self._data)
            self._follow(target)
            shown = list(beside)
            self._update(self._scene)
            draw(self._scene, shown)
            picture = self._picture(self._scene)
            yield self._shine_through(picture, shown) if shown else picture

    def _update(self, scene: mujoco.MjvScene) -> None:
        # The engine centres the endless floor on the camera of the frame before, unless it gets this one's.
        mujoco.mjv_updateCamera(self._model, self._data, self._view, scene)
        everything = mujoco.mjtCatBit.mjCAT_ALL.value
        mujoco.mjv_updateScene(self._model, self._data, self._option, None, self._view, everything, scene)

    def _shine_through(self, picture: Image, marks: list[Mark]) -> Image:
        """Blend in a picture of the marks alone, so that those inside or behind the robot are seen too."""
        self._update(self._beside)
        self._beside.ngeom = 0
        draw(self._beside, marks)
        alone = self._picture(self._beside)
        drawn = alone.any(axis=2)
        picture[drawn] = (1.0 - SHINE) * picture[drawn] + SHINE * alone[drawn]
        return picture

    def _follow(self, wanted: Array | None) -> None:
        target = self._data.qpos[:3]
        if wanted is not None:
            self._view.lookat[:] = wanted
        elif math.isnan(self._view.lookat[0]):
            self._view.lookat[:] = target
        elif self._style.tracking:
            self._view.lookat[:] += SMOOTHING * (target - self._view.lookat)

    def _picture(self, scene: mujoco.MjvScene) -> Image:
        mujoco.mjr_render(self._area, scene, self._context)
        image = np.empty((self._area.height, self._area.width, 3), dtype=np.uint8)
        mujoco.mjr_readPixels(image, None, self._area, self._context)
        return image[::-1].copy()
