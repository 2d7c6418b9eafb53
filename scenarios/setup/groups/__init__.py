"""Groups of keys in the terms of the layers below: gait, planner, sensors and motors."""
