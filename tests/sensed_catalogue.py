"""The catalogue with the true state: `pytest -m physics --truth` gives it to scenarios that walk from sensors.

Bounds are those of the campaign `truth`, where it has others. Programs that a test starts read the files as they are.
"""

import re
from importlib.resources import files
from typing import Any

import pytest
import yaml

from surefoot.scenarios import catalogue


def pytest_addoption(parser: Any) -> None:
    """The option."""
    parser.addoption("--truth", action="store_true", help="the catalogue's scenarios have the true state")


@pytest.fixture
def from_sensors(pytestconfig: pytest.Config) -> bool:
    """True if the catalogue walks from sensors: bounds that are others then are named where they are held."""
    return not pytestconfig.getoption("--truth")


def pytest_configure(config: pytest.Config) -> None:
    """Change what is read of the catalogue; lines keep their numbers."""
    read = catalogue.text
    if not config.getoption("--truth"):
        return
    campaign = files("surefoot.studies.campaigns.campaigns") / "truth.yaml"
    narrower = yaml.safe_load(campaign.read_text())["grid"]["walk"]

    def text(name: str) -> tuple[str, str]:
        written, place = read(name)
        if name in catalogue.OWN:
            for key, bound in narrower.get(name, {}).items():
                criterion = key.removeprefix("criteria.")
                line = f"  {criterion}: {yaml.safe_dump(bound, default_flow_style=True).strip()}"
                written = re.sub(rf"^  {criterion}:.*$", line, written, flags=re.MULTILINE)
            written = re.sub(r"^sensing: {preset: \w+}$", "sensing: {source: truth}", written, flags=re.MULTILINE)
        return written, place

    catalogue.text = text
