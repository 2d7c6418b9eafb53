"""The planner of a scenario and of a program: the height law of a profile, and random numbers of each thing."""

from dataclasses import replace

import numpy as np
import pytest

import surefoot
from surefoot.planner.laws.profiles import PROFILES
from surefoot.planner.references.com_height import BentKneeHeight, PaperHeight, SmoothHeight
from surefoot.planner.rules import RULES
from surefoot.scenarios.setup.walk import Walk
from surefoot.streams import Stream, generator

pytestmark = pytest.mark.unit


def formulation(own=None, **settings):
    keys = {f"planner.{name}": value for name, value in settings.items()}
    return Walk(surefoot.load("diagonal-walk", keys), given=own).formulation


def heights(own=None, **settings):
    return formulation(own, **settings).heights


def test_a_profile_that_a_program_hands_over_brings_its_height_law():
    assert isinstance(heights(), SmoothHeight)
    assert isinstance(heights(profile="paper"), PaperHeight)
    assert isinstance(heights(PROFILES["paper"]), PaperHeight)
    own = replace(PROFILES["default"], name="own", height=PaperHeight())
    assert heights(own) is own.height
    assert isinstance(heights(own, knee="bent"), BentKneeHeight)


def test_the_streams_of_a_seed_have_different_numbers_and_each_the_same_again():
    drawn = [generator(5, stream).uniform(size=4) for stream in (None, *Stream)]
    assert len({numbers.tobytes() for numbers in drawn}) == len(drawn)
    np.testing.assert_array_equal(generator(5, Stream.GROUND).uniform(size=4), drawn[1 + list(Stream).index(2)])


def test_rules_that_are_left_out_are_not_of_the_walk_and_the_others_keep_their_order():
    assert formulation().rules == RULES
    left_out = ("goes_again", "ends")
    assert formulation(without=left_out).rules == tuple(rule for rule in RULES if rule.__name__ not in left_out)


def test_a_profile_with_a_planner_of_its_own_has_no_rules_to_leave_out():
    own = replace(PROFILES["default"], name="own", planner=lambda *given: None)
    (problem,) = formulation(own, without=["ends"]).problems()
    assert problem.key == ("planner", "without")
    assert problem.right == "leave it out: there is none"
