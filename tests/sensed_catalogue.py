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
    wider = yaml.safe_load(campaign.read_text())["grid"]["walk"]

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
