"""Charts: what a figure shows, described once, and the two ways to draw it.

================= ==============================================================================================
part              what it is
================= ==============================================================================================
``Chart``         panels with axes, and what is drawn into them
``chart_script``  the chart as data of the page, where plotly draws it; plotly itself is not imported
``draw``          the chart as a figure of matplotlib, which is imported here alone
``save_chart``    the same as SVG, PDF or PNG
================= ==============================================================================================
"""
