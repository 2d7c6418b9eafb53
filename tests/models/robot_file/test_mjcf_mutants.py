"""An MJCF with elements and attributes at random is a robot that tells all that it has lost, or a sentence."""

from collections import Counter

import pytest
from mjcf_elements import source_text
from mjcf_mutants import lost, mutant, outcome


def attack(folder, seeds) -> Counter[str]:
    """Outcomes of mutants of some seeds; each that has lost something tells more than the plain biped."""
    told, kinds = set(outcome(folder, source_text())[1]), Counter[str]()
    for seed in seeds:
        text = mutant(seed)
        refusal, lines, robot = outcome(folder, text)
        if robot is None:
            assert refusal.isprintable() and "; " in refusal, f"seed {seed}: {refusal!r}"
            kinds["refused"] += 1
            continue
        more = [line for line in lines if line not in told]
        missing = lost(robot, text)
        assert more or not missing, f"seed {seed} has lost {missing} and tells nothing more than {lines}"
        kinds["told" if more else "kept"] += 1
    return kinds


@pytest.fixture(autouse=True)
def no_cache(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path / "cache"))


@pytest.mark.unit
def test_the_plain_biped_has_lost_nothing(tmp_path):
    robot = outcome(tmp_path, source_text())[2]
    assert robot is not None and lost(robot, source_text()) == []


@pytest.mark.unit
@pytest.mark.parametrize("attribute", ["stiffness", "damping", "frictionloss", "armature"])
def test_the_law_sees_what_is_lost(tmp_path, attribute):
    robot = outcome(tmp_path, source_text())[2]
    knee = '<joint name="left_knee"'
    assert robot is not None
    assert lost(robot, source_text(change=(knee, f'{knee} {attribute}="0.5"'))) == ["accelerations"]


@pytest.mark.unit
def test_some_mutants_are_robots_or_sentences(tmp_path):
    assert set(attack(tmp_path, range(8))) <= {"refused", "told", "kept"}


@pytest.mark.unit
def test_a_reader_that_says_nothing_is_found_out(tmp_path, monkeypatch):
    """Negative control: without the lines on attributes the attack fails."""
    monkeypatch.setattr("surefoot.models.robot_file.mujoco_source.losses", lambda *_: iter(()))
    with pytest.raises(AssertionError, match="has lost"):
        attack(tmp_path, range(60))


@pytest.mark.long
@pytest.mark.parametrize("first", range(1000, 1200, 50))
def test_many_mutants_are_robots_or_sentences(tmp_path, first):
    kinds = attack(tmp_path, range(first, first + 50))
    assert set(kinds) == {"refused", "told", "kept"}
    assert kinds["told"] + kinds["kept"] >= 15
