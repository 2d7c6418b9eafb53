"""Worlds that are kinder than they say, judges that see less than there is, and all that is broken by its name."""

from collections.abc import Callable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, replace
from functools import partial
from typing import Any
from unittest.mock import patch
from xml.etree import ElementTree

import numpy as np
from controllers import CONTROLLERS

import surefoot
from surefoot.scenarios.judge import metrics
from surefoot.scenarios.study.checks import check as checking
from surefoot.sim import contacts, scene, world


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


class Numb(contacts.ContactSense):
    """Does not feel that the robot touches itself."""

    def read(self):
        return super().read()[0], False


def _world(made: type) -> Sabotage:
    return Sabotage(patches={"scenarios.run.full.World": made})


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
        patches={"scenarios.run.full.lies": _never, "scenarios.judge.walking.lies": _never}
    ),
    "slip metric halved": Sabotage(judge={"foot_slip_max": halved}),
    "ZMP metrics halved": Sabotage(judge={"zmp_error_rms": halved, "zmp_error_max": halved}),
    "ZMP always inside": Sabotage(judge={"zmp_inside_fraction": lambda _: 1.0}),
    "torque metric halved": Sabotage(judge={"torque_ratio_max": halved}),
    "self-contact never felt": Sabotage(patches={"sim.sensors.ContactSense": Numb}),
}

ALL: Mapping[str, Sabotage] = {
    **{name: Sabotage(surefoot.Parts(controller=made)) for name, made in CONTROLLERS.items()},
    **WORLDS,
    **JUDGES,
}
