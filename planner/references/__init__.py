"""References over horizon and preview: ZMP, CoM height, what the legs add, put together in a window."""
