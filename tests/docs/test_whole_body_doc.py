"""docs/whole-body.md names code that exists and numbers that are the defaults."""

import re
from dataclasses import fields
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from dotted import named

from surefoot.models.pinocchio import pinocchio_model
from surefoot.models.registry import describe
from surefoot.models.types import RobotOptions
from surefoot.similarity import Similarity
from surefoot.wbc.body.limits import JointLimits
from surefoot.wbc.body.model import BodyFrames, RobotTerms
from surefoot.wbc.contact.cone import Sole
from surefoot.wbc.parameters import WbcParameters
from surefoot.wbc.tasks import DEFAULT_LAYOUT

pytestmark = pytest.mark.unit

TEXT = (Path(__file__).parents[2] / "docs" / "whole-body.md").read_text(encoding="utf-8")


def shown(value):
    return f"({', '.join(f'{part:g}' for part in value)})" if isinstance(value, tuple) else f"{value:g}"


def rows(settings, prefix=""):
    """Name, default, unit and meaning of every number, group by group."""
    for entry in fields(settings):
        value = getattr(settings, entry.name)
        if "unit" in entry.metadata:
            yield prefix + entry.name, shown(value), entry.metadata["unit"], entry.metadata["doc"]
        elif not isinstance(value, str | Similarity):
            yield from rows(value, f"{prefix}{entry.name}.")


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`(wbc\.[a-zA-Z_.]+)`", TEXT)) - {"wbc."}))
def test_code_is_there(name):
    assert named(name) is not None


def test_a_name_that_is_not_there_is_found_out():
    assert named("wbc.controller.WholeBodyController.assemble") is None
    assert named("wbc.no_such_module") is None


def test_the_table_of_numbers_is_that_of_the_code():
    table = re.findall(r"^\| `([a-z_.]+)` \| (\S.*?) \| (\S.*?) \| (\S.*?) \| \S.* \|$", TEXT, re.MULTILINE)
    assert table == list(rows(WbcParameters()))


def test_what_the_controller_is_given_has_the_defaults_of_the_code():
    limits, sole = JointLimits(*[np.zeros(1)] * 4), Sole(0.1, 0.1, 0.8)
    table = re.findall(r"^\| `wbc\.\w+\.\w+\.(\w+)\.(\w+)` \| ([\d.]+) \|", TEXT, re.MULTILINE)
    found = {"Sole": sole, "JointLimits": limits}
    assert len(table) == 4
    assert [shown(getattr(found[kind], name)) for kind, name, _ in table] == [value for *_, value in table]


def test_the_table_of_tasks_is_the_default_layout():
    table = re.findall(r"^\| ([\w ]+), (\d) \| .*`wbc\.tasks\.", TEXT, re.MULTILINE)
    assert tuple((name, int(size)) for name, size in table) == DEFAULT_LAYOUT


def test_the_task_of_the_page_does_what_it_says():
    """A head that is turned away is asked back."""
    found: dict[str, type] = {}
    code = next(block for block in re.findall(r"(?s)```python\n(.*?)```", TEXT) if block.startswith("class"))
    exec(code, {"pin": pin}, found)
    robot = describe("humanoid100", RobotOptions())
    model, frames = pinocchio_model(robot), BodyFrames(robot.sole_sites, robot.torso_body)
    terms, q = RobotTerms(model, frames), pin.neutral(model)
    q[3:7] = (0.0, 0.0, np.sin(0.1), np.cos(0.1))
    terms.update(q, np.zeros(model.nv))
    task = found["StillHead"](model, frames)
    J = np.zeros((3, model.nv + 12))
    wanted = task.write(terms, None, np.full((3, 1), 2.0), J)
    np.testing.assert_allclose(wanted, [0.0, 0.0, -20.0], atol=1e-9)
    np.testing.assert_allclose(J[:, 3:6], 2.0 * np.eye(3), atol=1e-9)
