"""The log of a robot with meshes: complete by itself, and hardly larger."""

import re

import pytest

import surefoot
from surefoot.models import RobotOptions, describe
from surefoot.scenarios.log import read
from surefoot.scenarios.record.foxglove.views import SCENE_PERIOD, SCENE_RATE
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.show.replay.extract import extract

unit = pytest.mark.unit

MESH = re.compile(r'<mesh [^>]*name="([^"]+)"')
FILES = re.compile(r"\b(file|meshdir|assetdir)=")


@pytest.fixture(scope="module")
def log(meshed, tmp_path_factory):
    path = tmp_path_factory.mktemp("meshed") / "log.mcap"
    scenario = surefoot.load("stand", {"duration": 0.02})
    with surefoot.Simulation(scenario, log=path, robot=meshed.robot) as simulation:
        while not simulation.done:
            simulation.step()
    return read(path)


@unit
def test_the_world_has_the_meshes_and_names_no_file(log, meshed):
    world, robot = (log.attachments[name].decode() for name in (WORLD_FILE, "robot.xml"))
    assert len(MESH.findall(world)) == len(meshed.hulls) + sum(map(len, meshed.looks.values()))
    assert set(MESH.findall(robot)) == set(meshed.hulls)
    assert not FILES.search(world + robot)


@unit
def test_a_replay_has_them_from_the_log_alone(log, meshed):
    replay = extract(log)
    bodies = {replay.body_names[surface.body] for surface in replay.surfaces}
    assert set(meshed.looks) <= bodies
    assert replay.surfaces[0].vertices.size


@pytest.mark.physics
def test_the_meshes_of_a_shipped_robot_are_a_megabyte_of_a_log():
    from surefoot.planner.ground.terrain import flat
    from surefoot.scenarios.record.foxglove.drawing import world_scene
    from surefoot.sim.world import World

    robot = describe("alexander", RobotOptions())
    world = World(robot, flat(), 1000).mjcf()
    scene = world_scene(world).SerializeToString()
    assert len(scene) > 50_000
    assert len(robot.mjcf) + len(world) + len(scene) < 1_500_000
    assert len(scene) / SCENE_RATE < 4 * SCENE_PERIOD
    assert MESH.search(world)
    assert not FILES.search(world)
