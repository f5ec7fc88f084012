"""What a plan is made from: the ship as it is assumed, what it allows, what is wished for, and volts to speed."""
