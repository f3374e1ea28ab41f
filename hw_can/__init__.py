"""CAN: the Ada layers below, and the Python bench in `hw_can.bench`."""
