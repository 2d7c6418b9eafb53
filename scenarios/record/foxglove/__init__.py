"""The drawings of MCAP viewers: a run in Foxglove's well-known schemas, beside the numeric channels of the log."""

DERIVED_TOPICS = frozenset(
    {"/tf", "/joint_states", "/scene/world", "/scene/forces", "/scene/points", "/scene/support", "/events"}
)
"""Topics that say nothing the numeric channels do not."""
