"""A crew that moves the lever all the time, for logs of half an hour."""

from shaftprint.tug.service._habits import Habits

BUSY = Habits(shortest_hold_s=12.0, longest_hold_s=60.0, idles_per_hour=4.0, idle_s=(40.0, 60.0), declutched=1.0)
