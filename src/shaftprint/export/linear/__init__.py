"""The linear model of a structure about its working point, with exact delays, in the form that other programs take."""
