"""Everything one may turn about the whole-body controller; here are numbers alone, and nothing that works with them."""

from dataclasses import dataclass, field

from surefoot.similarity import REFERENCE_SIZE, Similarity
from surefoot.tunable import check, choice, number, positive

SOLVER_NAMES = ("equality-first", "daqp", "proxqp")
"""Names of the solvers of the QP, which `wbc.qp.solvers` has."""


@dataclass(frozen=True, slots=True)
class TaskWeights:
    """Cost of a squared residual of each task.

    The measured set of docs/whole-body.md: softer trunk, swing and height tasks than those that first walked, since
    near-straight swing legs shook the CoM.

    Raises:
        ParameterError: a weight is negative or not finite, or one is zero that keeps H positive definite.
    """

    com_horizontal: float = number(10.0, "s^4/m^2", "horizontal CoM acceleration")
    com_vertical: float = number(2.5, "s^4/m^2", "vertical CoM acceleration")
    com_vertical_catching: float = number(
        100.0,
        "s^4/m^2",
        "the same while a step is adapted to catch the body, whose swing would else lift it off its legs",
    )
    angular_momentum: float = number(2.0, "s^4/m^4", "rate of angular momentum over mass")
    angular_momentum_catching: float = number(
        0.2, "s^4/m^4", "the same while a step is adapted to catch the body, whose arms and trunk then bear its swing"
    )
    orientation: float = number(1.0, "s^4", "angular acceleration of pelvis and torso")
    upright_catching: float = number(
        0.1,
        "s^4",
        "the same about the horizontal axes while a step is adapted to catch the body, which its hips may then lean",
    )
    turning_catching: float = number(
        0.01,
        "s^4",
        "the same about the vertical while a step is adapted to catch the body, which its stance foot then need not "
        "keep from turning",
    )
    swing: float = number(
        10.0, "s^4/m^2", "linear acceleration of the swing foot, and angular one times the robot's size"
    )
    upper_posture: float = number(0.07, "s^4", "joint acceleration of waist, arms and head")
    leg_posture: float = number(1e-5, "s^4", "joint acceleration of the legs")
    acceleration: float = positive(
        1e-5, "s^4/m^2", "any generalised acceleration, an angular one times the robot's size"
    )
    force: float = positive(1e-6, "1/N^2", "sole force less its planned share of the weight")
    moment: float = positive(1e-4, "1/(N·m)^2", "moment at a sole's centre")

    def __post_init__(self) -> None:
        check(self, "wbc", "weights")


@dataclass(frozen=True, slots=True)
class TaskGains:
    """Feedback of each task: stiffness [1/s^2] and damping [1/s].

    With a stiffness of 40 / s^2 of pelvis and torso, a trunk whose mass sits 0.2 m too high folds at the waist. With
    more than 250 / s^2, a start noise of 1 degree brings the ZMP to the edge. Those of the swing foot are critically
    damped.

    Raises:
        ParameterError: a gain is negative or not finite.
    """

    orientation: tuple[float, float] = number((250.0, 32.0), "1/s^2, 1/s", "stiffness and damping of pelvis and torso")
    swing: tuple[float, float] = number(
        (400.0, 40.0), "1/s^2, 1/s", "stiffness and damping of the swing foot, position and rotation"
    )
    posture: tuple[float, float] = number(
        (20.0, 9.0), "1/s^2, 1/s", "stiffness and damping of the joints towards the posture"
    )
    angular_momentum: float = number(3.0, "1/s", "decay of the angular momentum")

    def __post_init__(self) -> None:
        check(self, "wbc", "gains")


@dataclass(frozen=True, slots=True)
class BalanceGains:
    """Gains of the CoM law. The DCM error decays at the rate (dcm - 1) ω, so ``dcm`` has to be above 1 to balance.

    Raises:
        ParameterError: a gain is negative or not finite, or the share is not within 0 and 1.
    """

    dcm: float = number(3.0, "-", "ZMP moved per DCM error")
    height_stiffness: float = number(60.0, "1/s^2", "vertical stiffness per mass")
    height_damping: float = number(15.0, "1/s", "vertical damping per mass")
    polygon_share: float = positive(0.95, "-", "share of the support polygon that the commanded ZMP may use", most=1.0)
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
    striking: float = number(
        2500.0, "1/s^2", "stiffness that turns a foot on its heel edge to its planned pitch, lest the sole slaps down"
    )
    striking_damping: float = number(100.0, "1/s", "damping of the same")

    def __post_init__(self) -> None:
        check(self, "wbc", "contact")


@dataclass(frozen=True, slots=True)
class ContactParameters:
    """Thresholds of the contact schedule.

    Raises:
        ParameterError: one is negative or not finite, a time or a number of ticks is zero, or a share is above 1.
    """

    felt_force: float = number(8.0, "N", "normal force above which a foot feels the ground")
    felt_ticks: int = positive(2, "-", "consecutive control ticks, at the usual rate, of that force before it counts")
    early_progress: float = number(0.6, "-", "share of its swing from which a swing foot may land", most=1.0)
    early_cap: float = number(50.0, "N", "load allowed on a foot that landed before its time")
    loading_time: float = positive(0.05, "s", "time in which a landed foot's allowed load grows to the full weight")
    unloading_time: float = positive(
        0.1, "s", "time before lift-off in which a foot's allowed load shrinks to its planned share"
    )
    share_margin: float = number(
        0.5, "-", "allowed load above the planned share at the start of unloading, of the weight"
    )

    def __post_init__(self) -> None:
        check(self, "wbc", "schedule")


@dataclass(frozen=True, slots=True)
class StraightKnees:
    """The task that straightens the knees of the legs that carry; without a weight there is none.

    Raises:
        ParameterError: a number is negative or not finite.
    """

    weight: float = number(0.0, "s^4", "acceleration of the knee of a leg that carries all of the weight, 0: no task")
    flexion: float = number(0.2, "rad", "flexion that it is brought to")
    gains: tuple[float, float] = number((40.0, 12.0), "1/s^2, 1/s", "stiffness and damping of the same")

    def __post_init__(self) -> None:
        check(self, "wbc", "knees")


STRAIGHTENED = StraightKnees(weight=0.008)
"""The task in walks whose knees are nearly straight."""


@dataclass(frozen=True, slots=True)
class SeparationParameters:
    """The distances and gains by which limbs keep away from each other.

    An approach of up to attention / horizon can be stopped.

    Raises:
        ParameterError: one is negative or not finite, or the attention or the horizon is zero.
    """

    clearance: float = number(0.003, "m", "distance that must remain")
    attention: float = positive(0.05, "m", "distance from which a pair is looked at")
    horizon: float = positive(0.02, "s", "time constant T of the critically damped approach")
    slots: int = number(6, "-", "pairs that are looked at in one tick, the nearest ones")

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
        knees: how straight those of the legs that carry are.
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
    knees: StraightKnees = field(default_factory=StraightKnees)
    separation: SeparationParameters = field(default_factory=SeparationParameters)
    solver: str = choice("equality-first", SOLVER_NAMES, "QP solver that is tried first")
    second_solver: str = choice("proxqp", SOLVER_NAMES, "QP solver that is tried when the first fails")
    arm_swing: float = number(0.6, "rad/m", "swing of the shoulders per stride")
    size: Similarity = REFERENCE_SIZE

    def __post_init__(self) -> None:
        check(self, "wbc")
