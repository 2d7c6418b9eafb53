"""The table of public humanoids: what is counted, what is followed, where models are looked for."""

from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from benchmarks import robots
from surefoot.models.names import SHIPPED

pytestmark = pytest.mark.unit

G1 = yaml.safe_load(Path(SHIPPED["g1"]).read_text(encoding="utf-8"))["model"]


def test_there_are_twenty_and_each_has_a_name_of_its_own() -> None:
    assert len({model.name for model in robots.MODELS}) == len(robots.MODELS) >= 20
    assert all(len(model.added) <= 2 for model in robots.MODELS)


def test_a_model_is_found_by_the_end_of_its_path(tmp_path) -> None:
    for folder in ("one/urdf", "other/urdf"):
        (tmp_path / folder).mkdir(parents=True)
        (tmp_path / folder / "robot.urdf").touch()
    model = robots.Model("robot", "other/urdf/robot.urdf", "somewhere")
    assert robots.found(model, [tmp_path]) == str(tmp_path / "other/urdf/robot.urdf")
    assert robots.found(replace(model, place="third/robot.urdf"), [tmp_path]) is None


def test_lines_that_are_added_replace_those_of_the_same_key() -> None:
    text = robots.with_lines("name: a\ninertia: repair\n# sole: {}\n", ("inertia: refuse",))
    assert text == "name: a\n# sole: {}\ninertia: refuse\n"


def test_what_a_refusal_proposes_is_followed_until_it_is_accepted(tmp_path) -> None:
    told = [
        "x.yaml:3:1: fast; take for example --set gait.step_length=0.138 --set gait.single_support=0.66 (0.5 in y)",
        "x.yaml:3:1: too low; take for example --set gait.com_height=0.7",
    ]
    given = []

    def run(name, settings, out):
        given.append(dict(settings))
        refused = told[len(given) - 1 : len(given)]
        return robots.Walked(stayed=not refused, refused=tuple(refused))

    walked, gait = robots.followed("walk-level", {"robot": "r"}, tmp_path, run)
    assert walked.stayed
    assert gait == {"gait.step_length": "0.138", "gait.single_support": "0.66", "gait.com_height": "0.7"}
    assert given[-1] == {"robot": "r", **gait}


def test_a_list_that_is_proposed_is_followed_too() -> None:
    told = (
        "too slow; take for example --set 'gait.velocity=[{time: 0.0, yaw_rate: 0.118}, {time: 12.1}]' (0.5 in x.yaml)"
    )
    proposed = " ".join(robots.PROPOSAL.findall(told))
    assert robots.SETTING.findall(proposed) == [("gait.velocity", "[{time: 0.0, yaw_rate: 0.118}, {time: 12.1}]")]


def test_a_refusal_without_a_proposal_or_with_the_same_ends_it(tmp_path) -> None:
    refusal = robots.Walked(refused=("too weak; take for example --set gait.com_height=0.7",))
    assert robots.followed("walk-level", {}, tmp_path, lambda *given: refusal) == (refusal, {"gait.com_height": "0.7"})


def test_good_is_who_walks_and_survives_every_push_with_two_lines_at_most() -> None:
    model = robots.Model("robot", "robot.urdf", "somewhere", ("a: 1", "b: 2"))
    row = robots.Row(
        model, reads=True, derives=True, stands=True, walks=True, turns=True, pushed=4, mass=30.0, joints=20
    )
    bad = [
        replace(row, walks=False),
        replace(row, pushed=3),
        replace(row, pushed=None),
        replace(row, model=replace(model, added=("a: 1", "b: 2", "c: 3"))),
    ]
    assert row.good and not any(other.good for other in bad)
    assert "1 of 5 take all steps and survive every push." in robots.table([row, *bad])


def test_what_cannot_be_read_is_a_row_with_its_reason(tmp_path) -> None:
    path = tmp_path / "biped.urdf"
    path.write_text("<robot name='biped'/>", encoding="utf-8")
    row = robots.examined(robots.Model("biped", "biped.urdf", "somewhere"), str(path), tmp_path / "out")
    assert not row.good and row.walks is None
    assert row.why and "Traceback" not in row.why[0]


def test_a_fault_of_one_robot_ends_no_table(tmp_path) -> None:
    """Here of a folder that is a file."""
    (tmp_path / "out").touch()
    row = robots.examined(robots.Model("G1", "g1.urdf", "somewhere"), G1, tmp_path / "out")
    (why,) = row.why
    assert why.startswith("NotADirectoryError: ") and row.reads and not row.good


def test_rows_that_moved_are_told_by_what_moved(tmp_path) -> None:
    model = robots.Model("robot", "robot.urdf", "somewhere")
    row = robots.Row(
        model, reads=True, derives=True, stands=True, walks=True, turns=True, pushed=4, mass=30.0, joints=20
    )
    robots.write([row], tmp_path / "before.csv")
    assert list(robots.moved_from([row], tmp_path / "before.csv")) == []
    worse, new = replace(row, pushed=3, turns=False), replace(row, model=replace(model, name="other"))
    assert list(robots.moved_from([worse, new], tmp_path / "before.csv")) == [
        "robot: turns was yes, is **no**",
        "robot: pushed was 4 of 4, is 3 of 4",
        f"other: not in {tmp_path / 'before.csv'}",
    ]


def test_a_table_is_held_against_that_of_before_from_the_command_line(tmp_path, capsys) -> None:
    """The exit code is 0 where no row has moved, and 1 where one has."""
    model = robots.Model("robot", "robot.urdf", "somewhere")
    (tmp_path / "robot.urdf").write_text("", encoding="utf-8")
    table, given = tmp_path / "table.csv", [str(tmp_path), "--jobs", "1", "--out", str(tmp_path / "out")]
    robots.main([*given, "--csv", str(table)], (model,))
    for code in (0, 1):
        with pytest.raises(SystemExit) as end:
            robots.main([*given, "--against", str(table)], (model,))
        assert end.value.code == code
        table.write_text(table.read_text().replace("**no**", "yes"))
    assert "robot: reads was yes, is **no**" in capsys.readouterr().out
