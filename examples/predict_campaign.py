"""How well will a campaign find the numbers of a ship? Asked before anybody sails.

Nothing is simulated: the lines of the campaign, the noise of the ship and the equations say it. Here three tests are
compared, with and without the inertias of the torsional vibration calculation. The noise is that of the Stan Tug 1205;
`sp.identify.noise_levels` takes it from a recording of your own ship.
"""

import numpy as np

import shaftprint as sp

line = sp.catalogue.structure("GAUGE-CLOSED")
print(sp.identify.identifiability(line, rng=np.random.default_rng(1)).text)
print()

# what the line is thought to be, and what is known of it beforehand
values = {"K_p": 5.7, "K_i": 4.27, "t_d": 0.07, "omega_n": 10.3, "zeta": 0.47, "tau_dn": 0.32, "tau_up": 1.016}
values |= {"t_sp": 0.05}
flat_engine = {"g": sp.identify.Prior(0.0, 0.1)}
calculation = {"tau_up": sp.identify.Prior(1.016, 0.029)}

thesis, short = sp.campaign.load_campaign("thesis"), sp.campaign.load_campaign("short")
louder = short.model_copy(
    update={"sines": tuple(sine.model_copy(update={"amplitude_v": 1.5 * sine.amplitude_v}) for sine in short.sines)}
)

predicted = {}
for test, campaign in (("thesis", thesis), ("short", short), ("short, 1.5 times as loud", louder)):
    plan = sp.identify.planned_response(campaign, sp.survey.STAN_TUG_NOISE)
    for beforehand, priors in (("", flat_engine), (" and the calculation", flat_engine | calculation)):
        predicted[test + beforehand] = sp.identify.predict_accuracy(line, plan, values=values, priors=priors)

names = ("tau_dn", "tau_up", "t_d + t_sp", "K_p / K_i", "v K_p / (tau_up + tau_dn)")
print("standard deviation in %".ljust(45) + "".join(f"{name.split(' (')[0]:>14}" for name in names))
for test, accuracy in predicted.items():
    shares = (100.0 * accuracy.estimate(name).std / accuracy.estimate(name).value for name in names)
    print(test.ljust(45) + "".join(f"{share:14.2g}" for share in shares))
