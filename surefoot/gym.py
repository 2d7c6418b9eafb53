"""Surefoot beside those who train: a Gymnasium environment of any scenario and robot, with the extra ``gym``.

    import gymnasium
    import surefoot.gym

    env = gymnasium.make("Surefoot-v0", scenario="walk", robot="g1", contract="contract.yaml")

The environment is that of `surefoot.studies.training`, which is imported when it is made.
"""

from contextlib import suppress
from typing import TYPE_CHECKING, Any

from surefoot.lazy import face

if TYPE_CHECKING:
    from surefoot.studies.training.environment import WalkEnv, first_contract
    from surefoot.studies.training.reward import Transition, upright_and_on_course

__all__ = ["NAME", "Transition", "WalkEnv", "first_contract", "register", "upright_and_on_course"]

NAME = "Surefoot-v0"
"""Name under which Gymnasium makes it."""

_HOMES = {
    "studies.training.environment": ("WalkEnv", "first_contract"),
    "studies.training.reward": ("Transition", "upright_and_on_course"),
}


def register() -> None:
    """Register the environment with Gymnasium, once; importing this module does."""
    import gymnasium

    if NAME not in gymnasium.registry:
        gymnasium.register(NAME, entry_point="surefoot.studies.training.environment:WalkEnv")


with suppress(ImportError):  # without the extra, the environment is refused in a sentence
    register()

if not TYPE_CHECKING:
    _get, __dir__ = face("surefoot", _HOMES)

    def __getattr__(name: str) -> Any:
        """A public name, where its package is installed."""
        if name in ("WalkEnv", "first_contract"):
            from surefoot.scenarios.errors import require

            require("gymnasium", "gym", "an environment")
        return _get(name)
