import subprocess
import sys

import numpy as np
import pytest
from needs import OPENGL

from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.planner.ground.terrain import flat
from surefoot.sim import gl
from surefoot.sim.marks import Mark
from surefoot.sim.render import Camera, Quality, render_frames
from surefoot.sim.world import World

pytestmark = pytest.mark.unit
DRAFT = Quality(shadows=False, reflections=False, samples=0)


def test_importing_touches_no_opengl() -> None:
    code = "import sys, sim.render; sys.exit(any(name.startswith('OpenGL') for name in sys.modules))"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_without_opengl_the_error_names_the_packages() -> None:
    with pytest.raises(gl.RenderingUnavailableError, match="libegl1 libegl-mesa0 libgl1-mesa-dri, or libosmesa6"):
        gl.make_context(64, 64, {"egl": "libNoSuchEGL.so.1"})


def test_pictures_show_the_robot_and_follow_it() -> None:
    world = World(describe("humanoid100", RobotOptions()), flat(), 1000)
    q = np.concatenate(([0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions))
    away = q.copy()
    away[0] += 50.0
    OPENGL.or_skip()
    here, gone = render_frames(world.mjcf(), [q, away], (160, 120), Camera(azimuth=90, tracking=False), DRAFT)
    assert here.shape == (120, 160, 3)
    orange = (here[..., 0] > 150) & (here[..., 2] < 80)
    assert orange.sum() > 10
    assert not ((gone[..., 0] > 150) & (gone[..., 2] < 80)).any()
    (tracked,) = render_frames(world.mjcf(), [away], (160, 120), Camera(azimuth=90), DRAFT)
    assert ((tracked[..., 0] > 150) & (tracked[..., 2] < 80)).sum() == pytest.approx(orange.sum(), rel=0.2)
    (aimed,) = render_frames(world.mjcf(), [away], (160, 120), Camera(azimuth=90), DRAFT, look_at=[q[:3]])
    assert not ((aimed[..., 0] > 150) & (aimed[..., 2] < 80)).any()


def test_marks_are_drawn_where_they_are() -> None:
    world = World(describe("humanoid100", RobotOptions()), flat(), 1000)
    q = np.concatenate(([0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions))
    ends = np.array([[0.0, -0.8, 0.9], [0.0, -0.8, 1.3]])
    magenta = (1.0, 0.0, 1.0)
    counts = (("point", 1), ("arrow", 2), ("line", 2))
    kinds = [(), *([Mark(kind, magenta, 0.05, ends[:count])] for kind, count in counts)]
    OPENGL.or_skip()
    pictures = list(render_frames(world.mjcf(), [q] * 4, (160, 120), Camera(azimuth=180), DRAFT, kinds))
    none, point, arrow, line = ((p[..., 0] > 150) & (p[..., 1] < 80) & (p[..., 2] > 150) for p in pictures)
    assert not none.any()
    rows, columns = np.nonzero(point)
    assert abs(rows.mean() - 60) < 6
    assert columns.max() < 70
    tops = [np.nonzero(picture)[0].min() for picture in (point, arrow, line)]
    assert tops[1] < tops[0] - 5
    assert tops[1] == pytest.approx(tops[2], abs=3)


def test_marks_inside_the_robot_shine_through() -> None:
    world = World(describe("humanoid100", RobotOptions()), flat(), 1000)
    q = np.concatenate(([0.0, 0.0, 0.9, 0.0, 0.0, 0.0, 1.0], world.description.nominal_joint_positions))
    inside = Mark("point", (1.0, 0.0, 1.0), 0.03, np.array([[0.0, 0.0, 1.0]]))
    OPENGL.or_skip()
    plain, marked = render_frames(world.mjcf(), [q, q], (160, 120), Camera(azimuth=180), DRAFT, [(), (inside,)])
    rows, columns = np.nonzero((plain != marked).any(axis=2))
    assert len(rows) > 5
    assert np.ptp(rows) < 12
    assert np.ptp(columns) < 12
