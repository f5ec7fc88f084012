"""What a governor with limits predicts of a test from its set point, and its prediction errors without their colour."""
