"""The page of a drive: the robot in viser's own viewer, with controls and charts beside it."""

import html
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager
from dataclasses import asdict
from http.client import HTTPConnection
from importlib.resources import files
from queue import SimpleQueue
from string import Template
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.errors import ParameterError
from surefoot.scenarios import palette
from surefoot.scenarios.drive.picture import Instant, Pictures
from surefoot.scenarios.drive.server import PageServer
from surefoot.scenarios.drive.session import Gait, Input, Pace, Push, Reset, Status, Velocity
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.show.replay.content import Array
from surefoot.scenarios.show.replay.page import AXES, BALANCE, FEET_NAMES, MARGINS
from surefoot.scenarios.show.replay.scene import LOCALHOST, PORT, ViserScene, rgb, serving
from surefoot.scenarios.simulation import Tick
from surefoot.similarity import REFERENCE_SIZE, Similarity

if TYPE_CHECKING:
    import viser

LIMITS = Velocity(0.6, 0.25, 0.6)
"""Greatest velocities that the page asks for, either way; numbers here are the reference robot's [m/s, rad/s]."""

GAIT_RANGES = {"single_support": (0.35, 1.2), "double_support": (0.08, 0.6), "swing_height": (0.02, 0.12)}
GAIT_UNITS = {"single_support": "s", "double_support": "s", "swing_height": "m"}
"""Of the sliders [s, s, m]."""

SPEEDS = (1.0, 0.5, 0.25, 0.1)
"""Of simulated over wall-clock time; less than 1 is slow motion."""

IMPULSE, GREATEST_IMPULSE = 15.0, 60.0
"""Of a click at first, and the greatest of any push [N·s]."""

PULL = 100.0
"""Impulse of a drag for each metre [N·s/m]."""

LAYERS = (
    *("Robot", "CoM", "DCM", "ZMP", "Support polygon", "Planned footprints", "Taken footprints", "Contact forces"),
    "Pushes",
)
"""Of the scene, that can be switched off."""

FARTHER = 1.5
"""How much farther the camera stands than in a replay, since the robot may go anywhere [-]."""

LEAST_PULL = 1.0
"""A shorter drag pushes nothing [N·s]."""


class DrivePage:
    """Shows the runs of a session, and gives it what the user does; see `session.Page`.

    Args:
        viewer: shows the robot.
        port: of the page; the first free one if None.
        inputs: get what the user does.

    Raises:
        LogError: the port is taken.
    """

    def __init__(self, viewer: "viser.ViserServer", port: int | None, inputs: "SimpleQueue[Input]") -> None:
        self._viewer, self._inputs = viewer, inputs
        self._follow, self._size = True, REFERENCE_SIZE
        self._impulse: float | None = None
        self._pull: Array | None = None
        self._pushed: dict[str, Any] | None = None
        self._pictures: Pictures
        self._scene: ViserScene | None = None
        self._server = PageServer(port, self._take, lambda: inputs.put(Velocity()))

    @property
    def address(self) -> str:
        """Where the page is."""
        return self._server.address

    def begin(self, robot: Any) -> None:
        """See `session.Page`; the robot is a `Simulation`, and the same for all runs."""
        self._robot, self._pushed = robot, None
        if self._scene is None:
            self._pictures, self._size = Pictures(robot.walk), robot.walk.size
            if self._impulse is None:  # a page may have told its own before the first run begins
                self._impulse = self._size.times(IMPULSE, "N·s")
            self._server.page = _page(_viewer_page(self._viewer.get_port()), self._viewer.get_port(), robot.walk)
        self._pictures.begin()

    def pushed(self, push: Push, time: float) -> None:
        """See `session.Page`."""
        self._pictures.pushed(push, time)
        self._pushed = {**self._told(np.array(push.impulse)), "body": push.body, "time": time}

    def show(self, tick: Tick, status: Status) -> None:
        """See `session.Page`."""
        picture = self._pictures.picture(tick)
        with self._viewer.atomic():
            if self._scene is None:
                self._scene = self._staged(picture)
            self._scene.replace(picture)
            self._scene.show(0, follow=self._follow)
        pull = self._pull
        news = {
            **asdict(status),
            "wanted": _numbers(status.wanted),
            "followed": _numbers(self._followed()),
            "charts": self._pictures.values(tick),
            "alone": self._pictures.alone,
            "tick": tick.time,
            "pushed": self._pushed,
            "pull": None if pull is None else self._told(pull),
        }
        self._server.tell(json.dumps(news).replace("NaN", "null"))

    def close(self) -> None:
        """Stop serving."""
        self._server.close()

    def _followed(self) -> Any:
        try:
            return self._robot.orders.followed or Velocity()
        except ParameterError:  # of a planner that takes no commands
            return Velocity()

    def _staged(self, picture: Instant) -> ViserScene:
        """The scene, whose robot can be clicked on and dragged."""
        scene = ViserScene(self._viewer, picture, solid=False)
        camera = self._viewer.initial_camera
        camera.position = camera.look_at + FARTHER * (camera.position - camera.look_at)
        for body, node in scene.skin:
            node.on_click(lambda event, body=body: self._clicked(body, event))
            node.on_drag("left")(lambda event, body=body: self._dragged(body, event))
        look: dict[str, Any] = {"head_radius": 0.035, "head_length": 0.08, "shaft_radius": 0.015, "visible": False}
        self._arrow = self._viewer.scene.add_arrows("/Pull", np.zeros((1, 2, 3)), rgb(palette.PUSH), **look)
        return scene

    def _clicked(self, body: str, event: Any) -> None:
        """Push along the view, but not into the ground."""
        x, y, _ = event.ray_direction
        length = math.hypot(x, y)
        if length > 1e-6 and self._impulse is not None:
            self._inputs.put(Push((self._impulse * x / length, self._impulse * y / length, 0.0), body))

    def _dragged(self, body: str, event: Any) -> None:
        """Pull towards the pointer when it is released; an arrow shows how until then."""
        start, end = np.array(event.start_position), np.array(event.end_position)
        pull = self._size.times(PULL, "N·s/m")
        impulse = pull * (end - start)
        size = float(np.linalg.norm(impulse))
        impulse *= min(1.0, self._size.times(GREATEST_IMPULSE, "N·s") / max(size, 1e-9))
        if event.phase == "end":
            self._pull, self._arrow.visible = None, False
            if size > self._size.times(LEAST_PULL, "N·s"):
                self._inputs.put(Push(tuple(impulse.tolist()), body))
        else:
            self._pull, self._arrow.points = impulse, np.stack([start, start + impulse / pull])[None]
            self._arrow.visible = True

    def _told(self, impulse: Array) -> dict[str, float]:
        size = float(np.linalg.norm(impulse))
        return {"impulse": size, "specific": size / self._pictures.walk.true_mass}

    def _take(self, text: str) -> None:
        """Take what the page sends.

        Raises:
            ValueError: it is not what the page would send.
        """
        given = json.loads(text)
        kind = given.pop("kind", None) if isinstance(given, dict) else None
        if kind == "click":
            self._impulse = _number(given, "impulse", 0.0, self._size.times(GREATEST_IMPULSE, "N·s"))
        elif kind == "camera":
            self._follow = bool(given.get("follows"))
        elif kind == "layer":
            layer = given.get("layer")
            if self._scene is not None and isinstance(layer, str) and layer in self._scene.layers:
                self._scene.layers[layer].visible = bool(given.get("shown"))
        else:
            self._inputs.put(read_input(kind, given, self._size))


def _limits(size: Similarity) -> Velocity:
    """Fastest velocity that a robot of a size is asked for."""
    return Velocity(*size.times(tuple(asdict(LIMITS).values()), "m/s, m/s, 1/s"))


def _gait_ranges(size: Similarity) -> dict[str, tuple[float, float]]:
    """Ranges of what may be asked of its gait."""
    return {key: size.times(ends, GAIT_UNITS[key]) for key, ends in GAIT_RANGES.items()}


def read_input(kind: str | None, given: Mapping[str, Any], size: Similarity = REFERENCE_SIZE) -> Input:
    """An input as the page sends it, bent into what may be asked for of a robot of a size.

    Raises:
        ValueError: there is no such input, or a value is no number.
    """
    if kind == "velocity":
        return Velocity(**{key: _number(given, key, -most, most) for key, most in asdict(_limits(size)).items()})
    if kind == "gait":
        ranges = _gait_ranges(size)
        return Gait(**{key: _number(given, key, *ranges[key]) for key in ranges if key in given})
    if kind == "pace":
        speed = _number(given, "speed", min(SPEEDS), max(SPEEDS)) if "speed" in given else None
        return Pace(speed, bool(given["paused"]) if "paused" in given else None)
    if kind == "reset":
        return Reset()
    raise ValueError(f"no input is called {kind}")


def _number(given: Mapping[str, Any], key: str, low: float, high: float) -> float:
    value = given.get(key)
    if not isinstance(value, int | float) or not math.isfinite(value):
        raise ValueError(f"{key} is {value}, which is no number")
    return min(max(float(value), low), high)


def _numbers(velocity: Any) -> list[float]:
    return [float(velocity.v_x), float(velocity.v_y), float(velocity.yaw_rate)]


def _viewer_page(port: int) -> str:
    """The page that viser serves: its viewer."""
    connection = HTTPConnection(LOCALHOST, port, timeout=30)
    with closing(connection):
        connection.request("GET", "/")
        return connection.getresponse().read().decode()


class _Page(Template):
    delimiter = "@"  # JavaScript has other uses for the usual one


def _page(viewer: str, port: int, walk: Walk) -> str:
    """Viser's page, told where its server is, with the controls beside it."""
    size, ranges = walk.size, _gait_ranges(walk.size)
    gait = {key: float(getattr(walk.gait, key)) for key in ranges}
    curves, margins = (
        [{"name": name, "color": palette.hexadecimal(color), "planned": dashed} for name, color, dashed, *_ in drawn]
        for drawn in (BALANCE, MARGINS)
    )
    feet = [
        {"name": name, "color": palette.hexadecimal(color), "planned": False}
        for name, color in zip(FEET_NAMES, palette.FEET, strict=True)
    ]
    data = {
        "charts": [
            {"label": label, "digits": digits, "curves": drawn}
            for (label, digits), drawn in zip(AXES, (curves, curves, margins, feet), strict=True)
        ],
        "limits": _numbers(_limits(size)),
        "gait": {key: [*ranges[key], value] for key, value in gait.items()},
        "speeds": SPEEDS,
        "impulse": list(size.times((IMPULSE, GREATEST_IMPULSE), "N·s")),
        "layers": LAYERS,
    }
    text = files(__package__).joinpath("drive.html").read_text(encoding="utf-8")
    head, column = text.split("<!-- the column -->")
    title = html.escape(f"{walk.name}, seed {walk.seed}")
    filled = _Page(column).substitute(title=title, data=json.dumps(data).replace("</", "<\\/"))
    before, after = viewer.split("<head>", 1)
    top, tail = after.rsplit("</body>", 1)
    begin = _Page(head).substitute(address=f"ws://{LOCALHOST}:{port}", title=title)
    return f"{before}<head>{begin}{top}{filled}</body>{tail}"


@contextmanager
def opened(port: int | None, inputs: "SimpleQueue[Input]") -> Iterator[DrivePage]:
    """A page for as long as the context lasts; errors as of `serving` and `DrivePage`."""
    with serving((port or PORT) + 1) as viewer, closing(DrivePage(viewer, port, inputs)) as page:
        yield page
