"""The tests of a campaign in the recorded set point: found, matched with what was asked, and timed."""
