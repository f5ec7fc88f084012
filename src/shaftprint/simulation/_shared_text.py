"""Source text of what every kernel on a uniform grid does: inputs, delays and their derivatives between two steps.

It stands apart from the equations of a program so that it is compiled once, and not with each structure, which takes
half of the time. Counts and places of a program come in the list ``at``; as they are known where a kernel is made, and
all of this is written into it there, it is as fast as if it stood there.
"""

import re

from shaftprint.simulation._equation_text import FADED, LANES

AT = (
    "STATES", "LATES", "VARYING", "INPUT_0", "INPUT_RATE_0", "PAST_RATE_0", "RESULT_0", "LATE_0", "LATE_RATE_0",
    "DELAY_0", "BEFORE_0",
)  # fmt: skip
"""What stands in the list ``at``, by the names that a kernel's text has for it."""

SHARED = f'''"""What compiled equations share; written by shaftprint, and written anew when it is missing."""

import numpy as np

from shaftprint.kernels._compiled import compiled

SHARED = compiled(fastmath={{"contract"}}, forceinline=True, no_cfunc_wrapper=True)
LANES = {LANES}
FADED = {FADED!r}
{", ".join(AT)} = range({len(AT)})


@SHARED
def begin(v, history, start, h, mask, at):
    for j in range(at[INPUT_0]):
        v[j] = start[j]
    for k in range(mask + 1):
        for j in range(at[LATES]):
            history[(-k & mask) * at[LATES] + j] = start[at[INPUT_0] + j] - k * h * v[at[PAST_RATE_0] + j]


@SHARED
def begin_along(rows, w_history, slopes, h, mask, at):
    for j in range(at[INPUT_0]):
        for lane in range(LANES):
            rows[j, lane] = slopes[j * LANES + lane]
    for j in range(at[LATES]):
        for lane in range(LANES):
            later = slopes[(at[INPUT_0] + at[LATES] + j) * LANES + lane]
            rows[at[DELAY_0] + j, lane] = rows[at[DELAY_0] + at[LATES] + j, lane] = later
            signal, drift = slopes[(at[INPUT_0] + j) * LANES + lane], rows[at[PAST_RATE_0] + j, lane]
            for k in range(mask + 1):
                w_history[(-k & mask) * at[LATES] + j, lane] = signal - k * h * drift


@SHARED
def fade(v, at):
    # what fades would end among numbers so small that each takes a processor a hundred times as long
    for j in range(at[STATES]):
        if abs(v[j].real) < FADED and v[j].imag == 0.0:
            v[j] = 0.0


@SHARED
def fade_along(rows, at):
    for j in range(at[STATES]):
        for lane in range(LANES):
            if abs(rows[j, lane]) < FADED:
                rows[j, lane] = 0.0


@SHARED
def take(v, base, rise, u, i, goes_on, held, per, h, at):
    for j in range(base.size):
        base[j] = u[i, j]
        if goes_on:
            rise[j] = 0.0 if held else (u[i + 1, j] - u[i, j]) / per
            v[at[INPUT_RATE_0] + j] = rise[j] / h


@SHARED
def ramp(v, base, rise, sub, at):
    for j in range(base.size):
        v[at[INPUT_0] + j] = base[j] + sub * rise[j]


@SHARED
def remember(history, v, place, at):
    for j in range(at[LATES]):
        history[place * at[LATES] + j] = v[at[RESULT_0] + j]


@SHARED
def remember_along(w_history, rows, place, at):
    for j in range(at[LATES]):
        for lane in range(LANES):
            w_history[place * at[LATES] + j, lane] = rows[at[RESULT_0] + j, lane]


@SHARED
def write(y, v, record, at):
    for j in range(y.shape[1]):
        y[record, j] = v[at[RESULT_0] + j]


@SHARED
def write_along(y_slopes, rows, record, at):
    for j in range(y_slopes.shape[1]):
        for lane in range(LANES):
            y_slopes[record, j, lane] = rows[at[RESULT_0] + j, lane]


@SHARED
def weigh(x, h, weight, change, bend):
    # Lagrange's weights of nodes 0, 1, 2, 3 at a place: of the value, its change and the change of that
    a, b, c, d = x, x - 1.0, x - 2.0, x - 3.0
    weight[0], weight[1], weight[2], weight[3] = -b * c * d / 6.0, a * c * d / 2.0, -a * b * d / 2.0, a * b * c / 6.0
    change[0] = -(c * d + b * d + b * c) / (6.0 * h)
    change[1] = (c * d + a * d + a * c) / (2.0 * h)
    change[2] = -(b * d + a * d + a * b) / (2.0 * h)
    change[3] = (b * c + a * c + a * b) / (6.0 * h)
    bend[0], bend[1] = -(b + c + d) / (3.0 * h * h), (a + c + d) / (h * h)
    bend[2], bend[3] = -(a + b + d) / (h * h), (a + b + c) / (3.0 * h * h)


@SHARED
def vary(v, first, weight, change, bend, varying, is_first, h, mask, at):
    # the delay goes straight on from the last node and this one
    for n in range(at[VARYING]):
        j, now = varying[n], v[at[RESULT_0] + n]
        if is_first:
            v[at[BEFORE_0] + n] = now
        for t in range(2):
            ahead = 0.5 * (t + 1)
            place = ahead - (now + ahead * (now - v[at[BEFORE_0] + n])) / h
            node = max(min(int(np.floor(place.real)) - 1, -3), 1 - mask)
            first[j, t] = node
            # what is older than all that is kept stays as the oldest
            far = place - node if place.real > node else 0.0 * place
            weigh(far, h, weight[j, t], change[j, t], bend[j, t])
        v[at[BEFORE_0] + n] = now


@SHARED
def vary_along(rows, varying, is_first, at):
    for n in range(at[VARYING]):
        j = varying[n]
        for lane in range(LANES):
            w_now = rows[at[RESULT_0] + n, lane]
            if is_first:
                rows[at[BEFORE_0] + n, lane] = w_now
            grown = w_now - rows[at[BEFORE_0] + n, lane]
            rows[at[DELAY_0] + j, lane] = w_now + 0.5 * grown
            rows[at[DELAY_0] + at[LATES] + j, lane] = w_now + grown
            rows[at[BEFORE_0] + n, lane] = w_now


@SHARED
def nodes(node, mask, lates, j):
    # where a late signal of four nodes in a row stands
    i_0, i_1 = (node & mask) * lates + j, ((node + 1) & mask) * lates + j
    return i_0, i_1, ((node + 2) & mask) * lates + j, ((node + 3) & mask) * lates + j


@SHARED
def look_back(v, history, first, weight, change, k, mask, at):
    for j in range(at[LATES]):
        for t in range(2):
            own = t * at[LATES] + j
            i_0, i_1, i_2, i_3 = nodes(k + first[j, t], mask, at[LATES], j)
            h_0, h_1, h_2, h_3 = history[i_0], history[i_1], history[i_2], history[i_3]
            g_0, g_1, g_2, g_3 = weight[j, t, 0], weight[j, t, 1], weight[j, t, 2], weight[j, t, 3]
            c_0, c_1, c_2, c_3 = change[j, t, 0], change[j, t, 1], change[j, t, 2], change[j, t, 3]
            v[at[LATE_0] + own] = g_0 * h_0 + g_1 * h_1 + g_2 * h_2 + g_3 * h_3
            v[at[LATE_RATE_0] + own] = c_0 * h_0 + c_1 * h_1 + c_2 * h_2 + c_3 * h_3


@SHARED
def look_back_along(rows, w_history, v, first, weight, k, mask, at):
    for j in range(at[LATES]):
        for t in range(2):
            own = t * at[LATES] + j
            i_0, i_1, i_2, i_3 = nodes(k + first[j, t], mask, at[LATES], j)
            g_0, g_1, g_2, g_3 = weight[j, t, 0], weight[j, t, 1], weight[j, t, 2], weight[j, t, 3]
            moving = v[at[LATE_RATE_0] + own]
            for lane in range(LANES):
                s_0, s_1 = w_history[i_0, lane], w_history[i_1, lane]
                s_2, s_3 = w_history[i_2, lane], w_history[i_3, lane]
                later = rows[at[DELAY_0] + own, lane]
                rows[at[LATE_0] + own, lane] = g_0 * s_0 + g_1 * s_1 + g_2 * s_2 + g_3 * s_3 - moving * later


@SHARED
def look_back_at_changes(rows, history, w_history, first, change, bend, k, mask, at):
    for j in range(at[LATES]):
        for t in range(2):
            own = t * at[LATES] + j
            i_0, i_1, i_2, i_3 = nodes(k + first[j, t], mask, at[LATES], j)
            h_0, h_1, h_2, h_3 = history[i_0], history[i_1], history[i_2], history[i_3]
            b_0, b_1, b_2, b_3 = bend[j, t, 0], bend[j, t, 1], bend[j, t, 2], bend[j, t, 3]
            c_0, c_1, c_2, c_3 = change[j, t, 0], change[j, t, 1], change[j, t, 2], change[j, t, 3]
            bending = b_0 * h_0 + b_1 * h_1 + b_2 * h_2 + b_3 * h_3
            for lane in range(LANES):
                s_0, s_1 = w_history[i_0, lane], w_history[i_1, lane]
                s_2, s_3 = w_history[i_2, lane], w_history[i_3, lane]
                later = rows[at[DELAY_0] + own, lane]
                kept = c_0 * s_0 + c_1 * s_1 + c_2 * s_2 + c_3 * s_3
                rows[at[LATE_RATE_0] + own, lane] = kept - bending * later
'''

NAMES = tuple(re.findall(r"^def (\w+)", SHARED, re.MULTILINE))
"""The functions."""
