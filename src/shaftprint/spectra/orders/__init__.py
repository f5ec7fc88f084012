"""Orders of engine, shaft and propeller in the torque: found by the angle of the shaft, and taken out."""
