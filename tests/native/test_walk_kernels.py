"""The compiled control tick against the plain one, tick by tick, on real walks."""

import pytest

pytestmark = pytest.mark.unit

PUSH = {"pushes": [{"time": 0.6, "duration": 0.3, "force": [60.0, 40.0, 0.0]}], "errors.payload.mass": 10.0}
HARD = {"pushes": [{"time": 0.9, "duration": 0.1, "force": [300.0, 300.0, 0.0]}], "gait.initial_stand": 0.4}
PUNCH = {"step": 1, "phase": "single", "fraction": 0.3, "duration": 0.1, "impulse": 0.5, "direction": -1.57}
WALKS = {
    "walk": ("walk", 2.0, {}, {"one foot", "held by inequalities"}),
    "pushed": ("walk", 1.2, PUSH, {"one foot", "force", "weight"}),
    "caught": ("walk", 1.4, HARD, {"one foot", "ZMP beyond the soles"}),
    "stairs": ("stairs-up", 3.0, {}, {"one foot", "ankle at its stop"}),
    "fast": ("walk-fast", 2.2, {}, {"rolling", "held by inequalities"}),
    "sensed": (
        "walk",
        3.4,
        {"gait.initial_stand": 0.2, "sensing.source": "ekf", "sensing.preset": "good", **PUSH},
        {"one foot", "weight"},
    ),
    "g1": ("walk", 1.6, {"robot": "g1"}, {"one foot"}),
    "g1 punched": ("walk", 2.4, {"robot": "g1", "gait.initial_stand": 0.4, "pushes": [PUNCH]}, {"ankle to rest"}),
    "talos": ("walk", 1.6, {"robot": "talos"}, {"one foot", "limbs near"}),
}


@pytest.mark.parametrize("case", WALKS)
def test_kernels_do_what_their_counterparts_do(twins, case):
    name, seconds, overrides, comes_by = WALKS[case]
    pair = twins(name, seconds, **{"sensing.source": "truth", **overrides})
    assert {what for what, count in pair.seen.items() if count} >= comes_by, pair.seen
    assert pair.unlike == {}
