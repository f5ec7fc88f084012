/* Values of the model's variables by their references, in the units of the model description. */
#include <math.h>

#include "core.h"

#define WITHIN(reference, first, count) ((reference) >= (first) && (reference) < (first) + (count))

static int set_setting(Model *m, int setting, double value) {
    Fixed *f = &m->f;
    if (setting == INTERNAL_STEP) {
        if (!(value > 0.0)) return core_failed(m, "the internal step must be above 0 s");
        if (f->mode > INITIALISING) return core_failed(m, "the internal step cannot be changed during the run");
    } else if (value == 0.0) {
        return core_failed(m, "a value of the working point must not be zero");
    }
    /* an input that nobody has set yet stays at the working point */
    for (int i = 0; i < INPUTS; i++)
        if (f->mode == INSTANTIATED && model_input_scale[i] == setting && f->inputs[i] == f->settings[setting])
            f->inputs[i] = value;
    f->settings[setting] = value;
    return 1;
}

/* Set a variable; 0 if it is not to be set, or to no such value. */
int core_set(Model *m, unsigned int reference, double value) {
    Fixed *f = &m->f;
    if (!isfinite(value)) return core_failed(m, "a value that is no finite number was given");
    if (WITHIN(reference, VR_INPUT, INPUTS)) {
        f->inputs[reference - VR_INPUT] = value;
        f->input_rates[reference - VR_INPUT] = 0.0;
        f->stale = 1;
        return 1;
    }
    if (WITHIN(reference, VR_SETTING, SETTINGS)) {
        if (!set_setting(m, (int)(reference - VR_SETTING), value)) return 0;
    } else if (WITHIN(reference, VR_PARAMETER, PARAMETERS)) {
        f->given[reference - VR_PARAMETER] = value;
    } else if (reference == VR_POSTERIOR_SAMPLE && DRAWS > 0) {
        if (f->mode > INITIALISING) return core_failed(m, "the posterior sample cannot be changed during the run");
        if (value < 0.0 || value > DRAWS) return core_failed(m, "there is no posterior sample of that number");
        f->posterior_sample = (int)value;
    } else {
        return core_failed(m, "a variable that is not there, or not to be set, was set");
    }
    f->stale = f->changed = 1;
    return 1;
}

/* Say how fast an input changes from now on, in its own unit per second. */
int core_set_rate(Model *m, unsigned int reference, double value) {
    if (!WITHIN(reference, VR_INPUT, INPUTS) || !isfinite(value))
        return core_failed(m, "the change of a variable that is no input, or one that is no finite number, was given");
    m->f.input_rates[reference - VR_INPUT] = value;
    return 1;
}

static void all_outputs(Model *m, double *outputs) {
    core_evaluate(m, m->f.time);
    model_outputs(&m->f.v, outputs);
}

/* Read a variable; 0 if it is not there. */
int core_get(Model *m, unsigned int reference, double *value) {
    Fixed *f = &m->f;
    double found[OUTPUTS + STATES + INDICATORS + 1];
    *value = 0.0;
    if (reference == VR_TIME) *value = f->time;
    else if (WITHIN(reference, VR_INPUT, INPUTS)) *value = f->inputs[reference - VR_INPUT];
    else if (WITHIN(reference, VR_SETTING, SETTINGS)) *value = f->settings[reference - VR_SETTING];
    else if (WITHIN(reference, VR_PARAMETER, PARAMETERS)) *value = f->given[reference - VR_PARAMETER];
    else if (reference == VR_POSTERIOR_SAMPLE && DRAWS > 0) *value = f->posterior_sample;
    else if (!core_ready(m)) return 0;
    else if (WITHIN(reference, VR_OUTPUT, OUTPUTS)) {
        const int i = (int)(reference - VR_OUTPUT);
        all_outputs(m, found);
        *value = (found[i] + model_output_offset[i]) * core_scale(f, model_output_scale[i]);
    } else if (WITHIN(reference, VR_STATE, STATES)) {
        *value = f->v.x[reference - VR_STATE];
    } else if (WITHIN(reference, VR_DERIVATIVE, STATES)) {
        core_derivatives(m, found);
        *value = found[reference - VR_DERIVATIVE];
    } else if (WITHIN(reference, VR_INDICATOR, INDICATORS)) {
        core_indicators(m, found);
        *value = found[reference - VR_INDICATOR];
    } else if (WITHIN(reference, VR_LATENESS, OUTPUTS)) {
        model_lateness(&f->v, found);
        *value = found[reference - VR_LATENESS];
    } else if (reference == VR_STEP) {
        *value = f->step;
    } else {
        return core_failed(m, "a variable that is not there was read");
    }
    return 1;
}
