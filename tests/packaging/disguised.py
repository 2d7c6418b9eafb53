"""A robot of another package, in one file: humanoid100 under names that tell nothing."""

import re
from collections.abc import Iterable
from dataclasses import replace

from surefoot.models import JointRoles, Robot, RobotDescription, RobotOptions, describe


def build(options: RobotOptions) -> RobotDescription:
    """The robot with the chosen options, bodies among them under their new names."""
    known = describe("humanoid100", options)
    sites = (*known.sole_sites, known.imu_site)
    shapes = sorted({shape for pair in known.kept_apart for shape in pair})
    kinds = {"j": known.joint_names, "b": known.bodies, "s": sites, "g": shapes}
    new = {name: f"{kind}{index}" for kind, names in kinds.items() for index, name in enumerate(names)}

    def called(names: Iterable[str]) -> tuple[str, ...]:
        return tuple(new[name] for name in names)

    roles = (known.roles.left_leg, known.roles.right_leg, known.roles.knees, known.roles.waist, known.roles.arm_swing)
    return replace(
        known,
        name="disguised",
        mjcf=re.sub('"([^"]*)"', lambda found: f'"{new.get(found[1], found[1])}"', known.mjcf),
        joint_names=called(known.joint_names),
        bodies=called(known.bodies),
        roles=JointRoles(*map(called, roles)),
        sole_sites=called(known.sole_sites),
        imu_site=new[known.imu_site],
        pelvis_body=new[known.pelvis_body],
        torso_body=new[known.torso_body],
        kept_apart=tuple(map(called, known.kept_apart)),
    )


DISGUISED = Robot("disguised", build)
