"""The channels of a run: the single source of what is logged, in which order, shape, unit and frame.

Feet are ordered left, right; wrenches force first; poses x y z qx qy qz qw; q and v follow Pinocchio's convention.
"""

from dataclasses import dataclass

from surefoot.scenarios.documented import doc_of
from surefoot.scenarios.log.spec import ChannelSpec, FieldSpec
from surefoot.wbc.tasks import DEFAULT_LAYOUT, TaskLayout

SUPPORT_VERTICES = 8
"""Vertices that a planned support polygon is padded to."""


@dataclass(frozen=True, slots=True)
class Sizes:
    """Numbers that shape the channels.

    Attributes:
        nj: actuated joints.
        nq: configuration coordinates.
        nv: velocity coordinates.
        horizon: samples of the planner's preview.
        tasks: names and sizes of the whole-body tasks.
        nf: joints that follow others.
    """

    nj: int
    nq: int
    nv: int
    horizon: int
    tasks: TaskLayout = DEFAULT_LAYOUT
    nf: int = 0


def _real(name: str, shape: int | tuple[int, ...], unit: str, frame: str, doc: str) -> FieldSpec:
    return FieldSpec(name, (shape,) if isinstance(shape, int) else shape, unit, frame, doc)


def _scalar(name: str, unit: str, doc: str) -> FieldSpec:
    return FieldSpec(name, (), unit, "", doc)


def _int(name: str, doc: str, *shape: int) -> FieldSpec:
    return FieldSpec(name, shape, "-", "", doc, "int")


_STEP = "in the physics step that ended at the message's time"
"""Instant of forces: they follow from the state in which that step began."""

_PUSHED = "sum of pushes, mean over the tick that ends at the message's time; NaN where a plant does not measure it"


def measurement(n: Sizes) -> ChannelSpec:
    """Values of ideal sensors and of the pushes, every control tick."""
    fields = (
        _real("joint_position", n.nj, "rad", "", "encoders"),
        _real("joint_velocity", n.nj, "rad/s", "", "encoders"),
        _real("joint_torque", n.nj, "N m", "", f"applied {_STEP}"),
        _real("gyro", 3, "rad/s", "imu", "angular velocity"),
        _real("accelerometer", 3, "m/s^2", "imu", f"specific force {_STEP}"),
        _real("wrench_left", 6, "N, N m", "left sole", f"contact wrench at the sole centre {_STEP}"),
        _real("wrench_right", 6, "N, N m", "right sole", f"contact wrench at the sole centre {_STEP}"),
        _real("external_force", 3, "N", "world", _PUSHED),
    )
    return ChannelSpec("/measurement", "Measurement", fields, doc_of(measurement))


def readings(n: Sizes) -> ChannelSpec:
    """Readings that sensors give an estimator, every control tick; only in a run whose estimator reads them."""
    fields = (
        _real("joint_position", n.nj, "rad", "", "encoders"),
        _real("joint_velocity", n.nj, "rad/s", "", "encoders; NaN of those that say none"),
        _real("joint_torque", n.nj, "N m", "", "motors"),
        _real("angular_velocity", 3, "rad/s", "own imu", "gyroscope, at the instant"),
        _real("mean_angular_velocity", 3, "rad/s", "own imu", "gyroscope, mean over the tick that ended then"),
        _real("specific_force", 3, "m/s^2", "own imu", "accelerometer, mean over the tick that ended then"),
        _real("wrench_left", 6, "N, N m", "left sole", "at the sole centre; NaN without sensors"),
        _real("wrench_right", 6, "N, N m", "right sole", "at the sole centre; NaN without sensors"),
        _scalar("joint_age", "s", "of what encoders and motors say"),
        _scalar("imu_age", "s", "of what the IMU says"),
        _scalar("wrench_age", "s", "of what the feet say; NaN without sensors"),
        _int("joint_fresh", "1: it has come since the tick before"),
        _int("imu_fresh", "1: it has come since the tick before"),
        _int("wrench_fresh", "1: it has come since the tick before"),
    )
    return ChannelSpec("/readings", "Readings", fields, doc_of(readings))


def truth(n: Sizes) -> ChannelSpec:
    """The simulator's state, every control tick."""
    fields = (
        _real("q", n.nq, "m, -, rad", "world", "configuration"),
        _real("v", n.nv, "m/s, rad/s", "base", "velocity"),
        _real("com", 3, "m", "world", "CoM"),
        _real("com_velocity", 3, "m/s", "world", "CoM velocity"),
        _real("angular_momentum", 3, "N m s", "world", "about the CoM"),
        _real("left_sole", 7, "m, -", "world", "pose of the sole centre"),
        _real("right_sole", 7, "m, -", "world", "pose of the sole centre"),
        _scalar("torso_tilt", "rad", "angle of the torso from the vertical"),
        _int("nonfoot_contact", "1: something but a foot touches the ground"),
        _int("self_contact", "1: the robot touches itself"),
    )
    return ChannelSpec("/truth", "Truth", fields, doc_of(truth))


def point_truth(_: Sizes) -> ChannelSpec:
    """The pendulum's state, every control tick."""
    fields = (
        _real("com", 3, "m", "world", "CoM"),
        _real("com_velocity", 3, "m/s", "world", "CoM velocity"),
        _real("left_sole", 7, "m, -", "world", "pose of the sole centre"),
        _real("right_sole", 7, "m, -", "world", "pose of the sole centre"),
        _real("external_force", 3, "N", "world", "sum of pushes, mean over the tick that begins at the message's time"),
    )
    return ChannelSpec("/truth", "PointTruth", fields, doc_of(point_truth))


def estimate(_: Sizes) -> ChannelSpec:
    """The state that the whole-body controller was given, by its robot model, and the load with which it counted."""
    fields = (
        _real("com", 3, "m", "world", "CoM"),
        _real("com_velocity", 3, "m/s", "world", "CoM velocity"),
        _real("dcm", 2, "m", "world", "divergent component of motion"),
        _real("base_position", 3, "m", "world", "base"),
        _real("base_velocity", 6, "m/s, rad/s", "base", "linear, angular"),
        _real("external_force", 3, "N", "world", "lasting, horizontal"),
        _real("external_moment", 3, "N m", "world", "of it about the CoM"),
        _scalar("mass", "kg", "of the robot with all that it carries"),
    )
    return ChannelSpec("/estimate", "Estimate", fields, doc_of(estimate))


def estimation() -> ChannelSpec:
    """Estimate from the sensors, with its deviation and its error, every control tick.

    Errors are estimate minus truth, seen from the foot that carries more and turned to the true heading.
    """
    fields = (
        _real("base_pose", 7, "m, -", "world", "estimated pose of the base"),
        _real("left_sole", 7, "m, -", "world", "estimated pose of the sole centre"),
        _real("right_sole", 7, "m, -", "world", "estimated pose of the sole centre"),
        _real("wrench_left", 6, "N, N m", "left sole", "estimated contact wrench"),
        _real("wrench_right", 6, "N, N m", "right sole", "estimated contact wrench"),
        _int("contact", "1: the estimator says that the ground carries it: left, right", 2),
        _real("com_deviation", 3, "m", "world", "standard deviation of the CoM from the stance foot"),
        _real("com_velocity_deviation", 3, "m/s", "world", "standard deviation of its velocity"),
        _real("tilt_deviation", 2, "rad", "world", "standard deviation of the base's roll and pitch"),
        _real("sole_height_deviation", 2, "m", "world", "standard deviation of the soles' heights: left, right"),
        _scalar("force_deviation", "N", "standard deviation of an external force"),
        _scalar("moment_deviation", "N m", "standard deviation of its moment about the CoM"),
        _real("com_error", 3, "m", "world", "CoM from the stance foot"),
        _real("com_velocity_error", 3, "m/s", "world", "CoM velocity"),
        _real("tilt_error", 2, "rad", "world", "roll and pitch of the base"),
        _real("sole_height_error", 2, "m", "world", "heights of the soles: left, right"),
        _scalar("yaw_error", "rad", "heading of the base"),
        _real("place_error", 3, "m", "world", "stance foot in the world"),
    )
    return ChannelSpec("/estimation", "Estimation", fields, doc_of(estimation).split("\n")[0])


def planner_state(_: Sizes) -> ChannelSpec:
    """CoM that the planner measured, and that which it was given, every planner tick."""
    fields = (
        _real("measured_com", 3, "m", "world", "CoM with noise"),
        _real("measured_com_velocity", 3, "m/s", "world", "CoM velocity with noise"),
        _real("measured_zmp", 2, "m", "world", "ZMP with noise"),
        _real("com", 3, "m", "world", "CoM that the planner was given"),
        _real("com_velocity", 3, "m/s", "world", "CoM velocity that the planner was given"),
        _real("com_acceleration", 2, "m/s^2", "world", "CoM acceleration of the filter; NaN without one"),
        _real("innovation", 2, "-", "world", "normalised innovation squared of the filter; NaN without one"),
    )
    return ChannelSpec("/planner_state", "PlannerState", fields, doc_of(planner_state))


def contact(_: Sizes) -> ChannelSpec:
    """Contacts planned, used by the controller and felt, every control tick."""
    fields = (
        _real("zmp", 3, "m", "world", f"from contact forces, of a body {_STEP}; NaN in flight"),
        _real("normal_force", 2, "N", "", f"left, right; of a body {_STEP}"),
        _int("planned", "contact by the gait: left, right", 2),
        _int("active", "contact in the whole-body QP: left, right", 2),
        _int("felt", "contact by force: left, right", 2),
        _real("cop_left", 2, "m", "left sole", "centre of pressure; NaN when unloaded"),
        _real("cop_right", 2, "m", "right sole", "centre of pressure; NaN when unloaded"),
        _int(
            "edge",
            "edge on which the whole-body QP holds each foot: 1 toe, -1 heel, 0 none, the whole sole: left, right",
            2,
        ),
    )
    return ChannelSpec("/contact", "Contact", fields, doc_of(contact))


def felt_contact(_: Sizes) -> ChannelSpec:
    """Contacts felt, every control tick; of a run whose controller has no plan."""
    fields = (
        _real("zmp", 3, "m", "world", f"from contact forces {_STEP}; NaN in flight"),
        _real("normal_force", 2, "N", "", f"left, right {_STEP}"),
        _int("felt", "contact by force: left, right", 2),
        _real("cop_left", 2, "m", "left sole", "centre of pressure; NaN when unloaded"),
        _real("cop_right", 2, "m", "right sole", "centre of pressure; NaN when unloaded"),
    )
    return ChannelSpec("/contact", "FeltContact", fields, doc_of(felt_contact))


def gait(_: Sizes) -> ChannelSpec:
    """The gait as feet feel it, every control tick; of a run whose controller has no plan."""
    fields = (
        _int("phase", "0 standing, 1 double support, 2 single support, or flight where no foot is the stance foot"),
        _int("stance", "stance foot: 0 left, 1 right, -1 both or none"),
        _int("step", "footsteps begun"),
        _scalar("phase_time", "s", "since the phase began"),
    )
    return ChannelSpec("/gait", "Gait", fields, doc_of(gait))


def reference(_: Sizes) -> ChannelSpec:
    """The whole-body reference and the gait's clock, every control tick."""
    fields = (
        _real("com", 3, "m", "world", "CoM"),
        _real("com_velocity", 3, "m/s", "world", "CoM velocity"),
        _real("com_acceleration", 3, "m/s^2", "world", "CoM acceleration"),
        _real("zmp", 2, "m", "world", "planned ZMP"),
        _real("dcm", 2, "m", "world", "planned DCM"),
        _scalar("omega", "1/s", "natural frequency of the pendulum"),
        _real("zmp_reference", 2, "m", "world", "ZMP that the footsteps define"),
        _real("swing_position", 3, "m", "world", "sole centre of the swing foot, its roll in it"),
        _real("swing_velocity", 3, "m/s", "world", "sole centre of the swing foot, its roll in it"),
        _int("phase", "0 standing, 1 double support, 2 single support"),
        _int("stance", "stance foot: 0 left, 1 right, -1 both"),
        _int("step", "footsteps completed"),
        _scalar("phase_time", "s", "since the phase began"),
        _scalar("phase_duration", "s", "of the phase"),
        _real("support", (SUPPORT_VERTICES, 2), "m", "world", "planned support polygon; the last vertex pads"),
        _int("support_count", "vertices of the polygon"),
        _real(
            "roll",
            2,
            "rad",
            "",
            "planned pitch, heel up about the toe edge, toes up negative about the heel edge: left, right",
        ),
    )
    return ChannelSpec("/reference", "Reference", fields, doc_of(reference))


def plan(n: Sizes) -> ChannelSpec:
    """The plan with its horizon, every planner tick; sample 0 is the message's time."""
    states, moves = n.horizon + 1, n.horizon
    fields = (
        _real("com", (states, 3), "m", "world", "CoM"),
        _real("com_velocity", (states, 3), "m/s", "world", "CoM velocity"),
        _real("zmp", (states, 2), "m", "world", "ZMP"),
        _real("zmp_reference", (states, 2), "m", "world", "ZMP that the footsteps define"),
        _real("jerk", (moves, 2), "m/s^3", "world", "CoM jerk"),
        _real("omega", states, "1/s", "", "natural frequency of the pendulum"),
        _int("status", "solver status, 0 solved"),
        _real("slack", 2, "m", "", "of the ZMP bounds and of the terminal bound"),
        _int("held", "1: no new plan, the last one is held"),
        _int("infeasible", "1: the profile's hard constraints had no solution and were softened by the slack"),
        _real("capture_margin", 2, "m", "", "of the DCM inside what is captured: steps as planned, steps moved"),
        _real("step_shift", 2, "m", "world", "by how much the next landing is moved from where it nominally is"),
        _scalar("step_delay", "s", "how much later than nominally the next landing is made to come"),
        _int("falling", "1: no step will save the body any more"),
    )
    return ChannelSpec("/plan", "Plan", fields, doc_of(plan))


def footsteps(_: Sizes) -> ChannelSpec:
    """Feet and the next three footsteps as planned, every planner tick."""
    fields = (
        _real("current_left", 4, "m, rad", "world", "x y z yaw"),
        _real("current_right", 4, "m, rad", "world", "x y z yaw"),
        _real("next", (3, 4), "m, rad", "world", "x y z yaw; NaN: none"),
        _int("next_foot", "0 left, 1 right, -1 none", 3),
        _real("touchdown_time", 3, "s", "", "planned; NaN: none"),
    )
    return ChannelSpec("/footsteps", "Footsteps", fields, doc_of(footsteps))


def footstep(_: Sizes) -> ChannelSpec:
    """A footstep taken, when its swing is over and its foot has touched down; none of a foot that never does."""
    fields = (
        _int("index", "1 is the first"),
        _int("foot", "0 left, 1 right"),
        _real("planned", 4, "m, rad", "world", "x y z yaw as last planned before it touched down"),
        _real("actual", 4, "m, rad", "world", "x y z yaw in the state that the planner was given"),
    )
    return ChannelSpec("/footstep", "Footstep", fields, doc_of(footstep))


def wbc(n: Sizes) -> ChannelSpec:
    """The whole-body QP's solution, every control tick."""
    rows, tasks = sum(size for _, size in n.tasks), ", ".join(f"{name} {size}" for name, size in n.tasks)
    fields = (
        _int("status", "0 solved"),
        _int("solver", "0 default, 1 second solver"),
        _int("iterations", "of the solver"),
        _int("fallback", "1: nothing holds all limits, the fallback torque is used"),
        _scalar("primal_residual", "-", "of the constraints"),
        _scalar("dual_residual", "-", "of stationarity"),
        _real("acceleration", n.nv, "m/s^2, rad/s^2", "base", "planned"),
        _real("wrench_left", 6, "N, N m", "left sole", "planned"),
        _real("wrench_right", 6, "N, N m", "right sole", "planned"),
        _real("task_error", rows, "mixed", "", tasks),
    )
    return ChannelSpec("/wbc", "WholeBodyControl", fields, doc_of(wbc))


def torque(n: Sizes) -> ChannelSpec:
    """The joint torques commanded, every control tick."""
    fields = (
        _real("command", n.nj, "N m", "", "commanded"),
        _scalar("limit_ratio_max", "-", "largest torque over its limit"),
    )
    return ChannelSpec("/torque", "JointTorque", fields, doc_of(torque))


def coupling(n: Sizes) -> ChannelSpec:
    """Errors of the simulator in joints that follow others, every control tick; only of a robot that has such."""
    fields = (_real("apart", n.nf, "rad", "", "of each from where the joint that it follows would have it"),)
    return ChannelSpec("/coupling", "Coupling", fields, doc_of(coupling))


def link(_: Sizes | None = None) -> ChannelSpec:
    """Fate of the messages between plant and controller in two processes, with each state that came."""
    fields = (
        _scalar("command_age", "s", "of the state that the command in force answers, when this one was measured"),
        _int("states_missed", "control ticks since the state before whose states did not come"),
        _int("commands_missed", "control ticks so far at which no new command was there"),
        _int("commands_limited", "control ticks so far at which the plant did less than it was commanded"),
        _int("damped", "1: the plant has damped its joints"),
    )
    return ChannelSpec("/link", "Link", fields, doc_of(link))


def shadow(n: Sizes) -> ChannelSpec:
    """The torques of the log in whose shadow a controller walked, every control tick."""
    fields = (_real("command", n.nj, "N m", "", "commanded then"),)
    return ChannelSpec("/shadow", "Shadow", fields, doc_of(shadow))


def timing(_: Sizes) -> ChannelSpec:
    """Time spent in each part of a control tick; excluded from reproducibility."""
    parts = ("state", "wbc_build", "wbc_solve", "planner", "physics", "log", "tick")
    wall = tuple(_scalar(part, "us", "wall-clock time") for part in parts)
    fields = (*wall, _scalar("controller", "us", "processor time of the tick without its log and physics"))
    return ChannelSpec("/timing", "Timing", fields, doc_of(timing))


def command(_: Sizes) -> ChannelSpec:
    """Commands to the walk while it went on, in the plan from which on each holds; NaN for what was not commanded."""
    fields = (
        _real("velocity", 2, "m/s", "path", "asked for, forward and to the left"),
        _scalar("yaw_rate", "rad/s", "of the heading, asked for"),
        _real("followed_velocity", 2, "m/s", "path", "followed in its place, whose steps are in reach"),
        _scalar("followed_yaw_rate", "rad/s", "of the heading, followed in its place"),
        _real("place", 2, "m", "world", "where to go last"),
        _scalar("heading", "rad", "there"),
        _scalar("single_support", "s", "duration from now on"),
        _scalar("double_support", "s", "duration from now on"),
        _scalar("swing_height", "m", "clearance of the steps to come"),
    )
    return ChannelSpec("/command", "Command", fields, doc_of(command))


def process(_: Sizes) -> ChannelSpec:
    """The process that makes the run, every simulated second; excluded from reproducibility."""
    fields = (_scalar("memory", "B", "resident memory"),)
    return ChannelSpec("/process", "Process", fields, doc_of(process))
