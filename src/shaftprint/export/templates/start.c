/* The start of a run: parameters, steady running, the step. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "core.h"

#define SHORTEST_STEP_S 1e-6
/* As a share of the working point; a ship is identified within a few per cent of it. */
#define FAR_FROM_WORKING_POINT 0.5

/* Keep what went wrong, in words, and return 0. */
int core_failed(Model *m, const char *problem) {
    m->problem = problem;
    return 0;
}

/* Keep a warning for the tool's log, the first of its kind in a run. */
void core_warn(Model *m, int kind, const char *format, ...) {
    va_list values;
    if (m->f.said & kind) return;
    m->f.said |= kind;
    va_start(values, format);
    vsnprintf(m->note, sizeof m->note, format, values);
    va_end(values);
}

/* Warn of a run that begins far from where the model was identified: some tools give 0 before the first value. */
void core_warn_of_start(Model *m) {
    Fixed *f = &m->f;
    for (int i = 0; i < INPUTS; i++)
        if (model_input_offset[i] && fabs(f->v.u[i]) > FAR_FROM_WORKING_POINT)
            core_warn(m, FAR_START,
                      "the run begins in steady running at %s = %g, far from the working point of %g; if that is not "
                      "meant, give the input its start value in your tool",
                      model_input_names[i], f->inputs[i], core_scale(f, model_input_scale[i]));
}

int core_all_finite(const double *values, int count) {
    for (int i = 0; i < count; i++)
        if (!isfinite(values[i])) return 0;
    return 1;
}

/* Keep the inputs as those that the equations have seen. */
void core_remember_inputs(Fixed *f) {
    memcpy(f->fed, f->v.u, sizeof f->fed);
    memcpy(f->fed_rates, f->v.u_rate, sizeof f->fed_rates);
}

void core_use_parameters(Model *m) {
    Fixed *f = &m->f;
    for (int i = 0; i < PARAMETERS; i++) f->v.p[i] = f->given[i] + model_draws[f->posterior_sample][i];
    model_delays(&f->v, f->delay);
    model_periods(&f->v, f->period);
    for (int j = 0; j < LATES; j++)
        if (!model_feeds[j] && f->delay[j] < 0.0) f->delay[j] = 0.0;
}

int core_use_step(Model *m) {
    Fixed *f = &m->f;
    const double longest = steady_longest_step(m);
    f->step = f->settings[INTERNAL_STEP] < longest ? f->settings[INTERNAL_STEP] : longest;
    if (!(f->step >= SHORTEST_STEP_S)) return core_failed(m, "a time constant is too short to be followed in time");
    return 1;
}

void core_reset(Model *m) {
    Fixed *f = &m->f;
    memset(f, 0, sizeof *f);
    memcpy(f->given, model_start, sizeof f->given);
    memcpy(f->settings, model_settings, sizeof f->settings);
    for (int i = 0; i < INPUTS; i++) f->inputs[i] = model_input_offset[i] * core_scale(f, model_input_scale[i]);
    f->stale = 1;
}

/* Start in steady running at the inputs. */
int core_start(Model *m) {
    Fixed *f = &m->f;
    double rates[STATES + 1], lates[LATES + 1];
    f->time = f->v.time = f->sampled = f->input_time = f->start_time;
    core_inputs(m, f->time);
    core_use_parameters(m);
    if (!steady_find(m)) return core_failed(m, "there is no steady running at these inputs and parameters");
    core_use_parameters(m);
    if (!core_all_finite(f->delay, LATES) || !core_all_finite(f->period, SAMPLES))
        return core_failed(m, "a delay or a period is no finite number");
    for (int j = 0; j < LATES; j++)
        if (f->delay[j] < 0.0) return core_failed(m, "a delay is negative");
    core_inputs(m, f->time);
    model_rates(&f->v, rates);
    model_lates(&f->v, lates);
    if (!core_all_finite(rates, STATES) || !core_all_finite(lates, LATES))
        return core_failed(m, "the equations are not finite at these parameters: a time constant may be zero");
    if (!core_use_step(m)) return 0;
    for (int k = 0; k < SAMPLES; k++) f->ticks[k] = 0.0;
    memcpy(f->held, f->v.z, sizeof f->held);
    core_remember_inputs(f);
    f->next_event = HUGE_VAL;
    if (!history_begin(m)) return core_failed(m, "there is no memory left");
    f->stale = f->changed = 0;
    return 1;
}

int core_ready(Model *m) { return m->f.stale && m->f.mode <= INITIALISING ? core_start(m) : 1; }
