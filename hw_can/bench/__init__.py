"""The other side of the bus: simulated drives, a python-can peer, and scenarios."""
