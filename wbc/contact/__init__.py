"""Contact with the ground: the wrench cone, the contact schedule, the ZMP and what acts beside the ground."""
