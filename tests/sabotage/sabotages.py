"""Worlds that are kinder than they say, judges that see less than there is, and all that is broken by its name."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import numpy as np
from controllers import CONTROLLERS

import surefoot
from surefoot.scenarios.check import check as checking
from surefoot.scenarios.judge import feet, metrics, verdict
from surefoot.sim import contacts, drives, readings, scene, world


@dataclass(frozen=True)
class Sabotage:
    """Something broken in the stack, which `surefoot check` runs on while it is at work.

    Attributes:
        parts: of the loop, of which one may be broken.
        patches: what stands in the place of what, by dotted name.
        judge: what becomes of the values of metrics, by name.
    """

    parts: surefoot.Parts | None = None
    patches: Mapping[str, Any] | None = None
    judge: Mapping[str, Callable[[Any], Any]] | None = None

    @contextmanager
    def at_work(self) -> Iterator[None]:
        """Break it, for a while."""
        with ExitStack() as stack:
            stack.enter_context(patch.object(checking, "run_scenario", self._run))
            for name, broken in (self.patches or {}).items():
                stack.enter_context(patch(f"surefoot.{name}", broken))
            stack.enter_context(patch.dict(metrics.OWN, dict(self._metrics())))
            yield

    def _run(self, scenario: Any, out: Any) -> Any:
        return surefoot.run(scenario, out=out, parts=self.parts)

    def _metrics(self) -> Iterator[tuple[str, Any]]:
        for name, change in (self.judge or {}).items():
            sound = metrics.OWN[name]
            yield name, replace(sound, function=partial(_changed, sound.function, change))


def _changed(function: Callable[[Any], Any], change: Callable[[Any], Any], run: Any) -> Any:
    value = function(run)
    return None if value is None else change(value)


def halved(value: Any) -> Any:
    """Half of a number, or of each."""
    return [0.5 * one for one in value] if isinstance(value, list) else 0.5 * value


class Grippy(world.World):
    """Half as much friction again, which the text of the world does not say."""

    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        self.model.geom_friction[:, 0] *= 1.5


class Ghost(world.World):
    """The robot does not touch itself, which the text does not say."""

    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        self.model.geom_conaffinity[self.model.geom_bodyid != 0] = 1


class Light(world.World):
    """Two percent less gravity, which the text does not say."""

    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        self.model.opt.gravity[:] *= 0.98


class Viscous(world.World):
    """Joints are damped, which the text does not say."""

    def __init__(self, *given, **named):
        super().__init__(*given, **named)
        self.model.dof_damping[6:] = 2.0


def rewritten(kind: str, attributes: tuple[str, ...], factor: float) -> Callable[..., str]:
    """A maker of worlds in whose text the first of some numbers of all elements of a kind are so much greater."""
    sound = scene.world_mjcf

    def made(*given: Any, **named: Any) -> str:
        root = ElementTree.fromstring(sound(*given, **named))
        for element in root.iter(kind):
            for name in attributes:
                if name in element.attrib:
                    numbers = np.array(element.attrib[name].split(), dtype=float)
                    numbers[: 2 if name.endswith("range") else 1] *= factor
                    element.set(name, " ".join(map(repr, numbers.tolist())))
        return ElementTree.tostring(root, encoding="unicode")

    return made


def _never(height: Any, nominal: float, tilt: Any, touching: Any) -> Any:
    """A fall detector that never fires."""
    return np.zeros(np.shape(height), dtype=bool)


def _wider(share: float) -> Callable[..., Iterator[str]]:
    """A judge whose bounds are wider by a share than they say."""
    sound = verdict._missed

    def judged(name: str, bound: Any, values: Any) -> Iterator[str]:
        def moved(limit: Any, sign: float) -> Any:
            if limit is None or isinstance(limit, tuple):
                return limit and tuple(moved(one, sign) for one in limit)
            return limit + sign * share * abs(limit)

        wide = {"min": moved(bound.min, -1.0), "max": moved(bound.max, 1.0)}
        yield from sound(name, bound.model_copy(update=wide), values)

    return judged


def _one_sided(foot: int) -> Callable[..., Any]:
    """A judge that sees the slip of one foot alone."""
    sound = feet.stance_slips
    return lambda *given: [slip for slip in sound(*given) if slip.foot == foot]


class Strong(world.World):
    """The left foot measures two percent more moment than there is."""

    def measure(self):
        measured = super().measure()
        wrenches = measured.wrench.copy()
        wrenches[0, 3:] *= 1.02
        return replace(measured, wrench=wrenches)


def _erring(**factors: float) -> type:
    """Sensors whose errors are so many times what they are said to be, by what begins their names."""

    class Erring(readings.SensorSuite):
        def __init__(self, world, errors, *given):
            terms = {
                entry.name: factor * getattr(errors, entry.name)
                for beginning, factor in factors.items()
                for entry in fields(errors)
                if entry.name.startswith(beginning) and isinstance(getattr(errors, entry.name), float)
            }
            super().__init__(world, replace(errors, **terms), *given)

    return Erring


def _delivered(**changed: float) -> type:
    """Sensors that come otherwise than they are said to."""

    class Delivered(readings.SensorSuite):
        def __init__(self, world, errors, *given):
            groups = {name: replace(getattr(errors, name), **changed) for name in ("joints", "imu", "feet")}
            super().__init__(world, replace(errors, **groups), *given)

    return Delivered


def _drives(**changed: Any) -> Callable[..., drives.Drives]:
    """Motors that err otherwise than they are said to."""
    return lambda robot, errors, *given: drives.Drives(robot, replace(errors, **changed), *given)


class Numb(contacts.ContactSense):
    """Does not feel that the robot touches itself."""

    def read(self):
        return super().read()[0], False


def _world(made: type) -> Sabotage:
    return Sabotage(patches={"scenarios.run.full.World": made})


def _sensors(made: type) -> Sabotage:
    return Sabotage(patches={"sim.readings.SensorSuite": made})


SLIPS = ("scenarios.judge.feet.stance_slips", "scenarios.check.signs.stance_slips")
"""Places where slips are looked at."""


WORLDS: Mapping[str, Sabotage] = {
    "friction times 1.5": _world(Grippy),
    "no self-collision": _world(Ghost),
    "2 % less gravity": _world(Light),
    "damped joints": _world(Viscous),
    "motors 1.5 times as strong": Sabotage(
        patches={"sim.world.world_mjcf": rewritten("motor", ("ctrlrange", "forcerange"), 1.5)}
    ),
    "ground twice as soft": Sabotage(patches={"sim.world.world_mjcf": rewritten("geom", ("solref",), 2.0)}),
}

JUDGES: Mapping[str, Sabotage] = {
    "fall detector never fires": Sabotage(
        patches={"scenarios.run.moved.lies": _never, "scenarios.judge.walking.lies": _never}
    ),
    "slip metric halved": Sabotage(judge={"foot_slip_max": halved}),
    "ZMP metrics halved": Sabotage(judge={"zmp_error_rms": halved, "zmp_error_max": halved}),
    "ZMP always inside": Sabotage(judge={"zmp_inside_fraction": lambda _: 1.0}),
    "torque metric halved": Sabotage(judge={"torque_ratio_max": halved}),
    "self-contact never felt": Sabotage(patches={"sim.sensors.ContactSense": Numb}),
    "bounds of criteria 5 % wider": Sabotage(patches={"scenarios.judge.verdict._missed": _wider(0.05)}),
    "slip of the right foot not seen": Sabotage(patches=dict.fromkeys(SLIPS, _one_sided(0))),
    "slip of the left foot not seen": Sabotage(patches=dict.fromkeys(SLIPS, _one_sided(1))),
}

HARDWARE: Mapping[str, Sabotage] = {
    "left foot's moment 2 % off": _world(Strong),
    "gyro's errors doubled": _sensors(_erring(gyro=2.0)),
    "accelerometer's errors doubled": _sensors(_erring(accelerometer=2.0)),
    "encoders' errors doubled": _sensors(_erring(encoder=2.0)),
    "force sensors' errors doubled": _sensors(_erring(wrench=2.0, moment=2.0)),
    "IMU where it should be": _sensors(_erring(imu=0.0)),
    "readings at once": _sensors(_delivered(latency=0.0)),
    "no reading is lost": _sensors(_delivered(dropout=0.0)),
    "motors at once": Sabotage(patches={"scenarios.run.full.Drives": _drives(delay=0.0)}),
    "motors without noise": Sabotage(patches={"scenarios.run.full.Drives": _drives(noise=0.0)}),
    "joints without friction": Sabotage(
        patches={"sim.world.world_mjcf": rewritten("joint", ("damping", "frictionloss"), 0.0)}
    ),
}

ALL: Mapping[str, Sabotage] = {
    **{name: Sabotage(surefoot.Parts(controller=made)) for name, made in CONTROLLERS.items()},
    **WORLDS,
    **JUDGES,
    **HARDWARE,
}
