"""Commands and waypoints in a scenario file: what says nothing, two things, or what cannot be done is refused."""

import pytest

from surefoot.planner.types import Twist
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.setup.groups.gait import command_of
from surefoot.scenarios.setup.load import read_scenario
from surefoot.scenarios.setup.walk import Walk

pytestmark = pytest.mark.unit

END = "duration: 9\n"
REFUSED = {
    END + "commands: [{time: 1}]": "commands.0 says nothing",
    END + "commands: [{time: 1, v_x: 0.1, place: {x: 1, y: 0}}]": "commands.0 has both a place and a velocity",
    END + "commands: [{time: 9.5, v_x: 0.1}]": "commands.0 comes at 9.5 s and never acts",
    END + "commands: [{time: 1, single_support: 0.1}]": "commands.0.single_support 0.1 s is too short",
    "commands: [{time: 1, v_x: 0.1}]": "commands that do not end with a stop",
    END + "commands: [{time: 1, v_x: 0.1}]\nterrain: {kind: stairs}": "on terrain.kind stairs",
    "gait: {waypoints: [{x: 1, y: 0}]}\nterrain: {kind: slope, angle: 0.05}": "gait.waypoints on terrain.kind slope",
    "gait: {waypoints: [{x: 1, y: 0}], velocity: [{time: 0}]}": "waypoints beside gait.velocity",
    "gait: {waypoints: [{x: 1}]}": "gait.waypoints.0 lacks element y",
    END + "commands: [{time: 1, v_z: 0.1}]": "unknown key 'v_z'",
    "gait: {waypoints: [{x: 1, y: 0}], step_length: 0}": "gait.waypoints with steps of no length",
    END + "commands: [{time: 1, place: {x: 1, y: 0}}]\ngait: {steps: 0, step_length: 0}": "a place to go to with",
}


@pytest.mark.parametrize("text", REFUSED, ids=range(len(REFUSED)))
def test_it_is_refused_with_its_place(robots, text):
    with pytest.raises(ScenarioError) as caught:
        read_scenario(text, "f.yaml", "f", (), robots)
    assert REFUSED[text] in "\n".join(caught.value.problems)
    assert caught.value.problems[0].startswith("f.yaml:")


def test_a_run_lasts_until_the_robot_stands(robots):
    def duration(text):
        return Walk(read_scenario(text, "f.yaml", "f", (), robots)).duration

    near, far = (duration(f"gait: {{waypoints: [{{x: {x}, y: 0}}]}}") for x in (0.5, 3.0))
    assert far > near + 10.0
    assert duration("gait: {steps: 0}\ncommands: [{time: 3, v_x: 0.1}, {time: 20, v_x: 0}]") > 22.0
    assert duration("duration: 4\ncommands: [{time: 3, v_x: 0.1}]") == 4.0


def test_velocities_are_told_from_their_time_on_and_the_rest_is_zero(robots):
    commands = "commands: [{time: 1, v_y: 0.1}, {time: 2, swing_height: 0.06}]"
    text = f"duration: 9\n{commands}\nstart: {{x: 1, yaw: 1.5707963267948966}}"
    scenario = read_scenario(text, "f.yaml", "f", (), robots)
    first, second = (command_of(settings) for settings in scenario.commands)
    assert (first.time, first.twist) == (1.0, Twist(0.0, 0.1, 0.0))
    assert (second.twist, second.swing_height) == (None, 0.06)
    placed = Walk(read_scenario(text + "\ngait: {waypoints: [{x: 1, y: 2, yaw: 0.5}]}", "f.yaml", "f", (), robots))
    assert placed.waypoints == (pytest.approx(Twist(-1.0, 1.0, 2.0707963)),)
