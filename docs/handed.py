"""Tables of the values that pass between Surefoot and parts of others, from their docstrings."""

import inspect
import re
from dataclasses import dataclass
from typing import Any

from page_table import table

from surefoot.planner.laws.law import Motion, MotionProblem, StepContext
from surefoot.planner.plan.plan import WalkPlan
from surefoot.planner.references.zmp_reference import ZmpReference
from surefoot.planner.types import CentroidalState, FeetState
from surefoot.sim.measurement import Measurement
from surefoot.wbc.body.model import RobotTerms
from surefoot.wbc.reference import WbcReference
from surefoot.wbc.tasks.task import Task
from surefoot.wbc.types import RobotState


@dataclass(frozen=True, slots=True)
class Handed:
    """A value that passes between Surefoot and a part of others.

    Attributes:
        thing: the class, or the function whose arguments it is.
        why: who gets it, and who gives it.
    """

    thing: Any
    why: str

    def entries(self) -> list[tuple[str, str]]:
        """Names and meanings, as the documentation of the class or function has them."""
        text = inspect.cleandoc(self.thing.__doc__)
        section = re.search(r"(?ms)^(?:Attributes|Args):\n(.*?)(?=^\S|\Z)", text)
        assert section is not None, self.thing
        found = re.findall(r"(?m)^    (\w+): (.*(?:\n {5,}.*)*)", section[1])
        answer = re.search(r"(?ms)^Returns:\n(.*?)(?=^\S|\Z)", text)
        found += [("returns", answer[1])] if answer else []
        return [(name, " ".join(meaning.split()).rstrip(".")) for name, meaning in found]


HANDED = (
    Handed(Task.write, "A task is called with these, once per control tick."),
    Handed(RobotTerms, "`terms` of a task: the robot in this tick. Feet are left, right."),
    Handed(WbcReference, "`reference` of a task: what the robot shall do until the next tick."),
    Handed(MotionProblem, "A law gets it, once per plan."),
    Handed(ZmpReference, "`reference` of it; n is N + M + 1."),
    Handed(StepContext, "`steps` of it."),
    Handed(Motion, "A law gives it."),
    Handed(CentroidalState, "A planner gets it, as `state`."),
    Handed(FeetState, "A planner gets it, as `feet`."),
    Handed(WalkPlan, "A planner gives it."),
    Handed(Measurement, "An estimator gets it, once per control tick."),
    Handed(RobotState, "An estimator gives it."),
)
"""In the order of the page."""


def tables() -> str:
    """Tables of what parts of others get and give, with shapes and units."""
    return "\n\n".join(_handed(one) for one in HANDED)


def _handed(handed: Handed) -> str:
    rows = (_row(*entry) for entry in handed.entries())
    entries = table(("name", "shape", "unit", "meaning"), rows)
    return "\n".join([f"### `{handed.thing.__qualname__}`", "", handed.why, "", entries])


def _row(name: str, meaning: str) -> list[str]:
    meaning, shape = _taken_out(meaning, SHAPE)
    meaning, unit = _taken_out(meaning, r"\[([^\[\]]*)\]")
    return [f"`{name}`", shape, unit, meaning.replace("|", "/").replace("``", "`")]


SHAPE = r"shape (?:\([a-z, ]+\) = )?(\([^()]*\))"


def _taken_out(text: str, pattern: str) -> tuple[str, str]:
    """A text without the first place of a pattern and the comma before it, and what stood there."""
    found = re.search(rf",? ?{pattern}", text)
    if found is None:
        return text, ""
    return (text[: found.start()] + text[found.end() :]).strip(), found[1]
