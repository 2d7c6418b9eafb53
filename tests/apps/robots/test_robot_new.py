"""``surefoot robot new``: a file is written once it is made, xacros are expanded, and nothing that is there is lost."""

import sys
from pathlib import Path

import pytest

from surefoot.models import explain
from surefoot.scenarios.cli import program as cli

pytestmark = pytest.mark.unit

MACRO = '<robot name="biped" xmlns:xacro="http://www.ros.org/wiki/xacro"><xacro:property name="m" value="8.0"/>'
EXPANDS = '''"""Stands for the package of that name, which a test cannot install."""
import sys


def main():
    text = open(sys.argv[1]).read()
    if "broken" in sys.argv[1]:
        sys.exit("first line\\nundefined: m")
    print(text.replace("<xacro:property name=\\"m\\" value=\\"8.0\\"/>", "").replace("${m}", "8.0"))
'''


@pytest.fixture(scope="module")
def urdf() -> str:
    """A biped."""
    sys.path.insert(0, str(Path(__file__).parents[2] / "models" / "robot_file"))
    import biped

    return biped.Biped().urdf()


@pytest.fixture
def surefoot(capsys: pytest.CaptureFixture[str]):
    """Run a command; gives exit code, standard output and standard error."""

    def command(*arguments: str) -> tuple[int, str, str]:
        with pytest.raises(SystemExit) as ended:
            cli.program([*arguments])
        captured = capsys.readouterr()
        return ended.value.code or 0, captured.out, captured.err

    return command


def _macro(urdf: str) -> str:
    text = urdf.replace('<robot name="biped">', MACRO)
    return text.replace('<mass value="8.0"/>', '<mass value="${m}"/>')


def test_a_first_file_is_written_once_it_is_made(surefoot, urdf, tmp_path) -> None:
    """It names the model from where it is; what fails leaves nothing, and nothing that is there is lost."""
    model, out = tmp_path / "biped.urdf", tmp_path / "robots" / "biped.yaml"
    out.parent.mkdir()
    assert surefoot("robot", "new", str(model), "--out", str(out))[0] == 2
    assert not out.exists()
    model.write_text(urdf)
    code, printed, err = surefoot("robot", "new", str(model), "--out", str(out))
    assert (code, printed, err) == (0, f"robot file: {out}\n", "")
    assert explain(str(out)).description.name == "biped"
    before = out.read_text()
    code, _, err = surefoot("robot", "new", str(model), "--out", str(out))
    assert code == 2
    assert "exists already; choose another file, or replace it with --force" in err
    assert out.read_text() == before
    out.write_text("")
    assert surefoot("robot", "new", str(model), "--out", str(out))[0] == 0
    assert surefoot("robot", "new", str(model), "--out", str(out), "--force")[0] == 0
    assert out.read_text() == before


def test_a_model_beside_the_file_is_named_without_a_folder(surefoot, urdf, tmp_path, monkeypatch) -> None:
    (tmp_path / "there").mkdir()
    (tmp_path / "there" / "biped.urdf").write_text(urdf)
    monkeypatch.chdir(tmp_path)
    for out, model in (("there/b.yaml", "biped.urdf"), ("b.yaml", "there/biped.urdf")):
        assert surefoot("robot", "new", "there/biped.urdf", "--out", out)[0] == 0
        assert f"\nmodel: {model}\n" in (tmp_path / out).read_text()
    _, printed, _ = surefoot("robot", "new", "there/biped.urdf")
    assert printed == (tmp_path / "b.yaml").read_text()


def test_an_empty_robot_file_says_how_to_write_one(surefoot, tmp_path) -> None:
    (tmp_path / "robot.yaml").write_text("")
    for command in (("robot", "check"), ("run", "walk-level", "--set")):
        given = f"robot={tmp_path}/robot.yaml" if command[0] == "run" else f"{tmp_path}/robot.yaml"
        code, _, err = surefoot(*command, given)
        assert code == 2
        assert "robot.yaml: is empty; write one with: surefoot robot new MODEL --out FILE" in err


@pytest.fixture
def xacro(urdf, tmp_path, monkeypatch) -> Path:
    """A xacro, and the package."""
    (tmp_path / "packages" / "xacro").mkdir(parents=True)
    (tmp_path / "packages" / "xacro" / "__init__.py").write_text(EXPANDS)
    monkeypatch.syspath_prepend(tmp_path / "packages")
    monkeypatch.setenv("PYTHONPATH", str(tmp_path / "packages"))
    path = tmp_path / "biped.urdf.xacro"
    path.write_text(_macro(urdf))
    return path


def test_a_xacro_is_expanded_beside_it_and_that_is_told(surefoot, xacro) -> None:
    made, out = xacro.with_name("biped.urdf"), xacro.with_name("biped.yaml")
    code, _, err = surefoot("robot", "new", str(xacro), "--out", str(out))
    assert code == 0
    assert err == f"expanded by xacro: {xacro} is {made}, which is the model of this robot file\n"
    assert f"\nmodel: {made}\n" in out.read_text()
    assert explain(str(out)).description.name == "biped"
    assert surefoot("robot", "new", str(xacro), "--out", str(out), "--force")[0] == 0  # the same is there
    made.write_text("mine")
    code, _, err = surefoot("robot", "new", str(xacro), "--out", str(out), "--force")
    assert code == 2
    assert f"{made}, where `surefoot robot new` would expand it to, holds something else" in err
    assert made.read_text() == "mine"


def test_a_xacro_that_cannot_be_expanded_says_how(surefoot, xacro, monkeypatch) -> None:
    broken = xacro.with_name("broken.xacro")
    broken.write_text(xacro.read_text())
    code, _, err = surefoot("robot", "new", str(broken))
    assert code == 2
    assert f"xacro cannot expand it here (undefined: m); expand it: xacro {broken} > robot.urdf" in err
    monkeypatch.setitem(sys.modules, "xacro", None)
    code, _, err = surefoot("robot", "new", str(xacro))
    assert code == 2
    assert (
        f"has xacro's 'xacro:property' left in it; expand it: xacro {xacro} > robot.urdf, or pip install xacro" in err
    )
    assert not xacro.with_name("biped.urdf").exists()
