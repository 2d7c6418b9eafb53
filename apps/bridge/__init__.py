"""A plant and a controller in processes of their own, with the robot's low-level messages between them."""
