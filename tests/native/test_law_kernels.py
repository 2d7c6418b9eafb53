"""Plans made with the compiled kernels against those of plain Python, plan by plan, on real walks."""

from typing import Any

import pytest

from surefoot.planner.references.leg_offset import LegOffset

pytestmark = pytest.mark.unit


def pushed(x: float, y: float) -> dict[str, Any]:
    return {"pushes": [{"time": 1.5, "duration": 0.1, "force": [x, y, 0.0]}]}


WALKS = {
    "walk": ("walk", 2.0, {}),
    "pushed": ("walk", 2.6, pushed(320.0, 200.0)),
    "stairs": ("stairs-up", 2.6, {}),
    "fast": ("walk-fast", 2.2, {}),
    "turning": ("walk-curve", 2.0, {}),
    "g1": ("walk", 2.4, {"robot": "g1", "sized_for": "humanoid100", **pushed(60.0, 30.0)}),
    "talos": ("walk", 2.4, {"robot": "talos", "sized_for": "humanoid100", **pushed(200.0, 100.0)}),
}
FLOWN = {"pushed", "g1", "talos"}


@pytest.mark.parametrize("case", WALKS)
def test_kernels_plan_what_plain_python_plans(planner_twins, monkeypatch, case):
    name, seconds, overrides = WALKS[case]
    made, flown = LegOffset.made, []

    def counted(offset: LegOffset, moving: Any, *given: Any) -> Any:
        flown.append(moving[-1] is not None)
        return made(offset, moving, *given)

    monkeypatch.setattr(LegOffset, "made", counted)
    pair = planner_twins(name, seconds, **overrides)
    assert any(flown) is (case in FLOWN)
    assert pair.unlike == {}
