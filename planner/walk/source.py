"""Where the steps of a walk come from: one after another, when the queue asks for the next."""

from dataclasses import dataclass
from typing import Protocol

from surefoot.planner.walk.gait import GaitParameters, Stride


@dataclass(frozen=True, slots=True)
class StepOrder:
    """A step to come.

    Attributes:
        stride: what it does to the path.
        stand: standing before the weight shift to it; of a step that follows another without a stop it says nothing
            [s].
    """

    stride: Stride
    stand: float = 0.0


class StepSource(Protocol):
    """Gives the steps of a walk one by one."""

    def order(self, step: int, time: float, before: Stride | None) -> StepOrder | None:
        """The next step.

        Args:
            step: its number, from 1.
            time: on the clock of the gait; when its foot would lift off, or from when on the robot stands [s].
            before: stride of the step before it; None when the robot stands.

        Returns:
            The step; None to stand, in a walk until the next bout, in standing as far as is known for ever.
        """


class GaitSource:
    """The steps of a gait: equal strides of which the last closes the stance, or those of its bouts.

    Args:
        gait: the gait.
    """

    def __init__(self, gait: GaitParameters) -> None:
        self._gait = gait
        self._begins: dict[int, float] = {}
        step = 1
        for bout in gait.bouts:
            self._begins[step] = bout.stand
            step += len(bout.strides)
        if not gait.bouts:
            self._begins[1] = gait.initial_stand
        self._strides = tuple(stride for bout in gait.bouts for stride in bout.strides)

    def order(self, step: int, time: float, before: Stride | None) -> StepOrder | None:
        """See `StepSource`."""
        if step > self._gait.steps or (before is not None and step in self._begins):
            return None
        return StepOrder(self._stride(step), self._begins.get(step, 0.0))

    def _stride(self, step: int) -> Stride:
        gait = self._gait
        if self._strides:
            return self._strides[step - 1]
        if step == gait.steps:
            return Stride(0.0, 0.0, 0.0, gait.step_width)
        return Stride(gait.step_length, gait.lateral_step, gait.turn, gait.step_width)
