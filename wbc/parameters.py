"""Everything one may turn about the whole-body controller; here are numbers alone, and nothing that works with them."""

from dataclasses import dataclass, field

from surefoot.errors import ParameterError
from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.wbc.tasks.parameters import TaskGains, TaskWeights
from surefoot.wbc.tunable import check, number

SOLVER_NAMES = ("equality-first", "daqp", "proxqp")
"""Of the solvers of the QP, which `wbc.solvers` has."""


@dataclass(frozen=True, slots=True)
class BalanceGains:
    """Gains of the CoM law. The DCM error decays at the rate (dcm - 1) ω, so ``dcm`` has to be above 1 to balance.

    Raises:
        ParameterError: a gain is negative or not finite, or the share is not within 0 and 1.
    """

    dcm: float = number(3.0, "-", "ZMP moved per DCM error")
    height_stiffness: float = number(60.0, "1/s^2", "vertical stiffness per mass")
    height_damping: float = number(15.0, "1/s", "vertical damping per mass")
    polygon_share: float = number(
        0.95, "-", "share of the support polygon that the commanded ZMP may use", positive=True, most=1.0
    )
    beyond_catching: float = number(
        0.07,
        "m",
        "how far beyond that it may lie while a step is adapted to catch the body, whose hips then turn the trunk",
    )

    def __post_init__(self) -> None:
        check(self, "wbc", "balance")


@dataclass(frozen=True, slots=True)
class ContactGains:
    """Stabilisation of the rigid contacts.

    Raises:
        ParameterError: a gain is negative or not finite.
    """

    damping: float = number(20.0, "1/s", "decay of a sole's remaining velocity")
    softening: float = number(50.0, "1/s", "decay to `sinking` of the speed at which a sole lands that is not felt yet")
    sinking: float = number(0.1, "m/s", "speed at which such a sole goes on down until it is felt")
    levelling: float = number(
        100.0, "1/s^2", "stiffness that turns an active sole flat on the ground of its planned normal"
    )

    def __post_init__(self) -> None:
        check(self, "wbc", "contact")


@dataclass(frozen=True, slots=True)
class ContactParameters:
    """Thresholds of the contact schedule.

    Raises:
        ParameterError: one is negative or not finite, a time or a number of ticks is zero, or a share is above 1.
    """

    felt_force: float = number(8.0, "N", "normal force above which a foot feels the ground")
    felt_ticks: int = number(
        2, "-", "consecutive control ticks, at the usual rate, of that force before it counts", positive=True
    )
    early_progress: float = number(0.6, "-", "share of its swing from which a swing foot may land", most=1.0)
    early_cap: float = number(50.0, "N", "load allowed on a foot that landed before its time")
    loading_time: float = number(
        0.05, "s", "time in which a landed foot's allowed load grows to the full weight", positive=True
    )
    unloading_time: float = number(
        0.1, "s", "time before lift-off in which a foot's allowed load shrinks to its planned share", positive=True
    )
    share_margin: float = number(
        0.5, "-", "allowed load above the planned share at the start of unloading, of the weight"
    )

    def __post_init__(self) -> None:
        check(self, "wbc", "schedule")


@dataclass(frozen=True, slots=True)
class SeparationParameters:
    """When limbs keep away from each other. An approach of up to attention / horizon can be stopped.

    Raises:
        ParameterError: one is negative or not finite, or the attention or the horizon is zero.
    """

    clearance: float = number(0.003, "m", "distance that must remain")
    attention: float = number(0.05, "m", "distance from which a pair is looked at", positive=True)
    horizon: float = number(0.02, "s", "time constant T of the critically damped approach", positive=True)
    slots: int = number(3, "-", "pairs that are looked at in one tick, the nearest ones")

    def __post_init__(self) -> None:
        check(self, "wbc", "separation")


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
        solver: the solver tried first, chosen by ``python -m benchmarks solvers``.
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
            if value not in SOLVER_NAMES:
                raise ParameterError(
                    ("wbc", name), f"wbc.{name} is '{value}'", f"choose one of {', '.join(sorted(SOLVER_NAMES))}"
                )
