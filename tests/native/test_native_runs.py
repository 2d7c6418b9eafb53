"""Whole runs: compiled kernels and plain Python walk the same way, and a log says which of them made it."""

import numpy as np
import pytest

import surefoot
from surefoot.native.library import VARIABLE


def positions(seconds, **keys):
    """Positions and velocities of a walk from its sensors, tick by tick."""
    found = []
    with surefoot.Simulation(surefoot.load("walk", keys)) as simulation:
        while simulation.time < seconds:
            simulation.advance()
            state = simulation.look().state
            found.append(np.concatenate((state.q, state.v)))
    return np.array(found)


@pytest.mark.physics
def test_states_of_both_agree_for_five_seconds(kernels, monkeypatch):
    compiled = positions(5.0)
    monkeypatch.setenv(VARIABLE, "0")
    np.testing.assert_allclose(compiled, positions(5.0), rtol=0.0, atol=1e-9)


@pytest.mark.physics
def test_a_reading_that_is_rounded_shows_no_difference_below_a_bit_and_so_lets_it_grow(kernels, monkeypatch):
    """Why a preset's noise has the rounding of its encoders in it: a walk is then the same on every machine."""
    keys = {"sensing.encoder_bits": 19, "sensing.encoder_noise": 1e-5}
    compiled = positions(2.0, **keys)
    monkeypatch.setenv(VARIABLE, "0")
    apart = np.abs(compiled - positions(2.0, **keys)).max(axis=1)
    assert apart[100:200].max() < 1e-8 and apart[-200:].max() > 1e-6
