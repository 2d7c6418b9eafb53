"""A policy on a plant in another process: the same to the bit as in one."""

import policies
import pytest
import yaml
from needs import POLICY

import surefoot

pytestmark = [pytest.mark.physics, POLICY.mark]


@pytest.mark.parametrize(("robot", "height"), [("g1", 0.67), ("humanoid100", 0.95)])
def test_it_walks_on_a_plant_in_another_process(bridge, same_content, tmp_path, robot, height):
    stander = policies.stander(tmp_path / "stander", robot)
    gait = {"steps": 0, "com_height": height, "initial_stand": 0.2}
    values = {
        "robot": robot,
        "duration": 1.0,
        "gait": gait,
        "criteria": {"fell": False},
        "controller": {"policy": str(stander)},
    }
    walk = tmp_path / "held.yaml"
    walk.write_text(yaml.safe_dump(values))
    plant = bridge.serve(str(walk))
    _, verdict, said = bridge.result(bridge.walk())
    assert verdict.get("verdict") == "pass", (said, verdict)
    bridge.end(plant)
    alone = surefoot.run(walk, out=tmp_path / "alone")
    assert same_content(tmp_path / verdict["log"], alone.log) == []
