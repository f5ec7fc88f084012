/* What late signals were: nodes in time, in segments that begin at jumps and corners.

   A past is interpolated by a cubic through four nodes of one segment (Lagrange), never across a break, so that a delay
   is exact however it compares with the steps. */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "core.h"

#define LONGEST_KEPT 8.0
#define SHORTEST_KEPT_S 1.0

/* What two times may differ by and be the same [s]. */
double tiny(double time) { return 1e-10 + 8.0 * DBL_EPSILON * fabs(time); }

static int room_for(void **place, int *room, int count, size_t size) {
    if (count >= *room) {
        int more = *room ? 2 * *room : 256;
        void *grown = realloc(*place, (size_t)more * size);
        if (!grown) return 0;
        *place = grown;
        *room = more;
    }
    return 1;
}

/* Add a node with the late signals as they are now; with an order of 0 or more it begins a segment. */
int history_add(Model *m, int order) {
    Fixed *f = &m->f;
    const double now = f->v.time;
    if (order < 0 && f->nodes && f->segments) {
        const long long first = m->segment[f->segments - 1].first - f->dropped_nodes;
        /* a step that was taken anew replaces the one before */
        while (f->nodes - 1 > first && m->node[f->nodes - 1].time >= now - tiny(now)) f->nodes--;
        if (m->node[f->nodes - 1].time >= now - tiny(now)) return 1;
    }
    if (!room_for((void **)&m->node, &m->node_room, f->nodes, sizeof(Node))) return 0;
    if (order >= 0) {
        if (!room_for((void **)&m->segment, &m->segment_room, f->segments, sizeof(Segment))) return 0;
        m->segment[f->segments].time = now;
        m->segment[f->segments].first = f->dropped_nodes + f->nodes;
        m->segment[f->segments].order = order;
        f->segments++;
    }
    m->node[f->nodes].time = now;
    model_lates(&f->v, m->node[f->nodes].late);
    f->nodes++;
    return 1;
}

int history_begin(Model *m) {
    Fixed *f = &m->f;
    f->nodes = f->segments = 0;
    f->dropped_nodes = f->dropped_segments = 0;
    model_drifts(&f->v, f->drift);
    for (int j = 0; j < LATES; j++) f->segment[j] = -1;
    if (!history_add(m, 1)) return 0;
    history_settle(m);
    return 1;
}

/* Last segment that begins at a time or before, -1 where none does. */
static long long segment_at(const Model *m, double time) {
    int low = 0, high = m->f.segments;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (m->segment[middle].time <= time) low = middle + 1;
        else high = middle;
    }
    if (low == 0 && m->f.dropped_segments) return m->f.dropped_segments;
    return low == 0 ? -1 : m->f.dropped_segments + low - 1;
}

/* Let every past stand in the segment that it has reached by now. */
void history_settle(Model *m) {
    Fixed *f = &m->f;
    for (int j = 0; j < LATES; j++) {
        const double at = f->v.time - f->delay[j];
        f->segment[j] = segment_at(m, at + tiny(f->v.time));
    }
}

static int follows_breaks(int past) { return model_feeds[past] && !model_varies[past]; }

/* Next segment of a past, NULL if it is in the last. */
static const Segment *next_segment(const Model *m, int past) {
    const long long next = m->f.segment[past] + 1 - m->f.dropped_segments;
    return next >= 0 && next < m->f.segments ? &m->segment[next] : NULL;
}

/* When the next break reaches an equation. */
double history_next_arrival(const Model *m) {
    double found = HUGE_VAL;
    for (int j = 0; j < LATES; j++) {
        const Segment *next = follows_breaks(j) ? next_segment(m, j) : NULL;
        if (next && next->time + m->f.delay[j] < found) found = next->time + m->f.delay[j];
    }
    return found;
}

/* Lowest order of the breaks that reach an equation now; more than HIGHEST_ORDER where none does. */
int history_arriving_order(const Model *m) {
    const double now = m->f.v.time + tiny(m->f.v.time);
    int order = HIGHEST_ORDER + 1;
    for (int j = 0; j < LATES; j++) {
        const Segment *next = follows_breaks(j) ? next_segment(m, j) : NULL;
        if (next && next->time + m->f.delay[j] <= now && next->order < order) order = next->order;
    }
    return order;
}

/* Value and change of late signal j at a time, from the nodes of one segment. */
static void interpolate(Model *m, int j, long long segment, double at, double *value, double *rate) {
    const Fixed *f = &m->f;
    if (segment < 0) {
        *value = m->node[0].late[j] + (at - f->start_time) * f->drift[j];
        *rate = f->drift[j];
        return;
    }
    const long long own = segment - f->dropped_segments;
    const int begin = (int)(m->segment[own].first - f->dropped_nodes);
    const int end = own + 1 < f->segments ? (int)(m->segment[own + 1].first - f->dropped_nodes) : f->nodes;
    int low = begin, high = end;
    while (low < high) {
        const int middle = (low + high) / 2;
        if (m->node[middle].time <= at) low = middle + 1;
        else high = middle;
    }
    const int count = end - begin < 4 ? end - begin : 4;
    int first = low - 2;
    if (first > end - count) first = end - count;
    if (first < begin) first = begin;
    const Node *node = m->node + first;
    *value = *rate = 0.0;
    for (int a = 0; a < count; a++) {
        double weight = 1.0, change = 0.0;
        for (int b = 0; b < count; b++) {
            if (b == a) continue;
            const double width = node[a].time - node[b].time;
            change = (change * (at - node[b].time) + weight) / width;
            weight *= (at - node[b].time) / width;
        }
        *value += weight * node[a].late[j];
        *rate += change * node[a].late[j];
    }
}

static void look_at(Model *m, int j, long long segment, double at) {
    Values *v = &m->f.v;
    /* what is older than all that is kept stays as the oldest */
    if (m->f.dropped_nodes && at < m->node[0].time) at = m->node[0].time;
    interpolate(m, j, segment, at, &v->past[j], &v->past_rate[j]);
}

/* Fill in the pasts at a time: those that equations need, and those that only outputs need where wanted. */
void history_look(Model *m, double time, int outputs_too) {
    Fixed *f = &m->f;
    double varied[LATES + 1], now[LATES + 1];
    int varies = 0;
    for (int j = 0; j < LATES; j++) {
        varies |= model_varies[j];
        if (follows_breaks(j)) look_at(m, j, f->segment[j], time - f->delay[j]);
    }
    if (varies) {
        model_delays(&f->v, varied);
        for (int j = 0; j < LATES; j++) {
            if (!model_varies[j]) continue;
            const double late = varied[j] > 0.0 ? varied[j] : 0.0;
            look_at(m, j, segment_at(m, time - late), time - late);
        }
    }
    core_samples_now(m);
    if (!outputs_too) return;
    model_lates(&f->v, now);
    for (int j = 0; j < LATES; j++) {
        if (model_feeds[j] || model_varies[j]) continue;
        if (f->delay[j] > 0.0) look_at(m, j, segment_at(m, time - f->delay[j] + tiny(time)), time - f->delay[j]);
        else f->v.past[j] = now[j];
    }
}

/* Drop what is older than any delay asks for; delays that are changed may grow to eight times what they are. */
void history_forget(Model *m) {
    Fixed *f = &m->f;
    double longest = SHORTEST_KEPT_S;
    if (f->nodes < m->node_room && f->segments < m->segment_room) return;
    for (int j = 0; j < LATES; j++)
        if (LONGEST_KEPT * f->delay[j] > longest) longest = LONGEST_KEPT * f->delay[j];
    if (!f->segments) return;
    int old = 0;
    while (old + 1 < f->segments && m->segment[old + 1].time < f->v.time - longest) old++;
    int kept = (int)(m->segment[old].first - f->dropped_nodes);
    const int end = old + 1 < f->segments ? (int)(m->segment[old + 1].first - f->dropped_nodes) : f->nodes;
    while (end - kept > 8 && m->node[kept + 4].time < f->v.time - longest) kept++;
    if (!kept) return;
    memmove(m->node, m->node + kept, (size_t)(f->nodes - kept) * sizeof(Node));
    memmove(m->segment, m->segment + old, (size_t)(f->segments - old) * sizeof(Segment));
    f->nodes -= kept;
    f->segments -= old;
    f->dropped_nodes += kept;
    f->dropped_segments += old;
    if (m->segment[0].first < f->dropped_nodes) m->segment[0].first = f->dropped_nodes;
    for (int j = 0; j < LATES; j++)
        if (f->segment[j] < f->dropped_segments) f->segment[j] = f->dropped_segments;
}
