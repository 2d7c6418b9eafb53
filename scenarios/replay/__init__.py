"""Pictures of a log that move: a page, a live page and a video, all drawn from one content."""
