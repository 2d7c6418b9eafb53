"""The gain of a small robot by its motors' rotors, as it is pushed while marching, from good sensors at 250 Hz."""

from pathlib import Path

import pytest
from enough import at_least

import surefoot
from surefoot.models import registry
from surefoot.scenarios.run.planning import RunFault
from surefoot.studies.campaigns.campaign import read_campaign

pytestmark = pytest.mark.physics

SEEDS = range(8)


def falls(robot):
    """Tell whether marches with a push forward in mid-swing fall or blow up, of eight seeds of the sensors."""
    march = read_campaign("march-ladder").spec.set
    push = {**march["pushes"][0], "impulse": 0.9}
    keys = {**march, "robot": robot, "sensing.source": "ekf", "sensing.preset": "good", "pushes": [push]}
    for seed in SEEDS:
        with surefoot.Simulation(surefoot.load("walk-level", {**keys, "seed": seed})) as simulation:
            try:
                while not (simulation.done or simulation.fell):
                    simulation.advance()
            except RunFault:
                yield True
            else:
                yield simulation.fell


def test_feet_that_touch_with_an_edge_do_not_flip_over():
    assert not any(falls("g1"))


def test_without_rotors_they_do(tmp_path):
    """Negative control: the ankle then turns the foot about its length with 0.0003 kg·m²."""
    text = (Path(registry.__file__).parent / "robots" / "g1.yaml").read_text(encoding="utf-8")
    bare = tmp_path / "bare.yaml"
    bare.write_text(text.split("# Rotors")[0].replace("name: g1", "name: bare"), encoding="utf-8")
    assert at_least(2, falls(str(bare)))
