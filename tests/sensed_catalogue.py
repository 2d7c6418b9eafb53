"""The catalogue from sensors: `pytest -m physics --preset good` lets its scenarios have that preset.

A scenario that says itself what is sensed keeps it. Bounds are those of the campaign `sensors`, where it has others.
Programs that a test starts read the files as they are.
"""

import re
from importlib.resources import files
from typing import Any

import pytest
import yaml

from surefoot.scenarios import catalogue

STANDING = {"criteria.zmp_error_rms": {"max": 0.003}, "criteria.com_error_rms": {"max": [0.002, 0.002, 0.003]}}
"""Bounds of `stand`, which is no walk of the campaign: it has 1.0 to 2.7 mm over five seeds, for 1 mm with the truth.

Soles that are level tell the tilt up to the zeros of the encoders, 0.6 mrad; seed 0 has 1.65 mrad, by which the CoM is
1.2 mm off. Planned from there with a feedback of about one, it comes to rest twice as far from where it should."""


def pytest_addoption(parser: Any) -> None:
    """The option."""
    parser.addoption("--preset", help="sensing.preset of the catalogue's scenarios: perfect, good or cheap")


@pytest.fixture
def from_sensors(pytestconfig: pytest.Config) -> bool:
    """Whether the catalogue walks from sensors: bounds that are others then are named where they are held."""
    return pytestconfig.getoption("--preset") is not None


def pytest_configure(config: pytest.Config) -> None:
    """Add the key to what is read of the catalogue, at the end, so that lines keep their numbers."""
    preset, read = config.getoption("--preset"), catalogue.text
    if preset is None:
        return
    campaign = files("surefoot.scenarios.study.campaigns.campaigns") / "sensors.yaml"
    wider = {"stand": STANDING, **yaml.safe_load(campaign.read_text())["grid"]["walk"]}

    def text(name: str) -> tuple[str, str]:
        written, place = read(name)
        if name in catalogue.OWN and not re.search(r"^sensing:", written, re.MULTILINE):
            for key, bound in wider.get(name, {}).items():
                criterion = key.removeprefix("criteria.")
                line = f"  {criterion}: {yaml.safe_dump(bound, default_flow_style=True).strip()}"
                written = re.sub(rf"^  {criterion}:.*$", line, written, flags=re.MULTILINE)
            written += f"sensing: {{preset: {preset}}}\n"
        return written, place

    catalogue.text = text
