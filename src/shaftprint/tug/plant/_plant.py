"""The propulsion line as physics: constants in SI units and the kernel that steps them through time.

Rigid shaft line, referred to the propeller shaft, cut at the torque gauge::

    2 pi (I_up + I_dn) dn_s/dt = i eta M_b - M_p        M_s = M_p + 2 pi I_dn dn_s/dt
    M_p = K n_s |n_s|                                   M_b = A_1 n_e + A_2 X + A_3, limited

with the PI governor and its back-calculation ahead of a transport delay and a second-order actuation. Where the
propeller has dynamic inflow, the slipstream follows it late and the blades meet a larger angle until it has::

    M_p = K (n_s |n_s| + kappa |n_s| (n_s - u))         du/dt = (n_s |n_s| - u |u|) / (2 n_s0 tau_i)

A gearbox that reverses has a negative ratio ``i``: the engine turns as ever, speed and torque of the shaft are below 0.
``u`` is the slipstream velocity as the shaft speed to which it belongs in steady running. The form is that of Blanke,
Lindegaard and Fossen, "Dynamic model for thrust generation of marine propellers" (2000): torque ``Q_nn n |n| - Q_nu
|n| u``, momentum of the water accelerated by the thrust and lost by ``u |u|``. Linear at the working point it is
``Q* = (2 + kappa) n* - kappa u*`` with ``tau_i du*/dt = n* - u*``.

Underway the propeller turns in water that comes towards it, and the ship has a speed of its own::

    M_p = n_s^2 P_Q(J)      m dv/dt = n_s^2 P_T(J) - c v^e      J = (1 - w) v / (n_s D)

with ``P_Q`` the torque of one propeller and ``P_T`` the pull of all of them over ``n_s^2``, thrust deduction taken off;
both change with the pitch, to second order about that of the curves.

A smoke limiter lets the engine burn no more than the boost gives air for: ``M_b <= M_full (a + (1 - a) b)`` with the
boost ``b`` of a turbocharger that follows the torque late, ``tau_tc db/dt = M_b / M_full - b``: steady running is never
limited, a fast rise is. A limit of the rate of the rack holds for what the governor gives, before delay and actuation.

An electric motor takes the place of the engine where ``torque_per_s`` is not 0: ``X`` is the torque that the speed
controller asks for, over rated torque, the delay is the dead time of the converter, and the torque follows in a lag of
first order as the current loop closes, ``T dX/dt = X(t - t_d) - X``; the natural frequency is 0 then, so that nothing
of second order moves, and no branch is taken that would cost time. It pulls and brakes with constant torque up to
base speed and with constant power above, where the field is weakened: ``M_max n_base / n``.

Where a coupling twists, engine and shaft are two bodies with a spring of stiffness ``k`` and a damping ``c`` between
them, and the governor feels the speed of the engine, ``i n_1``; ``I_m`` is what of ``I_up`` the coupling drives, such
as a gearbox, and ``phi`` the twist in revolutions::

    2 pi (I_up - I_m) dn_1/dt = i eta M_b - T        T = 2 pi (k phi + c (n_1 - n_s))        dphi/dt = n_1 - n_s
    2 pi (I_m + I_dn) dn_s/dt = T - M_p              M_s = M_p + 2 pi I_dn dn_s/dt

An electric machine on the gearbox, a motor or a shaft generator, gives or takes a torque ``M_m`` upstream of the gauge,
at the propeller shaft; its converter controls it, so that it does not follow the speed, and what acts is given from
outside. It is added to ``i eta M_b``.

Gains and delay may go with a power of the engine speed, ``K (n_e / n_e0)^a`` and ``t_d (n_e / n_e0)^b``, at any time.
"""

import numpy as np

from shaftprint.arrays import FloatArray
from shaftprint.kernels._compiled import compiled

SPEED, INTEGRAL, RACK, RACK_RATE, SLIPSTREAM, ANGLE, WAY, ENGINE, TWIST = range(9)
"""Places in the state vector: shaft speed [rev/s], integrator [rack], rack, rack rate [1/s], slipstream velocity as a
shaft speed [rev/s], shaft angle [rev], speed of the ship [m/s]; speed of the engine at the propeller shaft [rev/s] and
twist of the coupling [rev], which play a part only where the coupling is elastic."""
STATES = 9
FARTHEST_SHARE = 4.0
"""Gains and delay that go with the speed stay as they are beyond this share of the working point's, and below one over
it."""


@compiled(inline="always")
def _on_curve(speed, speeds, torques):  # type: ignore[no-untyped-def]
    """Return the torque [N m] of a curve at a speed [rev/s], straight between its points and flat beyond them."""
    last = speeds.size - 1
    if speed >= speeds[last]:
        torque = torques[last]
    elif speed <= speeds[0]:
        torque = torques[0]
    else:
        j = 1
        while speeds[j] < speed:
            j += 1
        part = (speed - speeds[j - 1]) / (speeds[j] - speeds[j - 1])
        torque = torques[j - 1] + part * (torques[j] - torques[j - 1])
    return torque


@compiled(inline="always")
def torque_limits(speed, plant):  # type: ignore[no-untyped-def]
    """Return the lowest and highest brake torque [N m] at an engine speed [rev/s]."""
    highest = _on_curve(speed, plant.limit_speed_rev_s, plant.limit_torque_nm)
    lowest = -_on_curve(speed, plant.motoring_speed_rev_s, plant.motoring_torque_nm)
    return lowest, highest


@compiled()
def _power_sum(powers, at):  # type: ignore[no-untyped-def]
    """Return a sum of powers, by Horner's rule."""
    value = 0.0
    for k in range(powers.size - 1, -1, -1):
        value = value * at + powers[k]
    return value


@compiled(inline="always")
def _pitched(change, at, pitch):  # type: ignore[no-untyped-def]
    """Return what a deviation of the pitch changes in a sum of powers, to second order."""
    return pitch * (_power_sum(change[0], at) + pitch * _power_sum(change[1], at))


@compiled(inline="always")
def _under_way(speed_s, ship_speed, propeller_noise, pitch, way):  # type: ignore[no-untyped-def]
    """Return the torque of a propeller [N m] and the acceleration of the ship [m/s2]."""
    square = speed_s * abs(speed_s)
    advance = way.advance_per_m * ship_speed / speed_s
    pull, torque = _power_sum(way.pull_n_s2, advance), _power_sum(way.torque_nm_s2, advance)
    if pitch != 0.0:
        pull += _pitched(way.pull_pitch_n_s2, advance, pitch)
        torque += _pitched(way.torque_pitch_nm_s2, advance, pitch)
    pull = square * pull * (1.0 + propeller_noise)
    resistance = way.resistance_at_1_m_s * ship_speed**way.resistance_exponent
    return square * torque, (pull - resistance) / way.mass_kg


@compiled(inline="always")
def _felt(error, plant):  # type: ignore[no-untyped-def]
    """Return the speed error [rev/s] that the governor feels beyond its deadband."""
    if plant.deadband_rev_s == 0.0:
        return error
    return error - min(max(error, -plant.deadband_rev_s), plant.deadband_rev_s)


@compiled(inline="always")
def _scheduled(speed, exponent, plant):  # type: ignore[no-untyped-def]
    """Return what is over its value at the working point what goes with a power of the engine speed [rev/s]."""
    if exponent == 0.0:
        return 1.0
    share = min(max(speed / plant.point_speed_rev_s, 1.0 / FARTHEST_SHARE), FARTHEST_SHARE)
    return share**exponent


@compiled(inline="always")
def _engine_end(state, plant):  # type: ignore[no-untyped-def]
    """Return the speed of the engine at the propeller shaft [rev/s]: the shaft's own where the line is rigid."""
    if plant.coupling_nm_rev == 0.0:
        return state[0]
    return state[7]


@compiled(inline="always")
def governor_rack(speed, integral, demand, lowest, highest, plant):  # type: ignore[no-untyped-def]
    """Return the rack that the governor asks for, before and after the limiter of the ECU.

    ``speed`` is that of the engine [rev/s], ``lowest`` and ``highest`` are the brake torques that it may give [N m].
    """
    gain = _scheduled(speed, plant.gain_exponent, plant)
    wanted = gain * plant.proportional_s * _felt(demand - speed, plant) + integral
    without_rack = plant.speed_slope_nm_s * speed + plant.rack_offset_nm
    rack_given = min(
        max(wanted, (lowest - without_rack) / plant.rack_slope_nm), (highest - without_rack) / plant.rack_slope_nm
    )
    return wanted, rack_given


@compiled(inline="always")
def derivatives(  # type: ignore[no-untyped-def]
    state, demand, rack_delayed, propeller_noise, engine_noise, plant, air=1.0, pitch=0.0, machine=0.0
):
    """Return rates of five states, rack given, ``M_s``, ``M_b``, whether it is limited, rates of the last three."""
    speed_s, integral, rack, rack_rate, slipstream = state[0], state[1], state[2], state[3], state[4]
    engine_s = _engine_end(state, plant)
    speed = plant.gear_ratio * engine_s
    # where the torque may go is looked up once for governor and engine: it is what takes the time
    lowest, highest = torque_limits(speed, plant)
    # the share of the full-load torque for which the boost gives air
    highest *= air
    wanted, rack_given = governor_rack(speed, integral, demand, lowest, highest, plant)
    if plant.delay_s == 0.0:
        rack_delayed = rack_given
    unlimited = plant.speed_slope_nm_s * speed + plant.rack_slope_nm * rack + plant.rack_offset_nm
    brake = min(max(unlimited, lowest), highest)
    load = plant.propeller_nm_s2 * speed_s * abs(speed_s)
    way_rate = 0.0
    if plant.sails:
        load, way_rate = _under_way(speed_s, state[6], propeller_noise, pitch, plant.way)
    hydrodynamic = load
    slipstream_rate = 0.0
    if plant.inflow_gain != 0.0:
        hydrodynamic += plant.inflow_gain * plant.propeller_nm_s2 * abs(speed_s) * (speed_s - slipstream)
        slipstream_rate = plant.inflow_per_rev * (speed_s * abs(speed_s) - slipstream * abs(slipstream))
    propeller = hydrodynamic * (1.0 + propeller_noise)
    drive = plant.gear_ratio * plant.efficiency * brake + load * engine_noise + machine
    if plant.coupling_nm_rev == 0.0:
        inertia = plant.inertia_upstream_kg_m2 + plant.inertia_downstream_kg_m2
        acceleration = (drive - propeller) / (2.0 * np.pi * inertia)
        engine_acceleration, twist_rate = 0.0, 0.0
    else:
        twist_rate = engine_s - speed_s
        spring = plant.coupling_nm_rev * state[8] + plant.coupling_nm_s_rev * twist_rate
        ahead = plant.inertia_upstream_kg_m2 - plant.inertia_driven_kg_m2
        behind = plant.inertia_driven_kg_m2 + plant.inertia_downstream_kg_m2
        engine_acceleration = (drive - spring) / (2.0 * np.pi * ahead)
        acceleration = (spring - propeller) / (2.0 * np.pi * behind)
    gauge = propeller + 2.0 * np.pi * plant.inertia_downstream_kg_m2 * acceleration
    gain = _scheduled(speed, plant.gain_exponent, plant)
    integral_rate = gain * plant.integral * _felt(demand - speed, plant) + (rack_given - wanted) / plant.anti_windup_s
    omega = plant.natural_frequency_rad_s
    rack_acceleration = omega * (omega * (rack_delayed - rack) - 2.0 * plant.damping_ratio * rack_rate)
    rack_rate += plant.torque_per_s * (rack_delayed - rack)
    limited = rack_given != wanted or brake != unlimited
    return (
        acceleration,
        integral_rate,
        rack_rate,
        rack_acceleration,
        slipstream_rate,
        rack_given,
        gauge,
        brake,
        limited,
        way_rate,
        engine_acceleration,
        twist_rate,
    )


@compiled(inline="always")
def _past(history, mask, first, weights):  # type: ignore[no-untyped-def]
    """Return the value between the second and third of four nodes of a ring."""
    return (
        weights[0] * history[first & mask]
        + weights[1] * history[(first + 1) & mask]
        + weights[2] * history[(first + 2) & mask]
        + weights[3] * history[(first + 3) & mask]
    )


def _lagrange(position):  # type: ignore[no-untyped-def]
    """Return the first of four nodes and their cubic Lagrange weights for a place between the middle two."""
    node = int(np.floor(position))
    part = position - node
    weights = (
        -part * (part - 1.0) * (part - 2.0) / 6.0,
        (part + 1.0) * (part - 1.0) * (part - 2.0) / 2.0,
        -(part + 1.0) * part * (part - 2.0) / 2.0,
        (part + 1.0) * part * (part - 1.0) / 6.0,
    )
    return node - 1, weights


_taps = compiled(inline="always")(_lagrange)


def interpolation_weights(position: float) -> tuple[int, FloatArray]:
    """Return the first of four nodes and their cubic Lagrange weights for a place between the middle two."""
    first, weights = _lagrange(position)  # type: ignore[no-untyped-call]
    return first, np.array(weights)


@compiled(inline="always")
def _past_at(history, mask, k, position):  # type: ignore[no-untyped-def]
    """Return the value at a place relative to a node of a ring."""
    first, weights = _taps(position)
    return _past(history, mask, k + first, weights)


@compiled(inline="always")
def _moved(x, h, rates):  # type: ignore[no-untyped-def]
    """Return the states after a time ``h`` at constant rates; the angle stays, for no rate depends on it."""
    return (
        x[0] + h * rates[0],
        x[1] + h * rates[1],
        x[2] + h * rates[2],
        x[3] + h * rates[3],
        x[4] + h * rates[4],
        x[5],
        x[6] + h * rates[9],
        x[7] + h * rates[10],
        x[8] + h * rates[11],
    )


@compiled(inline="always")
def _runge_kutta(h, x, k1, demand, past, propeller, engine, plant, air, pitch, machine):  # type: ignore[no-untyped-def]
    """Return the state after a step of the classical fourth-order method, whose first rates ``k1`` are known.

    ``demand``, ``past``, ``propeller``, ``engine``, ``pitch`` and ``machine`` hold the inputs at the start, middle and
    end of the step.
    """
    at, rates, total, speeds = x, k1, k1, x[0]
    # a loop, so that the equations stand here once: compiling them is what takes long
    for place, ahead, weight in ((1, 0.5 * h, 2.0), (1, 0.5 * h, 2.0), (2, h, 1.0)):
        at = _moved(x, ahead, rates)
        rates = derivatives(
            at, demand[place], past[place], propeller[place], engine[place], plant, air, pitch[place], machine[place]
        )
        speeds += weight * at[0]
        total = (
            total[0] + weight * rates[0],
            total[1] + weight * rates[1],
            total[2] + weight * rates[2],
            total[3] + weight * rates[3],
            total[4] + weight * rates[4],
            rates[5],
            rates[6],
            rates[7],
            rates[8],
            total[9] + weight * rates[9],
            total[10] + weight * rates[10],
            total[11] + weight * rates[11],
        )
    part = h / 6.0
    return (
        x[0] + part * total[0],
        x[1] + part * total[1],
        x[2] + part * total[2],
        x[3] + part * total[3],
        x[4] + part * total[4],
        x[5] + part * speeds,
        x[6] + part * total[9],
        x[7] + part * total[10],
        x[8] + part * total[11],
    )


@compiled(nogil=True)
def advance(  # type: ignore[no-untyped-def]
    step_s, demand, pitch, machine, propeller_noise, engine_noise, plant, delay, carried, traces
) -> None:
    """Step the line and fill the traces.

    ``demand``, ``pitch`` and ``machine`` have two values a step and one more (half steps); the disturbances one value a
    step and one more. All that goes on is carried, so that the result does not depend on how the time is cut into
    calls.
    """
    state, history = carried.state, carried.history
    x = (state[0], state[1], state[2], state[3], state[4], state[5], state[6], state[7], state[8])
    k = carried.counter[0]
    mask = history.size - 1
    largest_change = plant.rack_rate_limit_per_s * step_s
    for j in range(traces.limited.size):
        propeller = (propeller_noise[j], 0.5 * (propeller_noise[j] + propeller_noise[j + 1]), propeller_noise[j + 1])
        engine = (engine_noise[j], 0.5 * (engine_noise[j] + engine_noise[j + 1]), engine_noise[j + 1])
        demands = (demand[2 * j], demand[2 * j + 1], demand[2 * j + 2])
        blades = (pitch[2 * j], pitch[2 * j + 1], pitch[2 * j + 2])
        geared = (machine[2 * j], machine[2 * j + 1], machine[2 * j + 2])
        if plant.delay_exponent == 0.0:
            past = (
                _past(history, mask, k + delay.first[0], delay.weights[0]),
                _past(history, mask, k + delay.first[1], delay.weights[1]),
                _past(history, mask, k + delay.first[2], delay.weights[2]),
            )
        else:
            # a step is so short that the speed is that of its start
            steps = delay.steps * _scheduled(plant.gear_ratio * _engine_end(x, plant), plant.delay_exponent, plant)
            past = (
                _past_at(history, mask, k, -steps),
                _past_at(history, mask, k, 0.5 - steps),
                _past_at(history, mask, k, 1.0 - steps),
            )
        air = plant.air_share + (1.0 - plant.air_share) * carried.boost[0]
        rates = derivatives(x, demands[0], past[0], propeller[0], engine[0], plant, air, blades[0], geared[0])
        # the limiter of the rate keeps no state of its own: it starts from the rack that it gave last
        last = history[(k - 1) & mask]
        rack_given = min(max(rates[5], last - largest_change), last + largest_change)
        history[k & mask] = rack_given
        traces.shaft_speed_rev_s[j] = x[0]
        traces.shaft_angle_rev[j] = x[5]
        traces.rack_given[j] = rack_given
        traces.shaft_torque_nm[j] = rates[6]
        traces.brake_torque_nm[j] = rates[7]
        traces.limited[j] = rates[8] or rack_given != rates[5]
        traces.ship_speed_m_s[j] = x[6]
        traces.engine_speed_rev_s[j] = _engine_end(x, plant)
        traces.engine_angle_rev[j] = x[5] + x[8]
        if plant.air_share < 1.0:
            _, full_load = torque_limits(plant.gear_ratio * _engine_end(x, plant), plant)
            carried.boost[0] += step_s / plant.turbocharger_lag_s * (rates[7] / full_load - carried.boost[0])
        x = _runge_kutta(step_s, x, rates, demands, past, propeller, engine, plant, air, blades, geared)
        k += 1
    state[0], state[1], state[2], state[3], state[4], state[5], state[6], state[7], state[8] = x
    carried.counter[0] = k
