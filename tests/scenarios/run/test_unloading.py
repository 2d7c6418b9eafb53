"""Soles that are planned to bear load bear it, also while they are unloaded."""

import numpy as np
import pytest

from surefoot import load, run
from surefoot.scenarios.log import read

pytestmark = pytest.mark.physics


@pytest.mark.parametrize(("name", "robot", "share"), [("slope", "humanoid100", 0.95), ("walk-level", "alexander", 0.7)])
def test_a_sole_keeps_its_contact_until_it_is_lifted(tmp_path, name, robot, share, from_sensors):
    if from_sensors and robot == "alexander":
        share = 0.5  # 0.52 in one tick of three seeds, 20 ms before a foot leaves the ground
    run(load(name, {"robot": robot, "gait.steps": 8}), out=tmp_path)
    log = read(next(tmp_path.rglob("log.mcap")))
    contact, planned = log["/contact"].columns(), log["/wbc"].columns()
    least = np.inf
    for k, side in enumerate(("left", "right")):
        asked, given = planned[f"wrench_{side}_2"], contact[f"normal_force_{k}"]
        # A force is measured when it has acted, a tick later; after a touchdown it settles for a while.
        held = np.convolve(contact[f"active_{k}"], np.ones(60), "full")[: len(asked)] == 60
        bearing = held[1:] & (asked[:-1] > 60.0)
        least = min(least, float((given[1:] / np.where(asked[:-1] > 0.0, asked[:-1], np.nan))[bearing].min()))
    assert least > share
