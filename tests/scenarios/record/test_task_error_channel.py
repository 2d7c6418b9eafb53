"""The log's layout of the task errors follows from the controller's tasks."""

import pytest

from surefoot.scenarios.record import channels
from surefoot.scenarios.record.channels import Sizes
from surefoot.wbc.tasks import DEFAULT_LAYOUT

pytestmark = pytest.mark.unit


def task_error(**changes):
    spec = channels.wbc(Sizes(nj=4, nq=11, nv=10, horizon=50, **changes))
    return next(field for field in spec.fields if field.name == "task_error")


def test_the_default_tasks_are_described():
    field = task_error()
    assert field.shape == (18,)
    assert field.doc == "CoM 3, angular momentum 3, pelvis 3, torso 3, swing foot 6"


def test_a_task_from_outside_is_described_after_them():
    field = task_error(tasks=(*DEFAULT_LAYOUT, ("left hand", 2)))
    assert field.shape == (20,)
    assert field.doc.endswith("swing foot 6, left hand 2")
