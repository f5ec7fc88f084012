/* Steps, events and values of the model. */
#include <math.h>
#include <string.h>

#include "core.h"

#define JUMP 1e-9
#define SAME_INPUT 1e-12
#define STEPS_AFTER_BREAK 3
/* How closely a limit's time is found, as a share of a step. */
#define RESOLVED 1e-6
#define MOST_ROUNDS 30
/* What is a jump among an input's changes from step to step, and what is left of the largest after one. */
#define FAR_MORE 10.0
#define FORGOTTEN 0.5
/* An announced event that is passed by less does no harm [s]. */
#define LATE_EVENT_S 1e-6

/* What a deviation is multiplied by. */
double core_scale(const Fixed *f, int setting) { return setting < 0 ? 1.0 : f->settings[setting]; }

/* Give the equations their inputs as they are at a time. */
void core_inputs(Model *m, double time) {
    Fixed *f = &m->f;
    for (int i = 0; i < INPUTS; i++) {
        const double scale = core_scale(f, model_input_scale[i]);
        const double now = f->inputs[i] + f->input_rates[i] * (time - f->input_time);
        f->v.u[i] = now / scale - model_input_offset[i];
        f->v.u_rate[i] = f->input_rates[i] / scale;
    }
}

static void at(Model *m, double time, int outputs_too) {
    m->f.v.time = time;
    core_inputs(m, time);
    history_look(m, time, outputs_too);
}

/* Let inputs and pasts be those of a time. */
void core_evaluate(Model *m, double time) { at(m, time, 1); }

static double due(const Fixed *f, int sample) { return f->start_time + (f->ticks[sample] + 1.0) * f->period[sample]; }

/* Let computers without a period give what they would if the step ended now: they are continuous, whatever the step.
   One may follow another, hence as many rounds as there are. */
void core_samples_now(Model *m) {
    Fixed *f = &m->f;
    double taken[SAMPLES + 1];
    f->v.step = f->v.time - f->sampled;
    for (int round = 0; round < SAMPLES; round++)
        for (int k = 0; k < SAMPLES; k++) {
            if (f->period[k] > 0.0) continue;
            f->v.z[k] = f->held[k];
            model_values(&f->v, taken);
            f->v.z[k] = taken[k];
        }
}

/* End the step of computers without a period. */
static void keep_samples(Model *m) {
    Fixed *f = &m->f;
    memcpy(f->held, f->v.z, sizeof f->held);
    f->sampled = f->v.time;
}

/* Take the values of computers whose period is over. */
static int take_samples(Model *m) {
    Fixed *f = &m->f;
    double taken[SAMPLES + 1];
    int found = 0;
    if (!SAMPLES) return 0;
    model_values(&f->v, taken);
    for (int k = 0; k < SAMPLES; k++) {
        if (f->period[k] <= 0.0 || due(f, k) > f->v.time + tiny(f->v.time)) continue;
        f->v.z[k] = f->held[k] = taken[k];
        while (due(f, k) <= f->v.time + tiny(f->v.time)) f->ticks[k] += 1.0;
        found = 1;
    }
    return found;
}

/* Begin a segment of the history, where signals or their changes of that order are not continuous. */
static int begin_segment(Model *m, int order) {
    Fixed *f = &m->f;
    double lates[LATES + 1];
    model_lates(&f->v, lates);
    for (int j = 0; j < LATES; j++)
        if (fabs(lates[j] - m->node[f->nodes - 1].late[j]) > JUMP * (1.0 + fabs(lates[j]))) order = 0;
    if (order > HIGHEST_ORDER) return 1;
    history_forget(m);
    if (!history_add(m, order)) return core_failed(m, "there is no memory left");
    history_settle(m);
    return 1;
}

static int arrive(Model *m) {
    const int order = history_arriving_order(m);
    if (order > HIGHEST_ORDER) return 1;
    history_settle(m);
    at(m, m->f.v.time, 0);
    return begin_segment(m, order + 1);
}

static int inputs_moved(const Fixed *f) {
    for (int i = 0; i < INPUTS; i++) {
        if (fabs(f->v.u[i] - f->fed[i]) > SAME_INPUT * (1.0 + fabs(f->v.u[i]))) return 1;
        if (fabs(f->v.u_rate[i] - f->fed_rates[i]) > SAME_INPUT * (1.0 + fabs(f->v.u_rate[i]))) return 1;
    }
    return 0;
}

/* Take notice of inputs, parameters and computers that changed at the start of a step. */
static int changes(Model *m) {
    Fixed *f = &m->f;
    const int changed = f->changed;
    if (changed) {
        core_use_parameters(m);
        history_settle(m);
        f->changed = 0;
    }
    at(m, f->time, 0);
    if (changed && !core_use_step(m)) return 0;
    const int moved = inputs_moved(f);
    const int taken = take_samples(m);
    return changed || moved || taken ? begin_segment(m, 1) : 1;
}

static void add(double *x, const double *from, double h, const double *rate) {
    for (int i = 0; i < STATES; i++) x[i] = from[i] + h * rate[i];
}

/* One step of fourth order (Runge and Kutta). */
static void step(Model *m, double time, double h) {
    Values *v = &m->f.v;
    double from[STATES + 1], k1[STATES + 1], k2[STATES + 1], k3[STATES + 1], k4[STATES + 1];
    memcpy(from, v->x, sizeof from);
    at(m, time, 0);
    model_rates(v, k1);
    add(v->x, from, 0.5 * h, k1);
    at(m, time + 0.5 * h, 0);
    model_rates(v, k2);
    add(v->x, from, 0.5 * h, k2);
    model_rates(v, k3);
    add(v->x, from, h, k3);
    at(m, time + h, 0);
    model_rates(v, k4);
    for (int i = 0; i < STATES; i++) v->x[i] = from[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]);
}

static int begins_now(const Model *m) {
    return m->segment[m->f.segments - 1].time >= m->f.time - tiny(m->f.time);
}

/* Share of the last step at which the first limit began or ended to act, 1 where none did; 0 stays out of it. */
static double crossing(const double *before, const double *after) {
    double found = 1.0;
    for (int i = 0; i < INDICATORS; i++) {
        if (!(before[i] * after[i] < 0.0)) continue;
        const double share = before[i] / (before[i] - after[i]);
        if (share < found) found = share;
    }
    return found;
}

/* One step that ends where a limit begins or ends to act, should that be in it; the time at its end is returned. */
static double step_to_limit(Model *m, double time, double end) {
    double from[STATES + 1], before[INDICATORS + 1], after[INDICATORS + 1];
    double low = time, high = end;
    memcpy(from, m->f.v.x, sizeof from);
    if (INDICATORS) {
        at(m, time, 0);
        model_indicators(&m->f.v, before);
    }
    step(m, time, end - time);
    at(m, end, 0);
    if (!INDICATORS) return end;
    model_indicators(&m->f.v, after);
    for (int round = 0; round < MOST_ROUNDS && high - low > RESOLVED * (end - time); round++) {
        const double share = crossing(before, after);
        if (share >= 1.0) break;
        /* a little beyond, so that the next step begins on the other side */
        double tried = low + share * (high - low) + 0.25 * RESOLVED * (end - time);
        if (!(tried < high)) break;
        memcpy(m->f.v.x, from, sizeof from);
        step(m, time, tried - time);
        at(m, tried, 0);
        double found[INDICATORS + 1];
        model_indicators(&m->f.v, found);
        if (crossing(before, found) < 1.0) {
            high = tried;
            memcpy(after, found, sizeof after);
        } else {
            low = tried;
            memcpy(before, found, sizeof before);
        }
    }
    memcpy(m->f.v.x, from, sizeof from);
    step(m, time, high - time);
    at(m, high, 0);
    return high;
}

/* Go on to a time before which nothing jumps. */
static int advance(Model *m, double next) {
    Fixed *f = &m->f;
    while (f->time < next - tiny(next)) {
        const double length = next - f->time;
        double count = ceil(length / f->step - 1e-9);
        if (count < 1.0) count = 1.0;
        if (begins_now(m) && count < STEPS_AFTER_BREAK) count = STEPS_AFTER_BREAK;
        const double end = count > 1.0 ? f->time + length / count : next;
        const double reached = step_to_limit(m, f->time, end);
        if (!core_all_finite(f->v.x, STATES)) return core_failed(m, "the states grew beyond all numbers: the loop is unstable");
        f->time = reached;
        keep_samples(m);
        history_forget(m);
        if (!history_add(m, -1)) return core_failed(m, "there is no memory left");
        if (reached < end && !begin_segment(m, 1)) return 0;
    }
    f->time = next;
    return 1;
}

/* Advance by a duration; inputs go straight on from now with the rates that were given. */
int core_do_step(Model *m, double duration) {
    Fixed *f = &m->f;
    const double end = f->time + duration;
    if (!changes(m)) return 0;
    while (f->time < end - tiny(end)) {
        double next = end;
        const double arrival = history_next_arrival(m);
        if (arrival < next - tiny(end)) next = arrival;
        for (int k = 0; k < SAMPLES; k++)
            if (f->period[k] > 0.0 && due(f, k) < next - tiny(end)) next = due(f, k);
        if (!advance(m, next)) return 0;
        core_remember_inputs(f);
        if (!arrive(m)) return 0;
        if (next < end && !changes(m)) return 0;
    }
    f->time = end;
    for (int i = 0; i < INPUTS; i++) f->inputs[i] += f->input_rates[i] * (end - f->input_time);
    f->input_time = end;
    return 1;
}

/* Keep what a solver found at the end of its step. */
static int keep_step(Model *m) {
    at(m, m->f.time, 0);
    keep_samples(m);
    history_forget(m);
    return history_add(m, -1) ? 1 : core_failed(m, "there is no memory left");
}

static void look_for_next_event(Model *m) {
    Fixed *f = &m->f;
    f->next_event = history_next_arrival(m);
    for (int k = 0; k < SAMPLES; k++)
        if (f->period[k] > 0.0 && due(f, k) < f->next_event) f->next_event = due(f, k);
}

static void forget_seen(Fixed *f) {
    memcpy(f->seen, f->inputs, sizeof f->seen);
    f->seen_from = f->seen_to = f->time;
}

static int seen_are_given(const Fixed *f) {
    for (int i = 0; i < INPUTS; i++)
        if (fabs(f->inputs[i] - f->seen[i]) > SAME_INPUT * (fabs(f->inputs[i]) + fabs(f->seen[i]))) return 0;
    return 1;
}

/* Whether an input has jumped at the end of a step: it stood still through the solver's last rates, since the tool holds
   it, and is another now by far more than it lately moved from step to step, as samples of something smooth do. */
static int inputs_jumped(Model *m) {
    Fixed *f = &m->f;
    const int held = f->seen_to > f->seen_from + tiny(f->seen_to);
    int jumped = 0;
    for (int i = 0; i < INPUTS; i++) {
        const double by = fabs(f->inputs[i] - f->seen[i]);
        jumped |= held && by > FAR_MORE * f->moved[i] + SAME_INPUT * (fabs(f->inputs[i]) + fabs(f->seen[i]));
        f->moved[i] = by > FORGOTTEN * f->moved[i] ? by : FORGOTTEN * f->moved[i];
    }
    return jumped;
}

/* Keep a step with the inputs that it was made with; those that jumped at its end belong to what follows. */
static int keep_step_before_jump(Model *m) {
    Fixed *f = &m->f;
    double given[INPUTS + 1];
    memcpy(given, f->inputs, sizeof given);
    memcpy(f->inputs, f->seen, sizeof f->inputs);
    const int good = keep_step(m);
    memcpy(f->inputs, given, sizeof given);
    return good;
}

/* A solver's step has ended. It is asked for an event where an input has jumped or something arrives that it has not been
   told or has passed; what it has passed is served here as well, since not every tool does as it is asked. */
int core_completed_step(Model *m, int *wants_event) {
    Fixed *f = &m->f;
    const double late = f->time - f->next_event;
    const int jumped = inputs_jumped(m);
    if (!(jumped ? keep_step_before_jump(m) : keep_step(m))) return 0;
    *wants_event = jumped || f->untold || late >= -tiny(f->time);
    if (late > LATE_EVENT_S)
        core_warn(m, EVENT_PASSED,
                  "the solver passed the event announced for %g s and stopped at %g s: late signals that jump come late; "
                  "let it stop at time events, or use co-simulation",
                  f->next_event, f->time);
    if (!jumped && !(late > tiny(f->time))) return 1;
    if (!arrive(m) || !changes(m)) return 0;
    core_remember_inputs(f);
    forget_seen(f);
    look_for_next_event(m);
    f->untold = f->next_event < HUGE_VAL;
    return 1;
}

/* Keep what was before an event. */
int core_enter_event(Model *m) {
    m->f.asked = 0;
    if (m->node[m->f.nodes - 1].time >= m->f.time - tiny(m->f.time)) return 1;
    return keep_step(m);
}

/* Take notice of an event; 0 if that failed. */
int core_event(Model *m) {
    Fixed *f = &m->f;
    at(m, f->time, 0);
    const int expected = history_arriving_order(m) <= HIGHEST_ORDER;
    if (!arrive(m) || !changes(m)) return 0;
    /* an event that nothing else explains is a limit that begins or ends to act */
    if (!begin_segment(m, expected || begins_now(m) ? HIGHEST_ORDER + 1 : 1)) return 0;
    core_remember_inputs(f);
    forget_seen(f);
    look_for_next_event(m);
    f->asked = 1;
    f->untold = 0;
    return 1;
}

/* Go on to continuous time; a tool that has not asked for new discrete states is told the next event after its first
   step. */
int core_begin_continuous(Model *m) {
    if (m->f.asked) return 1;
    if (!core_event(m)) return 0;
    m->f.untold = m->f.next_event < HUGE_VAL;
    return 1;
}

void core_derivatives(Model *m, double *rates) {
    Fixed *f = &m->f;
    at(m, f->time, 0);
    model_rates(&f->v, rates);
    if (f->mode != CONTINUOUS) return;
    /* some tools ask for rates before their sources have given the inputs a value */
    if (f->time <= f->start_time + tiny(f->start_time)) core_warn_of_start(m);
    if (begins_now(m) && inputs_moved(f)) {
        /* what the solver is given now holds from there on, whatever the inputs were in the event */
        model_lates(&f->v, m->node[f->nodes - 1].late);
        core_remember_inputs(f);
    }
    if (!seen_are_given(f)) forget_seen(f);
    if (f->time < f->seen_from) f->seen_from = f->time;
    if (f->time > f->seen_to) f->seen_to = f->time;
    const double ahead = f->time - m->node[f->nodes - 1].time;
    if (ahead > f->longest_ahead)
        core_warn(m, STEP_TOO_LONG,
                  "at %g s the solver asked for rates %g s after its last completed step, longer than the shortest delay "
                  "lets late signals be known (%g s): set its largest step below that, or use co-simulation",
                  f->time, ahead, f->longest_ahead);
}

void core_indicators(Model *m, double *indicators) {
    at(m, m->f.time, 0);
    model_indicators(&m->f.v, indicators);
}
