"""How a swing foot that has not felt the ground at its touchdown goes on downwards."""

import math
from dataclasses import dataclass, fields


@dataclass(frozen=True, slots=True)
class GroundSearch:
    """A search in two stages: gently, since the ground is hardly below; then in haste, since waiting costs balance.

    Attributes:
        touchdown_speed: downward speed at touchdown [m/s].
        speed: greatest downward speed after it [m/s].
        acceleration: at which that speed is gained; a jump would shake the ZMP of the stance foot [m/s^2].
        hurry_after: time from the touchdown after which the foot hurries, infinite for never [s].
        hurry_speed: greatest downward speed then [m/s].
        hurry_acceleration: at which that is gained [m/s^2].

    Raises:
        ValueError: a number is negative, an acceleration is zero, or one that must be finite is not.
    """

    touchdown_speed: float = 0.005
    speed: float = 0.15
    acceleration: float = 1.0
    hurry_after: float = math.inf
    hurry_speed: float = 0.5
    hurry_acceleration: float = 16.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            least = "greater than 0" if field.name.endswith("acceleration") else "at least 0"
            if not value >= 0.0 or (value == 0.0 and least == "greater than 0"):
                raise ValueError(f"planner.search.{field.name} is {value:g}, but it must be {least}.")
            if not math.isfinite(value) and field.name != "hurry_after":
                raise ValueError(f"planner.search.{field.name} is {value:g}, but it must be finite.")

    def motion(self, since: float) -> tuple[float, float, float]:
        """Way down [m], downward speed [m/s] and acceleration [m/s^2], `since` the touchdown [s]."""
        gentle = _gaining(self.touchdown_speed, self.acceleration, self.speed, min(since, self.hurry_after))
        if since < self.hurry_after:
            return gentle
        way, speed, bend = _gaining(gentle[1], self.hurry_acceleration, self.hurry_speed, since - self.hurry_after)
        return gentle[0] + way, speed, bend


def _gaining(speed: float, bend: float, top: float, since: float) -> tuple[float, float, float]:
    """Way, speed and acceleration of a motion that gains speed up to a top."""
    top = max(speed, top)
    gaining = (top - speed) / bend
    way = speed * since + 0.5 * bend * min(since, gaining) ** 2
    if since < gaining:
        return way, speed + bend * since, bend
    return way + (top - speed) * (since - gaining), top, 0.0
