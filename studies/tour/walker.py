"""The seat in which a walker goes through a ride, whoever made it."""

from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from surefoot.joints import JointCommand
from surefoot.models.types import RobotDescription
from surefoot.planner.types import PhaseInfo, Twist
from surefoot.studies.tour.world import TourWorld

Array = NDArray[np.float64]


class Goal(NamedTuple):
    """Place to which a walker is to go.

    Attributes:
        slot: number of the place, which changes when another one is to be gone to.
        way: to the place in the frame of the pelvis' heading, forward and to the left [m].
        turn: to its heading [rad].
    """

    slot: int
    way: tuple[float, float]
    turn: float


class TourWalker(Protocol):
    """A walker in its seat.

    Attributes:
        robot: that it walks.
        posture: configuration in which it begins on its feet, shape (nq,) [m, -, rad].
    """

    robot: RobotDescription
    posture: Array

    @property
    def gait(self) -> PhaseInfo:
        """Phase of the gait now."""
        ...

    @property
    def unsolved(self) -> bool:
        """True where the last tick's QP had no solution; never of a walker without one."""
        ...

    @property
    def falling(self) -> bool:
        """True where it is sure to fall; never of a walker that does not say."""
        ...

    def reset(self, q: Array) -> None:
        """Begin anew in a configuration that stands, shape (nq,)."""
        ...

    def step(self, world: TourWorld, goal: Goal, arms: JointCommand | None) -> JointCommand:
        """The command of the joints until the next tick.

        Args:
            world: of which it is shown what its row says.
            goal: where to go.
            arms: what somebody else gives the arms; None where nobody does.

        Raises:
            RunFault: it gives up.
            PartError: it is of others and fails.
        """
        ...

    def follow(self, world: TourWorld, twist: Twist, arms: JointCommand | None) -> JointCommand:
        """The same for a velocity of the base in its heading, in place of a place."""
        ...


class Entrant(Protocol):
    """A walker that is entered for the tour; it goes to other processes.

    Attributes:
        name: of its row.
        meaning: what it is given and gives, in a few words.
        rate: at which it is asked [Hz].
        drives_arms: whether the harness drives the arms.
    """

    @property
    def name(self) -> str:
        """See `Entrant`."""
        ...

    @property
    def meaning(self) -> str:
        """See `Entrant`."""
        ...

    @property
    def rate(self) -> int:
        """See `Entrant`."""
        ...

    @property
    def drives_arms(self) -> bool:
        """See `Entrant`."""
        ...

    def digest(self) -> str:
        """Digests of files that it is made of and that do not come with Surefoot."""
        ...

    def walker(self) -> TourWalker:
        """A walker that has not begun yet.

        Raises:
            ScenarioError: the robot of the tour cannot be walked so.
            ParameterError: a policy cannot walk that robot.
        """
        ...
