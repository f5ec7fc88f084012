"""Figures and the report.

========================= ========== ==========================================================================
quantity                  unit       how it is drawn
========================= ========== ==========================================================================
frequency                 rad/s      logarithmic, plain numbers
magnitude                 dB         ``20 log10 |H|``
phase                     deg        whole turns of data agree with the closest model; of many turns the place in one
interval of data          95 %       error bar; Student's t where the covariance was measured from few periods
band of a model           95 %       filled; covariance of the parameters through exact derivatives
normalised signals        -          deviation over the working point
set point, speed          rpm        of the engine
torque                    N m        at the gauge
========================= ========== ==========================================================================

Every ``plot_*`` function returns a matplotlib ``Figure`` that belongs to nobody else; ``save_chart`` writes it.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
