"""The page of a planned test: first page, card for the bridge, charts."""

from shaftprint.report.plan._plan_page import render_plan

__all__ = ["render_plan"]
