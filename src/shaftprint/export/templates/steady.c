/* Steady running at constant inputs by Newton's method, and the longest step that small signals allow. */
#include <math.h>
#include <string.h>

#include "core.h"

#define MOST_STEPS 80
#define HALVINGS 30
#define TOLERANCE 1e-11
#define LOOSE_TOLERANCE 3e-6
#define RANK 1e-12
#define LEADING_STEPS 64
/* Small signals may move by this much in a step; Runge and Kutta's rule is stable up to 2.7. */
#define MOST_MOVED 0.3
#define MOST_EXTRAPOLATED 0.1
#define DELAY_PARTS 4.0
#define SQUARINGS 7

static void put(Values *v, const double *at) {
    for (int i = 0; i < STILL; i++) v->x[model_still[i]] = at[i];
    for (int j = 0; j < LATES; j++) v->past[j] = at[STILL + j];
    for (int k = 0; k < SAMPLES; k++) v->z[k] = at[STILL + LATES + k];
}

static double left_over(Values *v, const double *at, double *left) {
    double sum = 0.0;
    put(v, at);
    model_steady(v, left);
    for (int i = 0; i < UNKNOWNS; i++) sum += left[i] * left[i];
    return sqrt(sum);
}

static double largest(const double *values, int count) {
    double found = 0.0;
    for (int i = 0; i < count; i++) {
        if (!isfinite(values[i])) return HUGE_VAL;
        if (fabs(values[i]) > found) found = fabs(values[i]);
    }
    return found;
}

/* Solve a x = b by elimination with full pivoting; what has no value of its own does not move. */
static void solve(double *a, double *b, double *x, int size) {
    int column[UNKNOWNS + 1], rank = 0;
    double first = 0.0;
    for (int i = 0; i < size; i++) column[i] = i;
    for (; rank < size; rank++) {
        int row = rank, best = rank;
        for (int i = rank; i < size; i++)
            for (int j = rank; j < size; j++)
                if (fabs(a[i * size + j]) > fabs(a[row * size + best])) row = i, best = j;
        const double pivot = fabs(a[row * size + best]);
        if (rank == 0) first = pivot;
        if (!(pivot > RANK * first)) break;
        for (int j = 0; j < size; j++) {
            const double kept = a[row * size + j];
            a[row * size + j] = a[rank * size + j];
            a[rank * size + j] = kept;
        }
        const double kept = b[row];
        b[row] = b[rank];
        b[rank] = kept;
        for (int i = 0; i < size; i++) {
            const double other = a[i * size + best];
            a[i * size + best] = a[i * size + rank];
            a[i * size + rank] = other;
        }
        const int name = column[best];
        column[best] = column[rank];
        column[rank] = name;
        for (int i = rank + 1; i < size; i++) {
            const double share = a[i * size + rank] / a[rank * size + rank];
            for (int j = rank; j < size; j++) a[i * size + j] -= share * a[rank * size + j];
            b[i] -= share * b[rank];
        }
    }
    for (int i = 0; i < size; i++) x[i] = 0.0;
    for (int i = rank - 1; i >= 0; i--) {
        double rest = b[i];
        for (int j = i + 1; j < rank; j++) rest -= a[i * size + j] * x[column[j]];
        x[column[i]] = rest / a[i * size + i];
    }
}

static int newton(Values *v, double *at) {
    double left[UNKNOWNS + 1], slopes[UNKNOWNS * UNKNOWNS + 1], step[UNKNOWNS + 1], tried[UNKNOWNS + 1];
    double size = left_over(v, at, left);
    for (int round = 0; round < MOST_STEPS; round++) {
        const double most = largest(left, UNKNOWNS);
        if (most <= TOLERANCE * (1.0 + largest(at, UNKNOWNS))) return 1;
        model_steady_slopes(v, slopes);
        if (!isfinite(most) || !isfinite(largest(slopes, UNKNOWNS * UNKNOWNS))) return 0;
        for (int i = 0; i < UNKNOWNS; i++) left[i] = -left[i];
        solve(slopes, left, step, UNKNOWNS);
        double share = 1.0, found = HUGE_VAL;
        for (int half = 0; half < HALVINGS; half++, share *= 0.5) {
            for (int i = 0; i < UNKNOWNS; i++) tried[i] = at[i] + share * step[i];
            found = left_over(v, tried, left);
            if (found < size) break;
        }
        if (!(found < size)) break;
        size = found;
        memcpy(at, tried, sizeof tried);
    }
    left_over(v, at, left);
    return largest(left, UNKNOWNS) <= LOOSE_TOLERANCE;
}

/* Put the states in steady running at the inputs; 0 where there is none. */
int steady_find(Model *m) {
    Values *v = &m->f.v;
    double at[UNKNOWNS + 1] = {0.0}, inputs[INPUTS + 1];
    memset(v->x, 0, sizeof v->x);
    memset(v->past_rate, 0, sizeof v->past_rate);
    memset(v->u_rate, 0, sizeof v->u_rate);
    v->step = 1.0;
    int found = newton(v, at);
    if (!found) {
        /* led there from rest, so that no limit is met on the way in vain */
        memcpy(inputs, v->u, sizeof inputs);
        memset(at, 0, sizeof at);
        found = 1;
        for (int i = 0; i <= LEADING_STEPS && found; i++) {
            for (int j = 0; j < INPUTS; j++) v->u[j] = inputs[j] * i / LEADING_STEPS;
            found = newton(v, at);
        }
        memcpy(v->u, inputs, sizeof inputs);
    }
    put(v, at);
    return found;
}

/* Size of the fastest small signal of a matrix [1/s], from above: of its 2^k-th power the root (Gelfand). */
static double fastest(const double *matrix, int size) {
    double a[STATES * STATES + 1], b[STATES * STATES + 1], logarithm = 0.0, power = 1.0;
    memcpy(a, matrix, (size_t)(size * size) * sizeof(double));
    for (int round = 0; round <= SQUARINGS; round++) {
        double norm = 0.0;
        for (int i = 0; i < size * size; i++) norm += a[i] * a[i];
        norm = sqrt(norm);
        if (!(norm > 0.0)) return 0.0;
        if (!isfinite(norm)) return HUGE_VAL;
        logarithm += log(norm) / power;
        if (round == SQUARINGS) break;
        for (int i = 0; i < size * size; i++) a[i] /= norm;
        for (int i = 0; i < size; i++)
            for (int j = 0; j < size; j++) {
                double sum = 0.0;
                for (int k = 0; k < size; k++) sum += a[i * size + k] * a[k * size + j];
                b[i * size + j] = sum;
            }
        memcpy(a, b, (size_t)(size * size) * sizeof(double));
        power *= 2.0;
    }
    return exp(logarithm);
}

/* Longest step that follows small signals, with late signals that stand still and with prompt ones [s]. */
double steady_longest_step(Model *m) {
    Values *v = &m->f.v;
    double own[STATES * STATES + 1], slopes[UNKNOWNS * UNKNOWNS + 1], prompt[STATES * STATES + 1];
    double shortest = HUGE_VAL, step = HUGE_VAL;
    v->step = 1.0;
    model_state_slopes(v, own);
    model_steady_slopes(v, slopes);
    for (int k = UNKNOWNS - 1; k >= STILL; k--) {
        const double pivot = slopes[k * UNKNOWNS + k];
        if (!(fabs(pivot) > 1e-9)) continue;
        for (int i = 0; i < k; i++)
            for (int j = 0; j < k; j++)
                slopes[i * UNKNOWNS + j] -= slopes[i * UNKNOWNS + k] * slopes[k * UNKNOWNS + j] / pivot;
    }
    for (int i = 0; i < STILL; i++)
        for (int j = 0; j < STILL; j++) prompt[i * STILL + j] = slopes[i * UNKNOWNS + j];
    const double still = STATES ? fastest(own, STATES) : 0.0, soon = STILL ? fastest(prompt, STILL) : 0.0;
    if (still > 0.0) step = MOST_MOVED / still;
    if (soon > 0.0 && MOST_MOVED / soon < step) step = MOST_MOVED / soon;
    for (int j = 0; j < LATES; j++)
        if (model_feeds[j] && m->f.delay[j] / DELAY_PARTS < shortest) shortest = m->f.delay[j] / DELAY_PARTS;
    const double extrapolated = soon > 0.0 ? MOST_EXTRAPOLATED / soon : HUGE_VAL;
    const double bound = shortest > extrapolated ? shortest : extrapolated;
    /* from there on a past is extrapolated whose signal is not known yet, more than the loop bears */
    m->f.longest_ahead = DELAY_PARTS * shortest > extrapolated ? DELAY_PARTS * shortest : extrapolated;
    return bound < step ? bound : step;
}
