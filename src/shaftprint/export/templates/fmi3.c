/* The interface of FMI 3.0, model exchange and co-simulation (Functional Mock-up Interface, version 3.0.2, 2024). */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "core.h"

#if defined(FMI3_FUNCTION_PREFIX) && !defined(FMI3_OVERRIDE_FUNCTION_PREFIX) && !defined(_WIN32)
#define PASTED(a, b) a##b
#define PASTE(a, b) PASTED(a, b)
#define NAMED(name) PASTE(FMI3_FUNCTION_PREFIX, name)
#else
#define NAMED(name) name
#endif
#if defined(_WIN32)
#define EXPORTED __declspec(dllexport)
#elif defined(__GNUC__)
#define EXPORTED __attribute__((visibility("default")))
#else
#define EXPORTED
#endif

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL } Status;
typedef unsigned int Reference;
typedef const char *String;
typedef void (*Logger)(void *environment, Status status, String category, String message);

typedef struct {
    Model m;
    bool co_simulation;
    Logger logger;
    void *environment;
} Instance;

static Status problem(Instance *c, Status status) {
    if (c && c->logger)
        c->logger(c->environment, status, status == FATAL ? "logStatusFatal" : "logStatusError",
                  c->m.problem ? c->m.problem : "a function was called that is not offered, or not in this mode");
    if (c) c->m.problem = NULL;
    return status;
}

/* Pass on a warning. */
static void tell(Instance *c) {
    if (c->logger && c->m.note[0]) c->logger(c->environment, WARNING, "logStatusWarning", c->m.note);
    c->m.note[0] = 0;
}

#define FMI(name) NAMED(fmi3##name)
#include "exchange.h"

EXPORTED String NAMED(fmi3GetVersion)(void) { return "3.0"; }

EXPORTED Status NAMED(fmi3SetDebugLogging)(void *c, bool on, size_t count, const String categories[]) {
    (void)c, (void)on, (void)count, (void)categories;
    return OK;
}

static Instance *instance_of(String token, void *environment, Logger logger, bool co_simulation) {
    Instance *c = calloc(1, sizeof *c);
    if (!c) return NULL;
    c->logger = logger;
    c->environment = environment;
    c->co_simulation = co_simulation;
    if (!token || strcmp(token, MODEL_TOKEN) != 0) {
        c->m.problem = "the model description belongs to another binary";
        problem(c, ERROR);
        free(c);
        return NULL;
    }
    core_reset(&c->m);
    return c;
}

EXPORTED void *NAMED(fmi3InstantiateModelExchange)(String name, String token, String resources, bool visible,
                                                   bool logging, void *environment, Logger logger) {
    (void)name, (void)resources, (void)visible, (void)logging;
    return instance_of(token, environment, logger, false);
}

EXPORTED void *NAMED(fmi3InstantiateCoSimulation)(String name, String token, String resources, bool visible,
                                                  bool logging, bool event_mode, bool early_return,
                                                  const Reference intermediate[], size_t intermediates,
                                                  void *environment, Logger logger, void (*update)(void)) {
    (void)name, (void)resources, (void)visible, (void)logging, (void)event_mode, (void)early_return;
    (void)intermediate, (void)intermediates, (void)update;
    return instance_of(token, environment, logger, true);
}

EXPORTED void *NAMED(fmi3InstantiateScheduledExecution)(String name, String token, String resources, bool visible,
                                                        bool logging, void *environment, Logger logger,
                                                        void (*update)(void), void (*lock)(void),
                                                        void (*unlock)(void)) {
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)logger;
    (void)update, (void)lock, (void)unlock;
    return NULL;
}

EXPORTED void NAMED(fmi3FreeInstance)(void *instance) {
    Instance *c = instance;
    if (!c) return;
    free(c->m.node);
    free(c->m.segment);
    free(c);
}

EXPORTED Status NAMED(fmi3EnterInitializationMode)(void *instance, bool tolerance_defined, double tolerance,
                                                   double start, bool stop_defined, double stop) {
    Instance *c = instance;
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    if (c->m.f.mode != INSTANTIATED || !isfinite(start)) return problem(c, ERROR);
    c->m.f.start_time = c->m.f.time = start;
    c->m.f.stale = 1;
    c->m.f.mode = INITIALISING;
    return OK;
}

EXPORTED Status NAMED(fmi3ExitInitializationMode)(void *instance) {
    Instance *c = instance;
    if (c->m.f.mode != INITIALISING || !core_ready(&c->m)) return problem(c, ERROR);
    c->m.f.mode = c->co_simulation ? STEPPING : EVENTS;
    core_warn_of_start(&c->m);
    return ended(c, 1);
}

EXPORTED Status NAMED(fmi3Terminate)(void *instance) {
    ((Instance *)instance)->m.f.mode = TERMINATED;
    return OK;
}

EXPORTED Status NAMED(fmi3Reset)(void *instance) {
    core_reset(&((Instance *)instance)->m);
    return OK;
}

EXPORTED Status NAMED(fmi3GetFloat64)(void *instance, const Reference which[], size_t count, double values[],
                                      size_t length) {
    Instance *c = instance;
    if (length != count) return problem(c, ERROR);
    for (size_t i = 0; i < count; i++)
        if (!core_get(&c->m, which[i], &values[i])) return problem(c, ERROR);
    return OK;
}

EXPORTED Status NAMED(fmi3SetFloat64)(void *instance, const Reference which[], size_t count, const double values[],
                                      size_t length) {
    Instance *c = instance;
    if (length != count) return problem(c, ERROR);
    for (size_t i = 0; i < count; i++)
        if (which[i] == VR_POSTERIOR_SAMPLE || !core_set(&c->m, which[i], values[i])) return problem(c, ERROR);
    return OK;
}

EXPORTED Status NAMED(fmi3GetInt32)(void *instance, const Reference which[], size_t count, int32_t values[],
                                    size_t length) {
    Instance *c = instance;
    if (length != count) return problem(c, ERROR);
    for (size_t i = 0; i < count; i++) {
        double value = 0.0;
        if (which[i] != VR_POSTERIOR_SAMPLE || !core_get(&c->m, which[i], &value)) return problem(c, ERROR);
        values[i] = (int32_t)value;
    }
    return OK;
}

EXPORTED Status NAMED(fmi3SetInt32)(void *instance, const Reference which[], size_t count, const int32_t values[],
                                    size_t length) {
    Instance *c = instance;
    if (length != count) return problem(c, ERROR);
    for (size_t i = 0; i < count; i++)
        if (which[i] != VR_POSTERIOR_SAMPLE || !core_set(&c->m, which[i], values[i])) return problem(c, ERROR);
    return OK;
}

/* There are no variables of other types, and no clocks. */
#define NONE_OF(name, type)                                                                                            \
    EXPORTED Status NAMED(name)(void *instance, const Reference which[], size_t count, type values[], size_t length) { \
        (void)which, (void)values, (void)length;                                                                       \
        return count ? problem(instance, ERROR) : OK;                                                                  \
    }
NONE_OF(fmi3GetFloat32, float)
NONE_OF(fmi3GetInt8, int8_t)
NONE_OF(fmi3GetUInt8, uint8_t)
NONE_OF(fmi3GetInt16, int16_t)
NONE_OF(fmi3GetUInt16, uint16_t)
NONE_OF(fmi3GetUInt32, uint32_t)
NONE_OF(fmi3GetInt64, int64_t)
NONE_OF(fmi3GetUInt64, uint64_t)
NONE_OF(fmi3GetBoolean, bool)
NONE_OF(fmi3GetString, String)
NONE_OF(fmi3SetFloat32, const float)
NONE_OF(fmi3SetInt8, const int8_t)
NONE_OF(fmi3SetUInt8, const uint8_t)
NONE_OF(fmi3SetInt16, const int16_t)
NONE_OF(fmi3SetUInt16, const uint16_t)
NONE_OF(fmi3SetUInt32, const uint32_t)
NONE_OF(fmi3SetInt64, const int64_t)
NONE_OF(fmi3SetUInt64, const uint64_t)
NONE_OF(fmi3SetBoolean, const bool)
NONE_OF(fmi3SetString, const String)

#define NOT_OFFERED(name, ...)                                          \
    EXPORTED Status NAMED(name)(void *instance, __VA_ARGS__) { return problem(instance, ERROR); }

EXPORTED Status NAMED(fmi3GetFMUState)(void *instance, void **state) {
    Snapshot *taken = snapshot_take(&((Instance *)instance)->m, *state);
    if (!taken) return problem(instance, FATAL);
    *state = taken;
    return OK;
}

EXPORTED Status NAMED(fmi3SetFMUState)(void *instance, void *state) {
    if (!state) return problem(instance, ERROR);
    return snapshot_restore(&((Instance *)instance)->m, state) ? OK : problem(instance, FATAL);
}

EXPORTED Status NAMED(fmi3FreeFMUState)(void *instance, void **state) {
    (void)instance;
    if (state) {
        snapshot_free(*state);
        *state = NULL;
    }
    return OK;
}

EXPORTED Status NAMED(fmi3SerializedFMUStateSize)(void *instance, void *state, size_t *size) {
    if (!state) return problem(instance, ERROR);
    *size = snapshot_size(state);
    return OK;
}

EXPORTED Status NAMED(fmi3SerializeFMUState)(void *instance, void *state, uint8_t bytes[], size_t size) {
    if (!state || size < snapshot_size(state)) return problem(instance, ERROR);
    snapshot_write(state, (char *)bytes);
    return OK;
}

EXPORTED Status NAMED(fmi3DeserializeFMUState)(void *instance, const uint8_t bytes[], size_t size, void **state) {
    Snapshot *found = snapshot_read((const char *)bytes, size);
    if (!found) return problem(instance, ERROR);
    snapshot_free(*state);
    *state = found;
    return OK;
}

/* ---- events and model exchange ---- */

EXPORTED Status NAMED(fmi3EnterEventMode)(void *instance) {
    Instance *c = instance;
    if (c->co_simulation) return problem(c, ERROR);
    c->m.f.mode = EVENTS;
    return ended(c, core_enter_event(&c->m));
}

EXPORTED Status NAMED(fmi3UpdateDiscreteStates)(void *instance, bool *more, bool *terminate, bool *nominals_changed,
                                                bool *states_changed, bool *next_defined, double *next_time) {
    Instance *c = instance;
    *more = *terminate = *nominals_changed = *states_changed = *next_defined = false;
    *next_time = 0.0;
    if (c->co_simulation || !core_event(&c->m)) return problem(c, ERROR);
    if (c->m.f.next_event < HUGE_VAL) {
        *next_defined = true;
        *next_time = c->m.f.next_event;
    }
    return OK;
}

EXPORTED Status NAMED(fmi3CompletedIntegratorStep)(void *instance, bool no_return, bool *enter_event,
                                                   bool *terminate) {
    Instance *c = instance;
    int wants_event = 0;
    (void)no_return;
    const int good = core_completed_step(&c->m, &wants_event);
    *enter_event = wants_event;
    *terminate = false;
    return ended(c, good);
}

EXPORTED Status NAMED(fmi3GetContinuousStateDerivatives)(void *instance, double rates[], size_t count) {
    Instance *c = instance;
    if (count != STATES || !core_ready(&c->m)) return problem(c, ERROR);
    core_derivatives(&c->m, rates);
    return ended(c, 1);
}

EXPORTED Status NAMED(fmi3GetNumberOfEventIndicators)(void *instance, size_t *count) {
    (void)instance;
    *count = INDICATORS;
    return OK;
}

EXPORTED Status NAMED(fmi3GetNumberOfContinuousStates)(void *instance, size_t *count) {
    (void)instance;
    *count = STATES;
    return OK;
}

/* ---- co-simulation ---- */

EXPORTED Status NAMED(fmi3DoStep)(void *instance, double time, double duration, bool no_return, bool *event,
                                  bool *terminate, bool *early, double *reached) {
    Instance *c = instance;
    (void)no_return;
    *event = *terminate = *early = false;
    *reached = c->m.f.time;
    if (c->m.f.mode != STEPPING) return problem(c, ERROR);
    if (!(duration > 0.0) || !(fabs(time - c->m.f.time) <= 1e-6 * duration + 10.0 * tiny(time))) {
        c->m.problem = "a step was asked for that does not begin where the last one ended, or goes nowhere";
        return problem(c, ERROR);
    }
    const int good = core_do_step(&c->m, time + duration - c->m.f.time);
    *reached = c->m.f.time;
    return ended(c, good);
}

/* ---- what this model has no use for ---- */

typedef const Reference *References;
typedef const double *Numbers;

NOT_OFFERED(fmi3GetBinary, References a, size_t b, size_t *c, const uint8_t **d, size_t e)
NOT_OFFERED(fmi3SetBinary, References a, size_t b, const size_t *c, const uint8_t *const *d, size_t e)
NOT_OFFERED(fmi3GetClock, References a, size_t b, bool *c)
NOT_OFFERED(fmi3SetClock, References a, size_t b, const bool *c)
NOT_OFFERED(fmi3GetNumberOfVariableDependencies, Reference a, size_t *b)
NOT_OFFERED(fmi3GetVariableDependencies, Reference a, size_t *b, Reference *c, size_t *d, int *e, size_t f)
NOT_OFFERED(fmi3GetDirectionalDerivative, References a, size_t b, References c, size_t d, Numbers e, size_t f, double *g,
            size_t h)
NOT_OFFERED(fmi3GetAdjointDerivative, References a, size_t b, References c, size_t d, Numbers e, size_t f, double *g,
            size_t h)
NOT_OFFERED(fmi3GetIntervalDecimal, References a, size_t b, double *c, int *d)
NOT_OFFERED(fmi3GetIntervalFraction, References a, size_t b, uint64_t *c, uint64_t *d, int *e)
NOT_OFFERED(fmi3GetShiftDecimal, References a, size_t b, double *c)
NOT_OFFERED(fmi3GetShiftFraction, References a, size_t b, uint64_t *c, uint64_t *d)
NOT_OFFERED(fmi3SetIntervalDecimal, References a, size_t b, Numbers c)
NOT_OFFERED(fmi3SetIntervalFraction, References a, size_t b, const uint64_t *c, const uint64_t *d)
NOT_OFFERED(fmi3SetShiftDecimal, References a, size_t b, Numbers c)
NOT_OFFERED(fmi3SetShiftFraction, References a, size_t b, const uint64_t *c, const uint64_t *d)
NOT_OFFERED(fmi3GetOutputDerivatives, References a, size_t b, const int32_t *c, double *d, size_t e)
NOT_OFFERED(fmi3ActivateModelPartition, Reference a, double b)

EXPORTED Status NAMED(fmi3EnterConfigurationMode)(void *instance) { return problem(instance, ERROR); }

EXPORTED Status NAMED(fmi3ExitConfigurationMode)(void *instance) { return problem(instance, ERROR); }

EXPORTED Status NAMED(fmi3EvaluateDiscreteStates)(void *instance) { return problem(instance, ERROR); }

EXPORTED Status NAMED(fmi3EnterStepMode)(void *instance) { return problem(instance, ERROR); }
