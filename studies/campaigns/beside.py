"""A policy beside Surefoot's own walk in one campaign: the same pushes, and two thresholds of each."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from surefoot.errors import ParameterError
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.show.options import seat
from surefoot.studies.campaigns.spec import Spec

WALKER = "walker"
"""Name of the axis of the two."""

SPEED = 0.3
"""At which both walk where the campaign lets its robot march in place, since most policies stand then [m/s]."""

FARTHER = 8.0
"""Times the top of the range up to which a threshold is sought that lies above it [-]."""


@dataclass(frozen=True, slots=True)
class Beside:
    """Names of the two walkers beside each other.

    Attributes:
        policy: file or folder of the policy, or the name of a controller.
        robot: whose walk by Surefoot's own planner stands beside it.
    """

    policy: str
    robot: str

    @property
    def name(self) -> str:
        """Name of the policy, by its file or folder."""
        path = Path(self.policy)
        return path.resolve().parent.name if path.is_file() and path.stem in ("contract", "deploy") else path.stem

    def laid(self, spec: Spec, place: str) -> Spec:
        """The campaign with both walkers, on the first axis.

        Args:
            spec: of the campaign.
            place: what to call its file in messages.

        Raises:
            ScenarioError: it searches no thresholds, both have the same name, or the policy cannot be read.
        """
        if spec.bisect is None:
            raise ScenarioError([f"{place}: searches no thresholds; give --beside to a campaign with a bisect"])
        if WALKER in spec.grid or self.name == self.robot:
            what = f"the grid has an axis '{WALKER}'" if WALKER in spec.grid else f"both are called '{self.robot}'"
            raise ScenarioError([f"{place}: {what}; rename it"])
        key, value = seat(self.policy)[0].split("=", 1)
        if key == "controller.policy":
            _read(Path(self.policy))
        walkers: dict[str, dict[str, Any]] = {self.name: {key: value.strip('"')}, self.robot: {"robot": self.robot}}
        fixed, bisect = dict(spec.set), spec.bisect
        if marches(fixed.get("commands", ())):
            fixed["commands"] = [{"time": 0.0, "v_x": SPEED}]
        if bisect.ratio is None and bisect.most is None:
            bisect = bisect.model_copy(update={"most": FARTHER * bisect.high})
        return spec.model_copy(update={"grid": {WALKER: walkers, **spec.grid}, "set": fixed, "bisect": bisect})


def _read(policy: Path) -> None:
    """See that a policy is there, before the walk beside it is run for nothing."""
    from surefoot.scenarios.policy.files import named_robot

    try:
        named_robot(policy)
    except ParameterError as refusal:
        raise ScenarioError([str(refusal)]) from None


def marches(commands: Sequence[Mapping[str, Any]]) -> bool:
    """True of commands that say nothing but to march in place."""
    return bool(commands) and all(set(command) <= {"time", "march"} for command in commands)
