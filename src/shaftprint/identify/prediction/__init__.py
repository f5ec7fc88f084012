"""What a test can find, before it is made: from the equations alone, or from its plan and the noise."""
