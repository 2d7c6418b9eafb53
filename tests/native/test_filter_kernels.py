"""The compiled ticks of the invariant filter against the plain ones, on the readings of real walks."""

import numpy as np
import pytest
from needs import KERNELS

import surefoot
from surefoot.native.library import VARIABLE
from surefoot.scenarios.run.sensed import sensed_state

pytestmark = pytest.mark.unit

NEAR, BY_TORQUES = 1e-11, 1e-10
"""Largest difference of what both estimate, of numbers above 1 as a share, and where wrenches follow from torques.

Those move the soles, and what they follow from is known to fewer digits.
"""


def numbers(estimate):
    sure = estimate.deviation
    told = (sure.com, sure.com_velocity, sure.tilt, sure.sole_height)
    state = (estimate.state.q, estimate.state.v, estimate.wrench.ravel())
    return np.concatenate((*state, *told, *estimate.channels.values(), np.array(estimate.contact, dtype=float)))


@pytest.mark.parametrize(
    ("changes", "near"),
    [
        ({}, NEAR),
        ({"sensing.wrench": "none"}, BY_TORQUES),
        ({"sensing.preset": "cheap"}, NEAR),
        ({"sensing.preset": "cheap", "sensing.jitter": 0.006, "sensing.dropout": 0.2}, NEAR),
        ({"sensing.preset": "perfect"}, NEAR),
    ],
)
def test_kernels_estimate_what_plain_python_does(monkeypatch, changes, near):
    KERNELS.or_skip()
    pairs = []

    class Pair:
        """A compiled estimator that is listened to, and a plain one beside it."""

        def __init__(self, walk, **options):
            self.both = []
            for variable in ("", "0"):
                monkeypatch.setenv(VARIABLE, variable)
                self.both.append(sensed_state(walk, **options))
            self.worst = 0.0
            pairs.append(self)

        def sense(self, readings):
            estimates = []
            for variable, one in zip(("", "0"), self.both, strict=True):
                # A filter asks for kernels when it is made, at the first readings.
                monkeypatch.setenv(VARIABLE, variable)
                estimates.append(one.sense(readings))
            monkeypatch.setenv(VARIABLE, "")
            compiled, plain = map(numbers, estimates)
            self.worst = max(self.worst, float((np.abs(compiled - plain) / np.maximum(1.0, np.abs(plain))).max()))
            return estimates[0]

        def told(self, planned):
            for one in self.both:
                one.told(planned)

    sets = {"sensing.source": "ekf", "sensing.preset": "good", "gait.initial_stand": 0.2, **changes}
    sim = surefoot.Simulation(surefoot.load("walk", sets), estimator=Pair)
    for _ in range(600):
        sim.step()
    compiled, plain = pairs[0].both
    assert compiled._body.compiled is not None and plain._body.compiled is None
    assert 0.0 < pairs[0].worst < near
