import pytest

from surefoot.scenarios.loop.full import shoulder_pitches

pytestmark = pytest.mark.unit


def test_shoulders_are_found_by_name():
    names = ("waist", "left_shoulder_pitch", "left_elbow", "right_shoulder_pitch")
    assert shoulder_pitches(names) == (1, 3)
    assert shoulder_pitches(("left_hip_pitch", "right_hip_pitch")) is None
