"""Refusals of the planner are named by key, in its own words: scenario keys are not for it to spell."""

import re
from dataclasses import fields
from pathlib import Path

import pytest

import surefoot.planner.planner
from surefoot.errors import ParameterError
from surefoot.planner.parameters import GroundSearch, LegInertia, PlannerParameters
from surefoot.planner.steps.gait import Bout, GaitParameters
from surefoot.planner.types import Twist

pytestmark = pytest.mark.unit

FOLDER = Path(surefoot.planner.planner.__file__).parent
CLASSES = {
    ("gait",): GaitParameters,
    ("stride",): Twist,
    ("bout",): Bout,
    ("parameters",): PlannerParameters,
    ("parameters", "search"): GroundSearch,
    ("parameters", "leg"): LegInertia,
}


def test_only_a_measurement_is_refused_without_a_key():
    plain = [
        f"{file.name}: {line.strip()}"
        for file in FOLDER.rglob("*.py")
        for line in file.read_text(encoding="utf-8").splitlines()
        if "raise ValueError" in line
    ]
    assert len(plain) == 1, plain
    assert "measured" in plain[0]


@pytest.mark.parametrize(
    ("key", "make"),
    [
        (("gait", "apex_ss"), lambda: GaitParameters(apex_ss=-1.0)),
        (("stride", "width"), lambda: Bout(1.0, (Twist(0.1, width=-0.2),))),
        (("bout", "strides"), lambda: Bout(1.0, ())),
        (("parameters", "horizon"), lambda: PlannerParameters(horizon=0)),
        (("parameters", "search", "hurry_speed"), lambda: GroundSearch(hurry_speed=-1.0)),
        (("parameters", "leg", "mass_ratio"), lambda: LegInertia(mass_ratio=0.7)),
    ],
)
def test_a_refusal_names_a_field_that_there_is(key, make):
    with pytest.raises(ParameterError) as refused:
        make()
    assert refused.value.key == key
    named = CLASSES[key[:-1]]
    assert key[-1] in (named._fields if named is Twist else {field.name for field in fields(named)})
    assert not re.search(r"\b(gait|planner|terrain|parameters)\.[a-z]", str(refused.value))
