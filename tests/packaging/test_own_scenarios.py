"""Scenarios of another package: listed, shown and run by name, read with the limits of a user's file."""

import pytest
import yaml

from surefoot.scenarios import catalogue
from surefoot.scenarios.errors import ScenarioError
from surefoot.scenarios.file.source import MAX_BYTES
from surefoot.scenarios.setup.load import load

pytestmark = pytest.mark.unit

SLOW = "# A slow walk.\ngait: {steps: 2}\n"


@pytest.fixture
def brought(site, monkeypatch, importing):
    """Install a package with these scenarios and load by name."""

    def install(name="others", **texts):
        made, package = site(name), f"my_package_{name}"
        made.write(f"{package}/__init__.py", "")
        for scenario, text in texts.items():
            made.write(f"{package}/{scenario}.yaml", text)
        made.register("surefoot.scenarios", **{name: package})
        monkeypatch.syspath_prepend(str(made.folder))
        return made

    return install


def fault(name):
    with pytest.raises(ScenarioError) as refused:
        load(name)
    return refused.value.problems


def test_they_are_listed_after_ours_shown_and_loaded(brought, at_hand):
    brought(slow=SLOW)
    answer = at_hand("list")
    rows = [line for line in answer.out.splitlines() if line.startswith("scenario")]
    assert (answer.code, answer.err) == (0, "")
    assert rows[-1].split(maxsplit=2) == ["scenario", "slow", "A slow walk. [others]"]
    assert len(rows) == len(catalogue.OWN) + 1
    shown = at_hand("show", "slow").out
    assert shown.startswith(SLOW.splitlines()[0])
    assert yaml.safe_load(shown) == yaml.safe_load(SLOW)
    assert (load("slow").name, load("slow").gait.steps) == ("slow", 2)


def test_faults_have_their_place(brought, at_hand):
    brought(slow="gait:\n  stepps: 2\n", empty="", nested="[" * 50)
    assert fault("slow") == ("my_package_others:slow.yaml:2:3: unknown key 'stepps'; did you mean 'steps'?",)
    assert fault("empty")[0].startswith("my_package_others:empty.yaml:1:1: the file is empty")
    assert fault("nested")[0].startswith("my_package_others:nested.yaml:1:21: not valid YAML, nested deeper")
    answer = at_hand("run", "slow")
    assert (answer.code, answer.out, "Traceback" in answer.err) == (2, "", False)


def test_files_are_read_with_the_limits_of_any_other(brought, at_hand):
    made = brought(large=SLOW + "#" * MAX_BYTES)
    (made.folder / "my_package_others" / "latin.yaml").write_bytes(b"name: x\n# \xe4\n")
    assert fault("large") == (
        f"my_package_others:large.yaml:1:1: larger than {MAX_BYTES} bytes; a scenario is a short YAML file",
    )
    assert fault("latin") == ("my_package_others:latin.yaml:2:3: not UTF-8 text; save the file as UTF-8",)
    answer = at_hand("list")
    assert answer.code == 0
    assert "my_package_others:latin.yaml:2:3: not UTF-8 text" in answer.out
    assert at_hand("show", "latin").code == 2


def test_a_name_of_ours_means_ours_and_the_clash_is_said(brought, at_hand):
    brought(walk="gait: {steps: 1}\n", slow=SLOW)
    assert load("walk").gait.steps == 20
    said = "my_package_others:walk.yaml: 'walk' is a scenario of surefoot's own; give the file another name\n"
    answer = at_hand("list")
    assert (answer.code, answer.err) == (0, said)
    assert answer.out.count("scenario   walk ") == 1


def test_the_first_of_two_packages_keeps_a_name_and_the_clash_is_said(brought, at_hand):
    brought("first", slow=SLOW)
    brought("second", slow="gait: {steps: 3}\n")
    assert load("slow").gait.steps == 2
    assert at_hand("list").err == (
        "my_package_second:slow.yaml: 'slow' is my_package_first:slow.yaml already; give one of them another name\n"
    )


def test_a_file_of_the_user_goes_before_a_name_of_a_package(brought, tmp_path, monkeypatch):
    brought(slow=SLOW)
    monkeypatch.chdir(tmp_path)
    (tmp_path / "slow").mkdir()
    assert load("slow").gait.steps == 2
    (tmp_path / "slow").rmdir()
    (tmp_path / "slow").write_text("gait: {steps: 4}\n")
    assert load("slow").gait.steps == 4


def test_packages_that_cannot_be_looked_at_are_named_with_what_was_not_found(site, at_hand):
    made = site("broken-parts")
    made.write("broken/__init__.py", "NUMBER = 5\n")
    made.write("broken/bang.py", "1 / 0\n")
    made.write("broken/alone.py", "")
    made.register("surefoot.scenarios", a="broken.bang", b="broken:NUMBER", c="broken.alone")
    answer = at_hand("run", "slow", sites=[made])
    assert (answer.code, answer.out) == (2, "")
    first, *rest = answer.err.splitlines()
    assert first.startswith("slow: no such scenario file or catalogue name; ")
    zero, kind = "ZeroDivisionError: division by zero", "is of type int; it must be a module"
    assert rest == [
        f"scenarios 'a' of package broken-parts cannot be loaded, {zero}; mend or remove it",
        f"scenarios 'b' of package broken-parts in surefoot.scenarios {kind}",
        "scenarios 'c': broken.alone is no package; name one in which YAML files lie",
    ]
    assert at_hand("list").err.splitlines() == rest
    assert at_hand("show", "walk").err == ""


def test_nobody_is_asked_for_a_name_of_ours_or_a_file(brought, tmp_path):
    made = brought(slow=SLOW)
    made.write("my_package_others/__init__.py", "from pathlib import Path\nPath(__file__).with_name('seen').touch()\n")
    seen = made.folder / "my_package_others" / "seen"
    (tmp_path / "mine.yaml").write_text(SLOW)
    assert load("walk").name == "walk"
    assert load(tmp_path / "mine.yaml").name == "mine"
    assert not seen.exists()
    assert load("slow").name and seen.exists(), "who is asked is seen"
