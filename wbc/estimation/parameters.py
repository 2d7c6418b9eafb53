"""Numbers that the estimator of the state counts on, each a standard deviation unless it says otherwise.

What sensors add comes from their data sheets, or from the scenario for simulated ones. What feet and ground add no data
sheet says: those numbers were measured in simulated walks. Forces and moments are those of the reference robot (see
`surefoot.similarity`); an IMU is one of any size.
"""

from dataclasses import dataclass

from surefoot.tunable import check, number, positive


@dataclass(frozen=True, slots=True)
class SensorNoise:
    """The errors of the sensors; the defaults are those of the preset `good` (docs/sensors.md).

    Raises:
        ParameterError: one is negative or not finite.
    """

    gyro_density: float = number(1.7e-4, "rad/s/√Hz", "of the angular velocity")
    gyro_bias: float = number(1e-3, "rad/s", "of the gyroscope's bias at the start")
    gyro_walk: float = number(1e-5, "rad/s/√s", "of what that bias gains")
    accelerometer_density: float = number(1.4e-3, "m/s^2/√Hz", "of the specific force")
    accelerometer_bias: float = number(0.02, "m/s^2", "of the accelerometer's bias at the start")
    accelerometer_walk: float = number(1e-4, "m/s^2/√s", "of what that bias gains")
    mounting: float = number(1e-3, "rad", "of how the IMU is turned about each of its axes from where it should be")
    encoder: float = number(1.1e-5, "rad", "of an encoder's reading, rounding included")
    encoder_offset: float = number(5e-4, "rad", "of an encoder's zero, constant in a run")
    joint_torque: float = number(0.5, "N·m", "of a motor's measured torque")
    wrench_force: float = number(5.0, "N", "of a foot sensor's force")
    wrench_moment: float = number(0.2, "N·m", "of a foot sensor's moment")
    wrench_bias: float = number(5.0, "N", "of a force's bias before it was tared")

    def __post_init__(self) -> None:
        check(self, "estimator", "sensors")


@dataclass(frozen=True, slots=True)
class GroundNoise:
    """The motion of feet and ground that no sensor measures.

    How loaded soles move was measured in walks with large and small feet, on stairs, a slope and blocks. Under the
    weight they sink by 0.24 to 0.26 mm. In 50 ms they creep by at most 0.06 mm, RMS over the walk. Beside what springs
    give, they sink by 0.05 mm and rock by 0.14 to 0.6 mrad.

    Raises:
        ParameterError: one is negative or not finite.
    """

    kinematics: float = number(1e-5, "m", "of a sole's position in a rigid robot's kinematics")
    turning: float = number(1e-5, "rad", "of a sole's orientation in a rigid robot's kinematics")
    creep: float = number(1e-4, "m", "of a second's way of a loaded sole along the ground, with the root of the time")
    sinking: float = number(1e-4, "m", "of a loaded sole's way into the ground and out of it, as a spring has it")
    rocking: float = number(5e-4, "rad", "of a second's turn of a loaded sole, as on springs")
    depth: float = number(2.5e-4, "m", "by which a sole sinks under the weight as on springs; its deviation is half")
    landing: float = number(7e-4, "m", "of where a sole comes to rest after it is felt")
    landing_turn: float = number(2e-3, "rad", "of how it does so")
    light: float = number(10.0, "-", "creep and rocking of an unloaded sole over those of a loaded one")
    height: float = number(1.5e-3, "m", "of the ground's height where a foot lands")
    level: float = number(2e-4, "rad", "of the soles' tilt to the ground at the start")
    model: float = number(1.5e-3, "m/s", "of a second's change of velocity, by links that bend and by sampling")
    turning_plan: float = number(0.02, "rad/s", "of a second's change of angular velocity, against what is planned")

    def __post_init__(self) -> None:
        check(self, "estimator", "ground")


@dataclass(frozen=True, slots=True)
class ContactDetection:
    """The bounds at which the ground carries a sole.

    Raises:
        ParameterError: one is negative or not finite.
    """

    force: float = number(8.0, "N", "normal force that is felt by a sensor without noise")
    certain: float = number(4.0, "-", "deviations of the filtered force that are felt at least")
    released: float = number(0.5, "-", "share of that force below which a contact ends")
    ticks: int = positive(2, "-", "consecutive ticks after which a contact begins or ends")
    anchor: float = number(0.08, "-", "share of the weight from which a sole that lands stands still")
    edge: float = number(0.9, "-", "share of the half sole within which its CoP is where it stands still")
    tare_time: float = positive(0.1, "s", "time constant of the tare of a swinging foot's sensor")
    tare_height: float = number(0.008, "m", "height of a sole over the ground above which its sensor is tared")
    tared_after: float = number(0.15, "s", "swing after which a sensor counts as tared")

    def __post_init__(self) -> None:
        check(self, "estimator", "contact")


@dataclass(frozen=True, slots=True)
class EstimatorParameters:
    """All numbers of `surefoot.wbc.estimation.estimator.SensedState`.

    Attributes:
        sensors: what they add.
        ground: what feet and ground add.
        contact: when the ground carries a sole.
    """

    sensors: SensorNoise = SensorNoise()
    ground: GroundNoise = GroundNoise()
    contact: ContactDetection = ContactDetection()
    covariance_rate: float = positive(100.0, "Hz", "at which covariance and gain are computed")
    joint_bandwidth: float = positive(80.0, "Hz", "of the joint observer for encoders of 1e-5 rad")

    def __post_init__(self) -> None:
        check(self, "estimator")
