"""The motor classes of the robot and the gears of its joints.

Motors are sized like frameless torque motors of about 115, 95, 70 and 40 mm outer diameter; gears are those of
low-ratio planetary drives, so that the reflected rotor inertia stays of the order of the links' own.
"""

from surefoot.models.actuator import Actuator, Motor

MOTOR_115 = Motor(rotor_inertia=2.5e-4, peak_torque=15.0, no_load_speed=320.0)
MOTOR_95 = Motor(rotor_inertia=1.5e-4, peak_torque=10.0, no_load_speed=320.0)
MOTOR_70 = Motor(rotor_inertia=5.0e-5, peak_torque=5.0, no_load_speed=400.0)
MOTOR_40 = Motor(rotor_inertia=1.0e-5, peak_torque=1.4, no_load_speed=500.0)

HIP_YAW = Actuator(MOTOR_70, gear_ratio=28.0)  # 140 N m
HIP_ROLL = Actuator(MOTOR_95, gear_ratio=28.0)  # 280 N m
HIP_PITCH = Actuator(MOTOR_115, gear_ratio=25.0)  # 375 N m
KNEE = Actuator(MOTOR_115, gear_ratio=25.0)  # 375 N m
ANKLE_PITCH = Actuator(MOTOR_95, gear_ratio=22.0)  # 220 N m
ANKLE_ROLL = Actuator(MOTOR_70, gear_ratio=28.0)  # 140 N m
WAIST = Actuator(MOTOR_95, gear_ratio=25.0)  # 250 N m
SHOULDER = Actuator(MOTOR_70, gear_ratio=20.0)  # 100 N m
ELBOW = Actuator(MOTOR_70, gear_ratio=14.0)  # 70 N m
NECK = Actuator(MOTOR_40, gear_ratio=20.0)  # 28 N m
