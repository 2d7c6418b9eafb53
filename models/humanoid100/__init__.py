"""The 100 kg humanoid of the paper's table."""

from surefoot.models.humanoid100.robot import describe

__all__ = ["describe"]
