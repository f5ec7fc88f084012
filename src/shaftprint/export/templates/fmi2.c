/* The interface of FMI 2.0, model exchange and co-simulation (Functional Mock-up Interface, version 2.0.4, 2022). */
#include <math.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include "core.h"

#if defined(FMI2_FUNCTION_PREFIX)
#define PASTED(a, b) a##b
#define PASTE(a, b) PASTED(a, b)
#define NAMED(name) PASTE(FMI2_FUNCTION_PREFIX, name)
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

typedef enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING } Status;
typedef enum { MODEL_EXCHANGE, CO_SIMULATION } Kind;
typedef unsigned int Reference;
typedef const char *String;
typedef void (*Logger)(void *environment, String instance, Status status, String category, String message, ...);

typedef struct {
    Logger logger;
    void *(*allocate)(size_t count, size_t size);
    void (*free)(void *object);
    void (*finished)(void *environment, Status status);
    void *environment;
} Callbacks;

typedef struct {
    int more, terminate, nominals_changed, states_changed, next_defined;
    double next_time;
} EventInfo;

typedef struct {
    Model m;
    Kind kind;
    Logger logger;
    void *environment;
    char *name;
} Instance;

static Status problem(Instance *c, Status status) {
    if (c->logger)
        c->logger(c->environment, c->name, status, status == FATAL ? "logStatusFatal" : "logStatusError", "%s.",
                  c->m.problem ? c->m.problem : "a function was called that is not offered, or not in this mode");
    c->m.problem = NULL;
    return status;
}

/* Pass on a warning. */
static void tell(Instance *c) {
    if (c->logger && c->m.note[0])
        c->logger(c->environment, c->name, WARNING, "logStatusWarning", "%s.", c->m.note);
    c->m.note[0] = 0;
}

#define FMI(name) NAMED(fmi2##name)
#include "exchange.h"

EXPORTED String NAMED(fmi2GetTypesPlatform)(void) { return "default"; }

EXPORTED String NAMED(fmi2GetVersion)(void) { return "2.0"; }

EXPORTED Status NAMED(fmi2SetDebugLogging)(void *c, int on, size_t count, const String categories[]) {
    (void)c, (void)on, (void)count, (void)categories;
    return OK;
}

EXPORTED void *NAMED(fmi2Instantiate)(String name, Kind kind, String token, String resources, const Callbacks *callbacks,
                                      int visible, int logging) {
    (void)resources, (void)visible, (void)logging;
    Instance *c = calloc(1, sizeof *c);
    if (!c) return NULL;
    c->kind = kind;
    c->logger = callbacks ? callbacks->logger : NULL;
    c->environment = callbacks ? callbacks->environment : NULL;
    c->name = calloc(1, strlen(name ? name : "") + 1);
    if (c->name && name) strcpy(c->name, name);
    if (!c->name || !token || strcmp(token, MODEL_TOKEN) != 0) {
        c->m.problem = "the model description belongs to another binary";
        problem(c, ERROR);
        free(c->name);
        free(c);
        return NULL;
    }
    core_reset(&c->m);
    return c;
}

EXPORTED void NAMED(fmi2FreeInstance)(void *instance) {
    Instance *c = instance;
    if (!c) return;
    free(c->m.node);
    free(c->m.segment);
    free(c->name);
    free(c);
}

EXPORTED Status NAMED(fmi2SetupExperiment)(void *instance, int tolerance_defined, double tolerance, double start,
                                           int stop_defined, double stop) {
    Instance *c = instance;
    (void)tolerance_defined, (void)tolerance, (void)stop_defined, (void)stop;
    if (c->m.f.mode != INSTANTIATED || !isfinite(start)) return problem(c, ERROR);
    c->m.f.start_time = c->m.f.time = start;
    c->m.f.stale = 1;
    return OK;
}

EXPORTED Status NAMED(fmi2EnterInitializationMode)(void *instance) {
    Instance *c = instance;
    if (c->m.f.mode != INSTANTIATED) return problem(c, ERROR);
    c->m.f.mode = INITIALISING;
    return OK;
}

EXPORTED Status NAMED(fmi2ExitInitializationMode)(void *instance) {
    Instance *c = instance;
    if (c->m.f.mode != INITIALISING || !core_ready(&c->m)) return problem(c, ERROR);
    c->m.f.mode = c->kind == CO_SIMULATION ? STEPPING : EVENTS;
    core_warn_of_start(&c->m);
    return ended(c, 1);
}

EXPORTED Status NAMED(fmi2Terminate)(void *instance) {
    ((Instance *)instance)->m.f.mode = TERMINATED;
    return OK;
}

EXPORTED Status NAMED(fmi2Reset)(void *instance) {
    core_reset(&((Instance *)instance)->m);
    return OK;
}

EXPORTED Status NAMED(fmi2GetReal)(void *instance, const Reference which[], size_t count, double values[]) {
    Instance *c = instance;
    for (size_t i = 0; i < count; i++)
        if (!core_get(&c->m, which[i], &values[i])) return problem(c, ERROR);
    return OK;
}

EXPORTED Status NAMED(fmi2SetReal)(void *instance, const Reference which[], size_t count, const double values[]) {
    Instance *c = instance;
    for (size_t i = 0; i < count; i++)
        if (which[i] == VR_POSTERIOR_SAMPLE || !core_set(&c->m, which[i], values[i])) return problem(c, ERROR);
    return OK;
}

EXPORTED Status NAMED(fmi2GetInteger)(void *instance, const Reference which[], size_t count, int values[]) {
    Instance *c = instance;
    for (size_t i = 0; i < count; i++) {
        double value = 0.0;
        if (which[i] != VR_POSTERIOR_SAMPLE || !core_get(&c->m, which[i], &value)) return problem(c, ERROR);
        values[i] = (int)value;
    }
    return OK;
}

EXPORTED Status NAMED(fmi2SetInteger)(void *instance, const Reference which[], size_t count, const int values[]) {
    Instance *c = instance;
    for (size_t i = 0; i < count; i++)
        if (which[i] != VR_POSTERIOR_SAMPLE || !core_set(&c->m, which[i], values[i])) return problem(c, ERROR);
    return OK;
}

/* There are no variables of other types. */
#define NONE_OF(name, type)                                                                            \
    EXPORTED Status NAMED(name)(void *instance, const Reference which[], size_t count, type values[]) { \
        (void)which, (void)values;                                                                     \
        return count ? problem(instance, ERROR) : OK;                                                  \
    }
NONE_OF(fmi2GetBoolean, int)
NONE_OF(fmi2SetBoolean, const int)
NONE_OF(fmi2GetString, String)
NONE_OF(fmi2SetString, const String)

EXPORTED Status NAMED(fmi2GetFMUstate)(void *instance, void **state) {
    Snapshot *taken = snapshot_take(&((Instance *)instance)->m, *state);
    if (!taken) return problem(instance, FATAL);
    *state = taken;
    return OK;
}

EXPORTED Status NAMED(fmi2SetFMUstate)(void *instance, void *state) {
    if (!state) return problem(instance, ERROR);
    return snapshot_restore(&((Instance *)instance)->m, state) ? OK : problem(instance, FATAL);
}

EXPORTED Status NAMED(fmi2FreeFMUstate)(void *instance, void **state) {
    (void)instance;
    if (state) {
        snapshot_free(*state);
        *state = NULL;
    }
    return OK;
}

EXPORTED Status NAMED(fmi2SerializedFMUstateSize)(void *instance, void *state, size_t *size) {
    if (!state) return problem(instance, ERROR);
    *size = snapshot_size(state);
    return OK;
}

EXPORTED Status NAMED(fmi2SerializeFMUstate)(void *instance, void *state, char bytes[], size_t size) {
    if (!state || size < snapshot_size(state)) return problem(instance, ERROR);
    snapshot_write(state, bytes);
    return OK;
}

EXPORTED Status NAMED(fmi2DeSerializeFMUstate)(void *instance, const char bytes[], size_t size, void **state) {
    Snapshot *found = snapshot_read(bytes, size);
    if (!found) return problem(instance, ERROR);
    snapshot_free(*state);
    *state = found;
    return OK;
}

EXPORTED Status NAMED(fmi2GetDirectionalDerivative)(void *instance, const Reference unknown[], size_t unknowns,
                                                    const Reference known[], size_t knowns, const double change[],
                                                    double found[]) {
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)change, (void)found;
    return problem(instance, ERROR);
}

/* ---- model exchange ---- */

EXPORTED Status NAMED(fmi2EnterEventMode)(void *instance) {
    Instance *c = instance;
    c->m.f.mode = EVENTS;
    return ended(c, core_enter_event(&c->m));
}

EXPORTED Status NAMED(fmi2NewDiscreteStates)(void *instance, EventInfo *info) {
    Instance *c = instance;
    memset(info, 0, sizeof *info);
    if (!core_event(&c->m)) return problem(c, ERROR);
    info->next_defined = c->m.f.next_event < HUGE_VAL;
    info->next_time = info->next_defined ? c->m.f.next_event : 0.0;
    return OK;
}

EXPORTED Status NAMED(fmi2CompletedIntegratorStep)(void *instance, int no_return, int *enter_event, int *terminate) {
    Instance *c = instance;
    (void)no_return;
    *enter_event = *terminate = 0;
    return ended(c, core_completed_step(&c->m, enter_event));
}

EXPORTED Status NAMED(fmi2GetDerivatives)(void *instance, double rates[], size_t count) {
    Instance *c = instance;
    if (count != STATES || !core_ready(&c->m)) return problem(c, ERROR);
    core_derivatives(&c->m, rates);
    return ended(c, 1);
}

/* ---- co-simulation ---- */

EXPORTED Status NAMED(fmi2SetRealInputDerivatives)(void *instance, const Reference which[], size_t count,
                                                   const int order[], const double values[]) {
    Instance *c = instance;
    for (size_t i = 0; i < count; i++)
        if (order[i] == 1 && !core_set_rate(&c->m, which[i], values[i])) return problem(c, ERROR);
    return OK;
}

EXPORTED Status NAMED(fmi2GetRealOutputDerivatives)(void *instance, const Reference which[], size_t count,
                                                    const int order[], double values[]) {
    (void)which, (void)order, (void)values;
    return count ? problem(instance, ERROR) : OK;
}

EXPORTED Status NAMED(fmi2DoStep)(void *instance, double time, double duration, int no_return) {
    Instance *c = instance;
    (void)no_return;
    if (c->m.f.mode != STEPPING) return problem(c, ERROR);
    if (!(duration > 0.0) || !(fabs(time - c->m.f.time) <= 1e-6 * duration + 10.0 * tiny(time))) {
        c->m.problem = "a step was asked for that does not begin where the last one ended, or goes nowhere";
        return problem(c, ERROR);
    }
    return ended(c, core_do_step(&c->m, time + duration - c->m.f.time));
}

EXPORTED Status NAMED(fmi2CancelStep)(void *instance) { return problem(instance, ERROR); }

#define NO_STATUS(name, type)                                              \
    EXPORTED Status NAMED(name)(void *instance, int kind, type *value) { \
        (void)instance, (void)kind, (void)value;                         \
        return DISCARD;                                                  \
    }
NO_STATUS(fmi2GetStatus, Status)
NO_STATUS(fmi2GetIntegerStatus, int)
NO_STATUS(fmi2GetStringStatus, String)

EXPORTED Status NAMED(fmi2GetRealStatus)(void *instance, int kind, double *value) {
    if (kind != 2) return DISCARD;
    *value = ((Instance *)instance)->m.f.time;
    return OK;
}

EXPORTED Status NAMED(fmi2GetBooleanStatus)(void *instance, int kind, int *value) {
    (void)instance;
    if (kind != 3) return DISCARD;
    *value = 0;
    return OK;
}
