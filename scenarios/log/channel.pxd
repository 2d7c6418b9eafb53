# Its classes stay Python's, since what thins a channel is made of them.
