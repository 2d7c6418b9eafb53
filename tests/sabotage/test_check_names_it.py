"""`surefoot check` fails for each controller that was made worse, and its first sentence names what is worse."""

import re

import pytest
from controllers import SABOTAGES

import surefoot
from surefoot.scenarios.check.check import cases, run_case, updated
from surefoot.scenarios.check.report import lines_of

pytestmark = pytest.mark.physics

SHORT = """
name: short
duration: 3.3
robot_options: {foot_length: 0.22, foot_width: 0.11}
gait: {steps: 4, step_length: 0.3, single_support: 0.5, double_support: 0.16, com_height: 0.99}
criteria: {fell: false}
"""

NAMES = {
    "task gain quartered": ("swing task: largest distance of the left sole from its reference in step 1: ", "feet"),
    "gravity compensation of a leg dropped": ("torque of the left leg \\(RMS\\) at the first tick: ", "torques"),
    "foot target off by 1 cm": ("left sole at touchdown of step 1: (9|10)\\.\\d mm ahead of the baseline", "soles"),
    "torque 4 ms late": (
        "lag of the measured ground forces behind those that the controller plans before the first step: 6 ms, 2 ms",
        "feet",
    ),
    "friction cone too wide": (
        "largest force along the ground over normal force that the controller plans for the left foot in step 1: 1.",
        "grip",
    ),
}


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """A short walk with its baseline."""
    folder = tmp_path_factory.mktemp("sound")
    (folder / "short.yaml").write_text(SHORT)
    (found,) = cases([str(folder / "short.yaml")])
    updated(run_case(found, folder / "runs"))
    return found


def test_the_unbroken_controller_is_the_same(case, tmp_path):
    found = run_case(case, tmp_path)
    assert (found.status, found.moves, found.partings) == ("same", (), ())


@pytest.mark.parametrize("sabotage", SABOTAGES)
def test_a_worse_controller_is_named(sabotage, case, tmp_path):
    parts = surefoot.Parts(controller=SABOTAGES[sabotage])
    found = run_case(case, tmp_path, lambda scenario, out: surefoot.run(scenario, out=out, parts=parts))
    text, figure = NAMES[sabotage]
    assert found.status == "moved"
    assert re.match(text, found.partings[0].text)
    assert f"surefoot plot {found.log} --what {figure} --from " in "\n".join(lines_of(found))
