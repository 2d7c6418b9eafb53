"""Everything one may turn about the whole-body controller."""

from dataclasses import dataclass, field

from surefoot.errors import ParameterError
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.balance import BalanceGains
from surefoot.wbc.contacts import ContactParameters
from surefoot.wbc.dynamics import ContactGains
from surefoot.wbc.separation import SeparationParameters
from surefoot.wbc.solvers import SOLVERS
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tunable import check, number


@dataclass(frozen=True, slots=True)
class WbcParameters:
    """Everything one may turn; each number carries its unit and meaning as metadata of its dataclass field.

    The defaults are those of the reference robot; `Similarity.scaled` makes them those of a robot of another size.

    Attributes:
        weights: of the tasks.
        gains: of the tasks.
        balance: gains of the CoM law.
        contact: gains of the rigid contacts.
        schedule: thresholds of the contact schedule.
        separation: when limbs keep away from each other.
        solver: the solver tried first, chosen by ``benchmarks/qp_solvers.py``.
        second_solver: the one tried when the first fails.
        arm_swing: swing of the shoulders per stride.
        size: of the robot, for what is no parameter.

    Raises:
        ParameterError: there is no such solver, or a number is out of its range.
    """

    weights: TaskWeights = field(default_factory=TaskWeights)
    gains: TaskGains = field(default_factory=TaskGains)
    balance: BalanceGains = field(default_factory=BalanceGains)
    contact: ContactGains = field(default_factory=ContactGains)
    schedule: ContactParameters = field(default_factory=ContactParameters)
    separation: SeparationParameters = field(default_factory=SeparationParameters)
    solver: str = field(default="equality-first", metadata={"doc": "QP solver that is tried first"})
    second_solver: str = field(default="proxqp", metadata={"doc": "QP solver that is tried when the first fails"})
    arm_swing: float = number(0.6, "rad/m", "swing of the shoulders per stride")
    size: Similarity = REFERENCE_SIZE

    def __post_init__(self) -> None:
        check(self, "wbc")
        for name in ("solver", "second_solver"):
            value = getattr(self, name)
            if value not in SOLVERS:
                raise ParameterError(
                    ("wbc", name), f"wbc.{name} is '{value}'", f"choose one of {', '.join(sorted(SOLVERS))}"
                )
