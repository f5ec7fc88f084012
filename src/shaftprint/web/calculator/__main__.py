"""The process itself: reads questions until its standard input ends."""

from shaftprint.web.calculator._answers import answer_all

answer_all()
