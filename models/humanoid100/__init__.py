"""The 100 kg humanoid of the paper's table."""

from surefoot.models.humanoid100.description import HUMANOID100

__all__ = ["HUMANOID100"]
