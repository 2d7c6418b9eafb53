"""The public humanoids nearest to the bounds on sizes: no bound that refuses takes one away."""

import csv
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
sys.path.insert(0, str(ROOT))
from benchmarks.magnitudes import HEADS, LAWS, asked, nearest  # noqa: E402

pytestmark = pytest.mark.unit


def kept() -> list[dict[str, str]]:
    lines = (ROOT / "docs" / "results" / "magnitudes.csv").read_text(encoding="utf-8").splitlines()
    return list(csv.DictReader(line for line in lines if not line.startswith("#")))


def test_every_law_was_asked_and_those_that_refuse_hold() -> None:
    rows = kept()
    assert [row["law"] for row in rows] == list(LAWS)
    assert min(int(row["models"]) for row in rows) >= 25
    for row in rows:
        law = LAWS[row["law"]]
        assert law.then == "remarked" or law.holds(float(row["ratio"]), 1.0), row


def test_the_nearest_is_the_one_that_has_least_to_go_to_either_bound() -> None:
    heard = {name: {key: [0.3] for key in LAWS} for name in ("one", "other")}
    heard["one"] = {**heard["one"], "FAR": [0.1, 3.0], "COM": [0.5]}
    heard["other"] = {**heard["other"], "FAR": [2.0], "COM": [1.2]}
    found = {row.law: row for row in nearest(heard)}
    assert (found["FAR"].model, found["FAR"].ratio, found["FAR"].models) == ("one", 3.0, 2)
    assert (found["COM"].model, found["COM"].ratio) == ("one", 0.5)


def test_a_robot_that_comes_along_is_asked_by_all_laws(capsys: pytest.CaptureFixture[str]) -> None:
    data = "package://example-robot-data/robots/alexander_description/urdf"
    heard = asked(f"{data}/alexander_v1.lowerBodyOnly.urdf")
    assert {name for name, ratios in heard.items() if not ratios} <= {"GYRATION"}
    assert capsys.readouterr().out == ""
    assert asked("no.urdf") == {name: [] for name in LAWS}
    assert "no.urdf: cannot be read" in capsys.readouterr().out
    assert tuple(kept()[0]) == HEADS
