"""Files and settings that nobody writes by hand: one sentence each, at once, whatever they hold."""

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

from surefoot.scenarios.errors import LONGEST_SENTENCE, ScenarioError
from surefoot.scenarios.setup.load import load, read_scenario

pytestmark = pytest.mark.unit


def refusal(robots, text, overrides=()):
    begin = time.process_time()
    with pytest.raises(ScenarioError) as caught:
        read_scenario(text, "f.yaml", "f", overrides, robots)
    assert time.process_time() - begin < 4.0  # half of it on a machine that does nothing else
    said = str(caught.value)
    assert len(said.splitlines()) == len(caught.value.problems) <= 21
    assert all(sign.isprintable() for sign in said.replace("\n", ""))
    return caught.value.problems


@pytest.fixture
def robots():
    from surefoot.scenarios.setup.robot.robots import Robots

    return Robots()


CASES = {
    "name: !!python/object:os.system a": "1:7: not valid YAML, a tag ('!!python/object:os.system'), which scen",
    "gait: !foo {steps: 2}": "f.yaml:1:7: not valid YAML, a tag ('!foo')",
    "pushes: !!set {a}": "f.yaml:1:9: not valid YAML, a tag ('!!set')",
    "seed: !!int '3'": "f.yaml:1:7: not valid YAML, a tag ('!!int')",
    "name: !!binary YQ==": "f.yaml:1:7: not valid YAML, a tag ('!!binary')",
    "gait: &g {steps: 2}\nterrain: {<<: *g}": "f.yaml:2:11: '<<' merges no groups here; write the keys",
    "gait: {step_length: 1e400}": "f.yaml:1:21: gait.step_length is inf; give a finite number",
    "seed: 1" + "0" * 400: "f.yaml:1:7: seed is inf; give a whole number",
    "seed: 1" + "0" * 5000: "f.yaml:1:7: seed is inf; give a whole number",
    "seed: .nan": "f.yaml:1:7: seed is nan; give a whole number",
    "seed: true": "f.yaml:1:7: seed is true; give a whole number",
    "gait: {step_length: true}": "f.yaml:1:21: gait.step_length is true; give a number",
    "seed: 2026-11-21": "f.yaml:1:7: seed is '2026-11-21'; give a whole number",
    "gait: {single_support: 1:30}": "f.yaml:1:24: gait.single_support is '1:30'; give a time",
    "duration: 1:30": "f.yaml:1:11: duration is '1:30'; give a time",
    '"a\\0b\\e[2J": 1': "f.yaml:1:1: unknown key 'a\\x00b\\x1b[2J'; valid are",
    'name: "a\\ud800"': "f.yaml:1:7: name is 'a\\ud800'; use plain text",
    "name: a\0b": "f.yaml:1:8: a character that YAML does not allow",
    "name: " + "a" * 400_000: "...; use fewer letters",
    "a" * 900 + ": 1": "unknown key 'aaa",
    "name: a\n---\nname: b": "f.yaml:2:1: not valid YAML, but found another document",
}


@pytest.mark.parametrize("text", CASES, ids=[text[:30].replace("\0", "0") for text in CASES])
def test_one_sentence(robots, text):
    (found,) = refusal(robots, text)
    assert CASES[text] in found


@pytest.mark.parametrize(
    ("override", "said"),
    [
        (".".join("a" * 500) + "=1", "a key of 500 parts; give at most 20"),
        ("gait=" + "[" * 500, "--set gait:1:21: not valid YAML, nested deeper than 20 levels"),
        ("gait=" + "{a: " * 500, "nested deeper than 20 levels"),
        ("x" * 100_000 + "=1", "unknown key 'xxx"),
        ("x" * 100_000, "not a setting; write --set key=value"),
        ("gait.steps=\udcff", "--set gait.steps:1:1: a character that YAML does not allow"),
        ("gait.\udcff=1", "--set gait.\\udcff: no key is spelt so"),
        ("seed=!!int 3", "--set seed:1:1: not valid YAML, a tag ('!!int')"),
    ],
)
def test_one_sentence_of_a_setting(robots, override, said):
    (found,) = refusal(robots, "name: a", (override,))
    assert said in found
    assert len(found) <= LONGEST_SENTENCE + 10


def nested(depth):
    value = 1
    for _ in range(depth):
        value = [value]
    return value


def itself():
    value = []
    value.append(value)
    return value


@pytest.mark.parametrize(
    ("value", "said"),
    [
        ({"gait": nested(5000)}, "--set gait: nested deeper than 20 levels"),
        ({"gait": itself()}, "--set gait: nested deeper than 20 levels"),
        ({"seed": 10**5000}, "--set seed: seed is inf; give a whole number"),
        ({"gait.step_length": -(10**400)}, "--set gait.step_length: gait.step_length is -inf; give a finite number"),
        ({"gait": {1: 2}}, "--set gait: unknown key '1'"),
        ({"seed": b"x"}, "--set seed: seed is b'x'; give a whole number"),
    ],
)
def test_one_sentence_of_a_value_from_python(robots, value, said):
    (found,) = refusal(robots, "name: a", value)
    assert said in found


@pytest.mark.parametrize(
    ("text", "first", "count"),
    [
        ("\n".join(f"k{i}: 1" for i in range(2500)), "f.yaml:1:1: unknown key 'k0'; valid are commands", 2500),
        ("criteria:\n" + "".join(f"  k{i}: 1\n" for i in range(1500)), "f.yaml:2:3: unknown metric 'k0'", 1500),
        ("pushes:\n" + "  - {x: 1}\n" * 1500, "f.yaml:2:6: unknown key 'x'; valid are body", 1500),
        ("name: b\n" * 1500, "f.yaml:1500:1: 'name' is given twice", 1499),
    ],
)
def test_of_thousands_of_problems_the_first_twenty_and_the_count(robots, text, first, count):
    found = refusal(robots, text)
    assert found[0].startswith(first)
    assert found[20] == f"f.yaml: {count - 20} problems more; mend these first"


def test_what_is_no_regular_file_is_refused_at_once(tmp_path):
    pipes = [tmp_path / "p.yaml", tmp_path / "p.mcap"]
    for pipe in pipes:
        os.mkfifo(pipe)
    (tmp_path / "loop.yaml").symlink_to("loop.yaml")
    for reference in (*pipes, "/dev/zero", "/dev/stdin", tmp_path, tmp_path / "loop.yaml", tmp_path / "p.yaml" / "x"):
        with pytest.raises(ScenarioError) as caught:
            load(reference)
        assert len(caught.value.problems) == 1


def test_names_that_are_no_utf_8_reach_the_terminal_escaped(tmp_path):
    place = os.fsencode(tmp_path) + b"/\xff.yaml"
    with Path(os.fsdecode(place)).open("w") as file:
        file.write("gait: {step: 3}")
    told = subprocess.run([sys.executable, "-m", "surefoot", "run", place], capture_output=True, timeout=60)
    assert (told.returncode, told.stdout) == (2, b"")
    assert b"\\udcff.yaml:1:8: unknown key 'step'; did you mean 'steps'?" in told.stderr
    assert b"Traceback" not in told.stderr
