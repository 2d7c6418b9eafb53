import sys
from dataclasses import replace

import pytest
from sites import Site

from surefoot.models import ROBOTS, Robot, RobotError, RobotOptions, UnknownRobotError, describe, robot_names
from surefoot.models.names import SHIPPED

pytestmark = pytest.mark.unit

FROM_EXTRA = ("gr3", "jvrc1")
"""Robots whose models the extra ``robots`` brings."""


def test_every_name_describes_a_robot() -> None:
    for name in robot_names():
        if name not in FROM_EXTRA:
            assert describe(name, RobotOptions()).name == name


@pytest.mark.parametrize("name", FROM_EXTRA)
def test_a_robot_whose_package_is_missing_says_how_to_get_it(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(sys, "path", [place for place in sys.path if "site-packages" not in place])
    with pytest.raises(RobotError, match=r"is not installed; install it with: .*\[robots\]'?$"):
        describe(name, RobotOptions())


def test_unknown_robot_gets_the_nearest_name() -> None:
    with pytest.raises(UnknownRobotError, match="there is no robot 'humanoid10': did you mean 'humanoid100'"):
        describe("humanoid10", RobotOptions())


@pytest.mark.parametrize(
    ("options", "key", "message"),
    [
        (RobotOptions(foot_length=0.0), "foot_length", "foot_length is 0 m; it must lie within"),
        (RobotOptions(foot_width=float("nan")), "foot_width", "foot_width is nan m; it must lie within"),
        (RobotOptions(payload_mass=-1.0), "payload_mass", "payload_mass is -1 kg; it must be"),
        (RobotOptions(payload_mass=float("inf")), "payload_mass", "payload_mass is inf kg; it must be"),
        (RobotOptions(payload_mass=1.0, payload_body="torsoo"), "payload_body", "did you mean 'torso'"),
        (RobotOptions(payload_body="xyz"), "payload_body", "choose from pelvis"),
    ],
)
def test_impossible_options_are_refused_in_one_sentence(options: RobotOptions, key: str, message: str) -> None:
    with pytest.raises(RobotError, match=message) as refused:
        describe("humanoid100", options)
    assert refused.value.key == (key,)


def shorty(options: RobotOptions):
    """A robot of another package: ours with less peak torque."""
    known = describe("humanoid100", options)
    return replace(known, name="shorty", torque_limit=0.5 * known.torque_limit)


SHORTY = Robot("shorty", shorty)


def test_a_robot_of_another_package_is_found_by_its_entry_point(monkeypatch, tmp_path) -> None:
    site = Site(tmp_path / "site", "my-robots")
    site.register("surefoot.robots", shorty=f"{__name__}:SHORTY")
    monkeypatch.syspath_prepend(str(site.folder))
    assert robot_names() == ("humanoid100", *SHIPPED, "shorty")
    options = RobotOptions(foot_length=0.2)
    found = describe("shorty", options)
    assert (found.name, found.sole_length) == ("shorty", 0.2)
    assert (found.torque_limit < describe("humanoid100", options).torque_limit).all()
    ROBOTS.forget()


def test_a_robot_that_calls_itself_otherwise_is_refused() -> None:
    ROBOTS.add("tall", Robot("tall", shorty))
    try:
        with pytest.raises(RobotError, match="'tall' describes itself as 'shorty'"):
            describe("tall", RobotOptions())
    finally:
        ROBOTS.discard("tall")
