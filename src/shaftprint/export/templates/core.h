/* The model in time: history of late signals, steady running, steps, events. The equations are in model.c. */
#ifndef CORE_H
#define CORE_H

#include <stddef.h>

#include "model.h"

/* A break of a higher derivative than this does no harm to steps and interpolation of fourth order. */
#define HIGHEST_ORDER 2

typedef enum { INSTANTIATED, INITIALISING, EVENTS, CONTINUOUS, STEPPING, TERMINATED } Mode;

/* Late signals at one time. */
typedef struct {
    double time;
    double late[LATES + 1];
} Node;

/* Nodes between two breaks, in which signals are smooth; order 0 begins with a jump, 1 with a corner. */
typedef struct {
    double time;
    long long first;
    int order;
} Segment;

/* All that a state of the model is, but for its history. */
typedef struct {
    Mode mode;
    int stale;                       /* steady running is to be found anew */
    int changed;                     /* a parameter was changed during the run */
    int posterior_sample;
    double time;
    double start_time;
    double settings[SETTINGS];       /* see model.h */
    double given[PARAMETERS + 1];    /* parameters as they were set */
    double inputs[INPUTS + 1];       /* in their own units, at input_time */
    double input_rates[INPUTS + 1];  /* in their own units per second */
    double input_time;
    double fed[INPUTS + 1];          /* inputs of the equations at the end of the last step */
    double fed_rates[INPUTS + 1];
    double step;                     /* longest step [s] */
    double delay[LATES + 1];         /* at rest where they vary [s] */
    double drift[LATES + 1];         /* how fast late signals changed before the start */
    double period[SAMPLES + 1];
    double ticks[SAMPLES + 1];       /* periods that have passed */
    double sampled;                  /* when the values of every step were taken */
    double held[SAMPLES + 1];        /* what computers took last; v.z is what they give now */
    long long segment[LATES + 1];    /* where each past stands; -1 before the start */
    /* what a solver from outside was told, and does */
    int asked;                       /* new discrete states were asked for since event mode was entered */
    int untold;                      /* there is a next event that it has not been told */
    double next_event;               /* infinite where there is none */
    double longest_ahead;            /* how far beyond its last step it may ask without harm [s] */
    double seen[INPUTS + 1];         /* inputs that it has lately asked rates for, in their own units */
    double seen_from, seen_to;       /* between these times */
    double moved[INPUTS + 1];        /* by how much they lately moved from step to step */
    int said;                        /* which warnings were given */
    Values v;
    long long dropped_nodes, dropped_segments;
    int nodes, segments;
} Fixed;

typedef struct {
    Fixed f;
    Node *node;
    Segment *segment;
    int node_room, segment_room;
    const char *problem;             /* what went wrong last, in words */
    char note[320];                  /* a warning that is to be passed on; empty where there is none */
} Model;

/* What is warned of, each once in a run. */
enum { FAR_START = 1, EVENT_PASSED = 2, STEP_TOO_LONG = 4 };

/* A copy of everything, and the way back. */
typedef struct {
    Fixed f;
    Node *node;
    Segment *segment;
} Snapshot;

/* history.c */
double tiny(double time);
int history_begin(Model *m);
int history_add(Model *m, int order);
void history_settle(Model *m);
int history_arriving_order(const Model *m);
double history_next_arrival(const Model *m);
void history_look(Model *m, double time, int outputs_too);
void history_forget(Model *m);

/* steady.c */
int steady_find(Model *m);
double steady_longest_step(Model *m);

/* start.c */
int core_failed(Model *m, const char *problem);
void core_warn(Model *m, int kind, const char *format, ...);
void core_warn_of_start(Model *m);
int core_all_finite(const double *values, int count);
void core_remember_inputs(Fixed *f);
void core_use_parameters(Model *m);
int core_use_step(Model *m);
void core_reset(Model *m);
int core_start(Model *m);
int core_ready(Model *m);

/* core.c */
int core_do_step(Model *m, double duration);
void core_samples_now(Model *m);
int core_begin_continuous(Model *m);
int core_completed_step(Model *m, int *wants_event);
int core_event(Model *m);
double core_scale(const Fixed *f, int setting);
int core_enter_event(Model *m);
void core_inputs(Model *m, double time);
void core_evaluate(Model *m, double time);
void core_derivatives(Model *m, double *rates);
void core_indicators(Model *m, double *indicators);

/* values.c */
int core_set(Model *m, unsigned int reference, double value);
int core_set_rate(Model *m, unsigned int reference, double value);
int core_get(Model *m, unsigned int reference, double *value);

/* snapshot.c */
Snapshot *snapshot_take(const Model *m, Snapshot *into);
int snapshot_restore(Model *m, const Snapshot *s);
void snapshot_free(Snapshot *s);
size_t snapshot_size(const Snapshot *s);
void snapshot_write(const Snapshot *s, char *bytes);
Snapshot *snapshot_read(const char *bytes, size_t size);

#endif
