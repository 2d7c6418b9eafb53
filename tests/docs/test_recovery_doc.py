"""docs/recovery.md names code and keys that exist, and numbers that are those of the code."""

import re
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest
from dotted import named

from surefoot.planner.model.dcm import nominal_dcm
from surefoot.planner.parameters import PlannerParameters, RecoveryParameters
from surefoot.planner.swing.leg_reach import STRIDE
from surefoot.planner.swing.quintics import PEAK
from surefoot.scenarios.setup.load import load
from surefoot.scenarios.setup.walk import resolve

pytestmark = pytest.mark.unit

TEXT = (Path(__file__).parents[2] / "docs" / "recovery.md").read_text(encoding="utf-8")
NUMBERS = {entry.name: entry for entry in fields(RecoveryParameters)}


@pytest.fixture(scope="module")
def legs():
    return resolve(load("walk-level")).legs


@pytest.mark.parametrize("name", sorted(set(re.findall(r"`((?:planner|wbc|scenarios)\.[\w.]*[a-z])`", TEXT))))
def test_code_or_key_is_there(name):
    group = load("walk-level")
    keys = name.split(".")
    while keys and hasattr(type(group), "model_fields") and keys[0] in type(group).model_fields:
        group = getattr(group, keys.pop(0))
    assert not keys or named(name) is not None


def test_the_values_are_those_of_the_parameters():
    rows = re.findall(r"(?m)^\|(?:[^|\n]|\\\|)*?\| `(\w+)` \| ([\d.]+) ?(\S*) \| ", TEXT)
    rows += re.findall(r"(?m)^\| `(\w+)` \| ([\d.]+) ?(\S*) \| [^|]+ \|$", TEXT)
    told = {name: (float(value), unit.replace("²", "^2") or "-") for name, value, unit in rows}
    assert len(rows) == len(told) == 16
    assert {name for name in NUMBERS if name.endswith("_weight")} <= set(told)
    units = {name: NUMBERS[name].metadata["unit"] for name in told} | {"parallel": "rad"}
    assert told == {name: (NUMBERS[name].default, units[name]) for name in told}


def test_the_numbers_of_the_legs_are_those_of_the_walk(legs):
    rows = re.findall(r"(?m)^\| `(\w+)` \| ([\d., ]+) m(?:/s²)? \| .* \| (?:`(\w+)`)? ?\|$", TEXT)
    assert [name for name, *_ in rows] == ["radius", "stride", "hip_width", "near", "across", "clear", "acceleration"]
    for name, told, key in rows:
        value = np.ravel(getattr(legs, name))
        assert [float(part) for part in told.split(", ")] == pytest.approx(value, rel=2e-3), name
        assert not key or key in NUMBERS
    numbers = legs.parameters.recovery
    assert legs.near == pytest.approx(legs.sole[1] + 0.5 * numbers.sole_gap)
    assert legs.clear == pytest.approx(legs.sole[0] + numbers.clear)
    assert legs.radius == pytest.approx(0.9 * np.sqrt(0.94**2 - 0.891**2), abs=1e-3)
    assert legs.stride == pytest.approx(STRIDE * legs.radius) and f"{STRIDE} `radius`" in TEXT
    assert PEAK == 5.77


def test_what_a_turn_asks_for_is_as_the_page_says(legs):
    (length, width), turn = legs.sole, 0.2
    turned, sine, cosine = legs.turned(-turn), np.sin(turn), np.cos(turn)
    assert turned.near - legs.near == pytest.approx(0.5 * (length * sine + width * cosine - width))
    assert turned.clear - legs.clear == pytest.approx(0.5 * (width * sine + length * cosine - length))
    near, clear = re.findall(r"(?m)grows by .* ([\d.]+) m at 0\.2 rad$", TEXT)
    assert (turned.near, turned.clear) == pytest.approx((float(near), float(clear)), abs=5e-4)


def test_a_metre_of_the_next_step_moves_the_bounded_dcm_as_the_page_says():
    double, omega, t = 0.16, 3.0, 1e-3
    gain = np.clip(t * np.arange(5000) / double, 0.0, 1.0)[:, None]
    flat = np.full(len(gain), omega)
    g = float(nominal_dcm(flat**2, flat, gain, t)[0, 0])
    assert g == pytest.approx((1.0 - np.exp(-omega * double)) / (omega * double), abs=1e-4)
    assert f"{g:.2f} for D = {double} s and ω = {omega:g} / s" in TEXT


def test_what_has_no_key_is_as_the_page_says():
    parameters = PlannerParameters()
    assert f"`PlannerParameters.touchdown_lead` is {parameters.touchdown_lead:g} s" in TEXT
    assert parameters.cop_authority == (np.inf, np.inf)
    assert not hasattr(load("walk-level").planner, "touchdown_lead")
    assert not hasattr(load("walk-level").planner, "cop_authority")
