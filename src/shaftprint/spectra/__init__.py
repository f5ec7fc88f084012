"""From signals to measured frequency responses with their covariance.

=========================== ======= ==================================================================
quantity                    unit    meaning and sign convention
=========================== ======= ==================================================================
frequency of a line ``f``   Hz      of the campaign; ``omega_rad_s`` in rad/s
amplitude                   -       complex, ``x = Re(a exp(j w t))``, over the working point; set point
                                    and speed over ``n_0``, torque over ``M_s0``, rack over ``X_0``
response                    -       output amplitude over input amplitude; a lag has negative phase
covariance                  -       of the real vector [Re, Im], outputs first
degrees of freedom          -       real degrees of freedom behind a covariance
signal-to-noise ratio       dB      local, 20 DFT bins on each side; overall ratio without unit
load drift ``delta``        -       propeller load of a window over that at the working point, minus 1
=========================== ======= ==================================================================

`estimate_spectra` gives all of it for sines and `estimate_inputs_of_legs` for legs, `estimate_response` the response
alone, `open_loop` and `governor_and_engine` its open-loop forms.

For drives that are no ships `response_from_arrays` makes a response from plain time series, in the units of the arrays,
`plant_from_closed_loop` takes a plant out of its loop, and `FrequencyResponse` holds what another program has measured.
"""

import lazy_loader

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
