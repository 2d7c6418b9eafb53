"""Contact forces of a message are those of the physics step that ended at its time, which began in another state."""

import re
from pathlib import Path

import mujoco
import numpy as np
import pytest

from surefoot.models.convert import pinocchio_to_mujoco
from surefoot.scenarios.log import read
from surefoot.scenarios.record.provenance import WORLD_FILE
from surefoot.scenarios.run.run import run_scenario
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.physics

PAGE = Path(__file__).parents[3] / "docs" / "log.md"
LOADED = 20.0
"""Normal force below which there is no ZMP [N]."""


class Bare:
    """The world of a log in bare MuJoCo."""

    def __init__(self, log):
        self.model = mujoco.MjModel.from_xml_string(log.attachments[WORLD_FILE].decode())
        self.data = mujoco.MjData(self.model)
        self.q, self.v = log["/truth"].field("q"), log["/truth"].field("v")
        self.torque = log["/torque"].field("command")

    def zmp_after(self, tick, steps):
        """ZMP [m] of the state at a tick and of so many physics steps later, under the torque of the tick before."""
        data, force, moment, felt = self.data, np.zeros(3), np.zeros(3), np.zeros(6)
        before = tick if steps == 0 else tick - 1
        pinocchio_to_mujoco(self.q[before], self.v[before], data.qpos, data.qvel)
        data.ctrl[:], data.qacc_warmstart[:] = self.torque[tick - 1], 0.0
        for _ in range(steps):
            mujoco.mj_step(self.model, data)
        mujoco.mj_forward(self.model, data)
        for index, contact in enumerate(data.contact[: data.ncon]):
            ground = self.model.geom_bodyid[[contact.geom1, contact.geom2]] == 0
            if ground.all() or not ground.any():
                continue
            mujoco.mj_contactForce(self.model, data, index, felt)
            sign = 1.0 if ground[0] else -1.0
            turned = sign * felt.reshape(2, 3) @ contact.frame.reshape(3, 3)
            force += turned[0]
            moment += np.cross(contact.pos, turned[0]) + turned[1]
        return np.array([-moment[1], moment[0]]) / force[2] if force[2] > LOADED else np.full(2, np.nan)


def test_it_is_one_physics_step_before_the_message(tmp_path):
    """Physics at 1000 Hz, control at 500 Hz; by how much the message's own state would be off the page says."""
    result = run_scenario(load("walk-brisk"), tmp_path)
    assert result.verdict.reasons == ()
    log = read(result.log)
    bare, zmp = Bare(log), log["/contact"].field("zmp")[:, :2]
    off = {
        steps: np.array([bare.zmp_after(tick, steps) - zmp[tick] for tick in range(1, len(zmp))]) for steps in (1, 0)
    }
    before, at = (1e3 * float(np.nanmax(np.abs(off[steps]))) for steps in (1, 0))
    assert before < 1.0
    (said,) = re.findall(r"up to (\d+) mm at touchdowns of\s`walk-brisk`", PAGE.read_text(encoding="utf-8"))
    assert round(at) == int(said)
