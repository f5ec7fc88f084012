"""What is shown of a plan: motion over time, the worth of lines, other lengths, and the card for the bridge."""
