"""The page of a drive: the robot in viser's own viewer, with controls and charts beside it."""

import html
import json
import math
from collections.abc import Iterator, Mapping
from contextlib import closing, contextmanager, suppress
from dataclasses import asdict
from functools import partial
from http.client import HTTPConnection
from importlib.resources import files
from typing import TYPE_CHECKING, Any

import numpy as np

from surefoot.apps.drive.channel import DRAWN, PageChannel
from surefoot.apps.drive.picture import Picture, Pictures
from surefoot.apps.drive.session import DriveStatus, GaitInput, Input, Inputs, PaceInput, PushInput, Reset
from surefoot.errors import ParameterError
from surefoot.planner.types import Twist
from surefoot.scenarios import palette
from surefoot.scenarios.run.simulation import Simulation, Tick
from surefoot.scenarios.setup.walk import Walk
from surefoot.scenarios.show.replay.content import Array
from surefoot.scenarios.show.replay.gate import LOCALHOST, VIEWER, Gate, serving
from surefoot.scenarios.show.replay.page import CHARTS, beside, filled, taken_in
from surefoot.scenarios.show.replay.scene import SEE_THROUGH, ViserScene, rgb
from surefoot.similarity import REFERENCE_SIZE, Similarity

if TYPE_CHECKING:
    import viser

LIMITS = Twist(0.6, 0.25, 0.6)
"""Greatest velocities that the page asks for, either way; numbers here are the reference robot's [m/s, rad/s]."""

GAIT_RANGES = {"single_support": (0.35, 1.2), "double_support": (0.08, 0.6), "swing_height": (0.02, 0.12)}
GAIT_UNITS = {"single_support": "s", "double_support": "s", "swing_height": "m"}
"""Units of the sliders [s, s, m]."""

SPEEDS = (1.0, 0.5, 0.25, 0.1)
"""Speeds of simulated over wall-clock time; less than 1 is slow motion."""

IMPULSE, GREATEST_IMPULSE = 15.0, 60.0
"""Impulses of a click at first, and the greatest of any push [N·s]."""

PULL = 100.0
"""Impulse of a drag for each metre [N·s/m]."""

LAYERS = (
    *("Robot", SEE_THROUGH, "CoM", "DCM", "ZMP", "Support polygon", "Planned footprints", "Taken footprints"),
    *("Contact forces", "Pushes"),
)
"""Layers of the scene that can be switched off."""

FARTHER = 1.5
"""Distance of the camera over that in a replay, since the robot may go anywhere [-]."""

LEAST_PULL = 1.0
"""A shorter drag pushes nothing [N·s]."""

FARTHEST = 1e6
"""No point that a browser sends has a greater coordinate [m]."""

LONGEST_QUOTE = 40
"""Characters of what is refused that are said again."""

CHANNEL = "session"
"""Name of the page's websocket, below its address."""

_SOON = "<!doctype html><meta http-equiv=refresh content=1><title>surefoot drive</title>The first run begins."


class DrivePage:
    """Shows the runs of a session in a viewer, and puts what the user does into its inputs; see `session.DriveView`."""

    def __init__(self, viewer: "viser.ViserServer", gate: Gate, inputs: Inputs) -> None:
        self._viewer, self._gate, self._inputs = viewer, gate, inputs
        self._follow, self._size = True, REFERENCE_SIZE
        self._impulse: float | None = None
        self._pull: Array | None = None
        self._pushed: dict[str, Any] | None = None
        self._pictures: Pictures
        self._scene: ViserScene | None = None
        self._channel = PageChannel(self._take, lambda: inputs.put(Twist()))
        gate.page, gate.sockets = _SOON, {CHANNEL: self._channel.serve}

    @property
    def address(self) -> str:
        """Address of the page."""
        return self._gate.address

    def begin(self, robot: Simulation) -> None:
        """See `session.DriveView`; the robot is the same for all runs."""
        self._robot, self._pushed = robot, None
        if self._scene is None:
            self._pictures, self._size = Pictures(robot.walk), robot.walk.size
            if self._impulse is None:  # a page may have sent its own before the first run begins
                self._impulse = self._size.times(IMPULSE, "N·s")
            self._gate.page = _page(_viewer_page(self._gate), robot.walk)
        self._pictures.begin()

    def pushed(self, push: PushInput, time: float) -> None:
        """See `session.DriveView`."""
        self._pictures.pushed(push, time)
        self._pushed = {**self._arrow_data(np.array(push.impulse)), "body": push.body, "time": time}

    @property
    def looked_at(self) -> bool:
        """See `session.DriveView`."""
        return self._channel.looked_at

    @property
    def drawn(self) -> bool:
        """See `session.DriveView`."""
        return self._channel.drawn

    def show(self, tick: Tick, status: DriveStatus) -> None:
        """See `session.DriveView`."""
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
            "pull": None if pull is None else self._arrow_data(pull),
        }
        self._channel.tell(json.dumps(news).replace("NaN", "null"))

    def _followed(self) -> Any:
        try:
            return self._robot.orders.followed or Twist()
        except ParameterError:  # of a planner that takes no commands
            return Twist()

    def _staged(self, picture: Picture) -> ViserScene:
        """The scene, whose robot can be clicked on and dragged."""
        scene = ViserScene(self._viewer, picture)
        camera = self._viewer.initial_camera
        camera.position = camera.look_at + FARTHER * (camera.position - camera.look_at)
        for body, node in scene.skin:
            node.on_click(partial(self._clicked, body))
            node.on_drag("left")(partial(self._dragged, body))
        look: dict[str, Any] = {"head_radius": 0.035, "head_length": 0.08, "shaft_radius": 0.015, "visible": False}
        self._arrow = self._viewer.scene.add_arrows("/Pull", np.zeros((1, 2, 3)), rgb(palette.PUSH), **look)
        return scene

    # Coroutines, since viser calls those one after the other, on the thread of the sockets.
    async def _clicked(self, body: str, event: Any) -> None:
        """Push along the view, but not into the ground."""
        direction = _vector(event.ray_direction)
        if direction is None or self._impulse is None:
            return
        x, y, _ = direction.tolist()
        if (length := math.hypot(x, y)) > 1e-6:
            self._push(PushInput((self._impulse * x / length, self._impulse * y / length, 0.0), body))

    async def _dragged(self, body: str, event: Any) -> None:
        """Pull towards the pointer when it is released; an arrow shows how until then."""
        start, end = _vector(event.start_position), _vector(event.end_position)
        if start is None or end is None:
            return
        pull = self._size.times(PULL, "N·s/m")
        impulse = pull * (end - start)
        size = float(np.linalg.norm(impulse))
        impulse *= min(1.0, self._size.times(GREATEST_IMPULSE, "N·s") / max(size, 1e-9))
        if event.phase == "end":
            self._pull, self._arrow.visible = None, False
            if size > self._size.times(LEAST_PULL, "N·s"):
                self._push(PushInput(tuple(impulse.tolist()), body))
        else:
            self._pull, self._arrow.points = impulse, np.stack([start, start + impulse / pull])[None]
            self._arrow.visible = True

    def _push(self, push: PushInput) -> None:
        with suppress(ValueError):  # of more pushes than anyone can click the last are left out
            self._inputs.put(push)

    def _arrow_data(self, impulse: Array) -> dict[str, float]:
        size = float(np.linalg.norm(impulse))
        return {"impulse": size, "specific": size / self._pictures.walk.true_mass}

    def _take(self, given: Mapping[str, Any]) -> None:
        """Take what the page sends; ValueError where it is not what the page would send."""
        kind = given.get("kind")
        if kind == "click":
            self._impulse = _above_zero(given, "impulse", self._size.times(GREATEST_IMPULSE, "N·s"))
        elif kind == "camera":
            self._follow = _switch(given, "follows")
        elif kind == "layer":
            layer, shown = given.get("layer"), _switch(given, "shown")
            if layer not in LAYERS:
                raise ValueError(f"no layer is called {_short(layer)}")
            if self._scene is not None and layer in self._scene.layers:
                self._scene.layers[layer].visible = shown
        elif kind == "shadows":
            self._viewer.scene.configure_default_lights(cast_shadow=_switch(given, "shown"))
        else:
            self._inputs.put(read_input(kind, given, self._size))


def _limits(size: Similarity) -> Twist:
    """Fastest velocity that a robot of a size is asked for."""
    return Twist(*size.times(LIMITS[:3], "m/s, m/s, 1/s"))


def _gait_ranges(size: Similarity) -> dict[str, tuple[float, float]]:
    """Ranges of what may be asked of its gait."""
    return {key: size.times(ends, GAIT_UNITS[key]) for key, ends in GAIT_RANGES.items()}


def read_input(kind: Any, given: Mapping[str, Any], size: Similarity = REFERENCE_SIZE) -> Input:
    """An input as the page sends it, bent into what may be asked for of a robot of a size.

    Raises:
        ValueError: there is no such input, or a value is not of its kind.
    """
    if kind == "velocity":
        return Twist(*(_number(given, key, -most, most) for key, most in _limits(size).velocity.items()))
    if kind == "gait":
        ranges = _gait_ranges(size)
        return GaitInput(**{key: _number(given, key, *ranges[key]) for key in ranges if key in given})
    if kind == "pace":
        speed = max(_above_zero(given, "speed", max(SPEEDS)), min(SPEEDS)) if "speed" in given else None
        return PaceInput(speed, _switch(given, "paused") if "paused" in given else None)
    if kind == "reset":
        return Reset()
    raise ValueError(f"no input is called {_short(kind)}")


def _number(given: Mapping[str, Any], key: str, low: float, high: float) -> float:
    value = given.get(key)
    try:
        if isinstance(value, bool) or not math.isfinite(value):  # type: ignore[arg-type]
            raise ValueError
        return min(max(float(value), low), high)  # type: ignore[arg-type]
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{key} is {_short(value)}, which is no number") from None


def _above_zero(given: Mapping[str, Any], key: str, high: float) -> float:
    value = _number(given, key, -math.inf, high)
    if value <= 0.0:
        raise ValueError(f"{key} is {_short(value)}; give more than 0")
    return value


def _switch(given: Mapping[str, Any], key: str) -> bool:
    value = given.get(key)
    if not isinstance(value, bool):
        raise ValueError(f"{key} is {_short(value)}; give true or false")
    return value


def _short(value: Any) -> str:
    text = json.dumps(value)
    return text if len(text) <= LONGEST_QUOTE else f"{text[:LONGEST_QUOTE]}..."


def _vector(value: Any) -> Array | None:
    """A point or direction that a browser has sent, shape (3,); None if it is none."""
    try:
        vector = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        return None
    return vector if vector.shape == (3,) and (np.abs(vector) <= FARTHEST).all() else None


def _numbers(velocity: Twist) -> list[float]:
    return [float(value) for value in velocity[:3]]


def _viewer_page(gate: Gate) -> str:
    """The page that viser serves: its viewer."""
    connection = HTTPConnection(LOCALHOST, gate.port, timeout=30)
    with closing(connection):
        connection.request("GET", f"/{gate.token}/{VIEWER}")
        return connection.getresponse().read().decode()


def _page(viewer: str, walk: Walk) -> str:
    """Viser's page with the controls beside it."""
    size, ranges = walk.size, _gait_ranges(walk.size)
    gait = {key: float(getattr(walk.gait, key)) for key in ranges}
    data = {
        "charts": [chart.to_json() for chart in CHARTS],
        "limits": _numbers(_limits(size)),
        "gait": {key: [*ranges[key], value] for key, value in gait.items()},
        "speeds": SPEEDS,
        "impulse": list(size.times((IMPULSE, GREATEST_IMPULSE), "N·s")),
        "layers": {layer: layer != SEE_THROUGH for layer in LAYERS},
    }
    text = files(__package__).joinpath("drive.html").read_text(encoding="utf-8")
    head, column = text.split("<!-- the column -->")
    title = html.escape(f"{walk.name}, seed {walk.seed}")
    controls = filled(beside(column), data, title=title, channel=CHANNEL, drawn=DRAWN)
    return taken_in(viewer, filled(head, title=title), controls)


@contextmanager
def opened(port: int | None, inputs: Inputs) -> Iterator[DrivePage]:
    """A page for as long as the context lasts; LogError if the port is taken."""
    gate = Gate(port)
    with serving(gate) as viewer:
        yield DrivePage(viewer, gate, inputs)
