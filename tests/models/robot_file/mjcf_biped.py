"""A biped as MuJoCo compiles it: defaults, welded bodies, joints beside origins, motors of all kinds."""

from pathlib import Path

import biped
from test_meshes import ball

from surefoot.models import RobotOptions, describe
from surefoot.models.robot_file.mesh_file import binary_stl

LIMITS = "torque_limit: {'*_ankle_roll': 40}\nvelocity_limit: {'*': 12}\n"


def leg(side: str, sign: int) -> str:
    return f"""
      <body name="{side}_yaw_link" pos="0 {0.08 * sign} 0"><joint name="{side}_yaw" axis="0 0 1"/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_roll_link"><joint name="{side}_roll" axis="1 0 0"/>
      <inertial pos="0 0 0" mass="0.5" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_thigh"><joint name="{side}_pitch" axis="0 1 0" armature="0.02"/>
      <geom type="capsule" fromto="0 0 -0.05 0 0 -0.25" size="0.04" density="900"/>
      <body name="{side}_shank" pos="0 0 -0.25" quat="0.8 0 0.6 0">
      <joint name="{side}_knee" axis="0 1 0" pos="0.048 0 -0.014" range="0.2 2"/>
      <body name="{side}_pad" quat="0.8 0 -0.6 0"><geom type="box" pos="0 0 -0.17" size="0.03 0.03 0.1"/>
      <body name="{side}_ankle" pos="0 0 -0.33"><joint name="{side}_ankle_pitch" axis="0 1 0"/>
      <inertial pos="0 0 0" mass="0.3" diaginertia="1e-3 1e-3 1e-3"/>
      <body name="{side}_foot"><joint name="{side}_ankle_roll" axis="1 0 0"/>
      <geom type="box" pos="0.03 0 -0.05" size="0.09 0.04 0.01"/></body></body></body></body></body></body></body>"""


MOTORS = "".join(
    f"""<motor joint="{side}_yaw" gear="50" ctrlrange="-1 1"/><motor joint="{side}_roll" forcerange="-60 60"/>
    <position joint="{side}_pitch" forcerange="-90 90" kp="100"/>
    <general joint="{side}_knee" forcerange="-80 80" gear="2"/>
    <motor joint="{side}_ankle_pitch" ctrlrange="-30 30"/>"""
    for side in ("left", "right")
)
TEXT = f"""<mujoco model="biped"><compiler angle="radian"/>
  <default><geom density="500"/><joint range="-1 1" limited="true"/></default>
  <worldbody><geom type="plane" size="1 1 1"/>
    <body name="base" pos="0 0 0.7"><freejoint/><geom type="box" size="0.08 0.1 0.08"/>
    {leg("left", 1)}{leg("right", -1)}</body></worldbody><actuator>{MOTORS}</actuator></mujoco>"""


def described(folder: Path, text: str = TEXT, limits: str = LIMITS):
    file = biped.FILE.replace("biped.urdf", "biped.xml") + limits
    return describe(str(biped.write(folder, text, file, "biped.xml")), RobotOptions())


TYPE = ' type="mesh"'
DRAWN = 'mass="0" contype="0" conaffinity="0"'


def meshed(folder, rings, *geoms, weighs=(), compiler="", kind="stl"):
    """A robot with dense ellipsoids on its base: geoms, and others that weigh."""
    vertices, faces = ball(0.09, rings)
    vertices = vertices * [1.0, 0.7, 0.5]
    if kind == "obj":
        lines = ["v {:.6f} {:.6f} {:.6f}".format(*row) for row in vertices] + [
            "f {} {} {}".format(*row) for row in faces + 1
        ]
        (folder / "m.obj").write_text("\n".join(lines))
    (folder / "m.stl").write_bytes(binary_stl((vertices, faces)))
    names = [f"m{at}" for at in range(len(geoms) + len(weighs))]
    assets = "".join(f'<mesh name="{name}" file="m.{kind}"/>' for name in names)
    told = [geom if " type=" in geom else geom + TYPE for geom in (*geoms, *weighs)]
    shapes = "".join(f'<geom mesh="{name}" {geom}/>' for name, geom in zip(names, told, strict=True))
    text = TEXT.replace("<worldbody>", f"{compiler}<asset>{assets}</asset><worldbody>")
    (folder / "biped.xml").write_text(text.replace("<freejoint/>", f"<freejoint/>{shapes}"))
    file = folder / "biped.yaml"
    file.write_text(biped.FILE.replace("biped.urdf", "biped.xml") + LIMITS)
    return str(file)
