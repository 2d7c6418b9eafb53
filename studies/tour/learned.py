"""A policy in the seat of the tour: its contract connects it to the robot, and steers it to its places."""

from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from surefoot.joints import JointCommand
from surefoot.planner.steps.commands import Command
from surefoot.planner.types import PhaseInfo, Twist
from surefoot.scenarios.policy.controller import Policy
from surefoot.scenarios.policy.files import digest_of
from surefoot.scenarios.run.felt import FeltGait
from surefoot.scenarios.run.seat import standing
from surefoot.scenarios.setup.robot.body import body_of
from surefoot.scenarios.setup.walk import Walk, resolve
from surefoot.studies.tour.robot import arms_of, tour_robot
from surefoot.studies.tour.rows import scenario_of
from surefoot.studies.tour.steering import Steering
from surefoot.studies.tour.walker import Goal
from surefoot.studies.tour.world import RATE, TourWorld

Array = NDArray[np.float64]

LEAST_RATE = 50
"""At which the ride asks a policy at least, since the arms move that often [Hz]."""


@dataclass(frozen=True, slots=True)
class LearnedEntrant:
    """A policy that is entered for the tour.

    Attributes:
        name: of its row.
        file: of its contract, or its folder.
        rate: at which it is asked [Hz].
        drives_arms: always: the arms are not its own.
    """

    name: str
    file: str
    rate: int
    drives_arms: bool = True

    @classmethod
    def of(cls, file: Path) -> "LearnedEntrant":
        """The policy of a file or a folder, which is tried first.

        Raises:
            ParameterError: it cannot walk the robot of the tour.
        """
        path = file.resolve()
        name = path.parent.name if path.is_file() and path.stem in _USUAL else path.stem
        policy = Learned(str(path)).policy
        rate = round(policy.contract.rate)
        asked = rate if rate >= LEAST_RATE and RATE % rate == 0 and rate == policy.contract.rate else RATE
        return cls(name, str(path), asked)

    @property
    def meaning(self) -> str:
        """See `Entrant`."""
        return f"policy {self.name}: what its contract observes in, positions of its joints out"

    def digest(self) -> str:
        """Digest of contract and network as they are now."""
        return digest_of(self.file)

    def walker(self) -> "Learned":
        """See `Entrant`."""
        return Learned(self.file)


_USUAL = ("contract", "walker", "policy", "deploy")
"""Names of contracts that say nothing, so that the row is called as the folder."""


class Learned:
    """A policy that goes through a ride; see `TourWalker`.

    Args:
        file: of its contract, or its folder.

    Attributes:
        robot: that it walks.
        posture: configuration in which it begins on its feet, shape (nq,).
        policy: that decides.
    """

    unsolved = falling = False

    def __init__(self, file: str) -> None:
        walk = _walk()
        self.robot = walk.robot
        self.policy = Policy(walk, file, known_as=tour_robot().stands_for)
        self.policy.connection.drive(arms_of(self.robot.joint_names))
        self.posture = standing(walk, body_of(self.robot), self.policy.posture)
        self._size, self._mass = walk.size, float(self.robot.mass)

    @property
    def gait(self) -> PhaseInfo:
        """See `TourWalker`; that which the feet feel."""
        return self._felt.phase

    def reset(self, q: Array) -> None:
        """See `TourWalker`."""
        self.policy.reset(q)
        self._steering, self._felt = Steering(self.policy.contract), FeltGait(self._mass, self._size)

    def step(self, world: TourWorld, goal: Goal, arms: JointCommand | None) -> JointCommand:
        """See `TourWalker`."""
        return self.follow(world, self._steering.velocity(goal, world.time), arms)

    def follow(self, world: TourWorld, twist: Twist, arms: JointCommand | None) -> JointCommand:
        """See `TourWalker`."""
        seen = world.measure()
        self._felt.update(seen.time, seen.wrench[:, 2])
        return self.policy.step(seen, Command(twist))


@lru_cache(maxsize=1)
def _walk() -> Walk:
    return resolve(scenario_of(()))
