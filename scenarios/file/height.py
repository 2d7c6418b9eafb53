"""The CoM height law of a scenario."""

from planner.com_height import BENT_KNEES, BentKneeHeight, HeightProfile, PaperHeight, Rise, SmoothHeight
from scenarios.file.ground import start_height
from scenarios.file.schema import Scenario


def height_profile(scenario: Scenario) -> HeightProfile:
    """The height law: where the CoM climbs follows from the fidelity unless the scenario says it.

    The paper's profile has the paper's own law, in double support and with its jumps. Of the others, a pendulum can do
    what the paper does and climbs in double support; legs cannot, and climb in single support.
    """
    if scenario.planner.profile == "paper" and scenario.planner.knee == "stretched":
        return PaperHeight()
    place = scenario.planner.rise or ("double" if scenario.fidelity == "pendulum" else "single")
    rise = Rise(place)
    return BentKneeHeight(rise) if scenario.planner.knee == "bent" else SmoothHeight(rise)


def standing_height(scenario: Scenario) -> float:
    """CoM height over the soles at which the walk begins and ends [m]."""
    return scenario.gait.com_height - (BENT_KNEES if scenario.planner.knee == "bent" else 0.0)


def start_com_height(scenario: Scenario) -> float:
    """CoM height in the world at the start [m]."""
    return start_height(scenario) + standing_height(scenario)
