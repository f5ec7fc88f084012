/* Sizes and functions of the equations; written by shaftprint. */
#ifndef MODEL_H
#define MODEL_H

#define MODEL_TOKEN "@TOKEN@"

@SIZES@

/* Places of the settings: working point and longest internal step. */
enum { ENGINE_SPEED, SHAFT_TORQUE, INTERNAL_STEP };

/* What the equations are made of at one time. */
typedef struct {
    double time;
    double p[PARAMETERS + 1];
    double x[STATES + 1];
    double past[LATES + 1];
    double past_rate[LATES + 1];
    double z[SAMPLES + 1];
    double u[INPUTS + 1];
    double u_rate[INPUTS + 1];
    double step; /* time since a computer that takes values at every step took the last ones [s] */
} Values;

extern const char model_title[]; /* what the equations are of */
extern const int model_still[];
extern const int model_feeds[];
extern const int model_varies[];
extern const int model_input_scale[];
extern const int model_input_offset[];
extern const char *const model_input_names[];
extern const int model_output_scale[];
extern const int model_output_offset[];
extern const double model_settings[];
extern const double model_start[];
extern const double model_draws[][PARAMETERS + 1];

@FUNCTIONS@

static inline double least(double a, double b) { return a <= b ? a : b; }

static inline double most(double a, double b) { return b <= a ? a : b; }

static inline double choose(double a, double b, double at_most, double above) { return a <= b ? at_most : above; }

static inline double table_slope(double a, int count, const double *x, const double *y) {
    int j = 1;
    if (a <= x[0] || a > x[count - 1]) return 0.0;
    while (x[j] < a) j++;
    return (y[j] - y[j - 1]) / (x[j] - x[j - 1]);
}

static inline double table(double a, int count, const double *x, const double *y) {
    int j = 1;
    if (a <= x[0]) return y[0];
    if (a > x[count - 1]) return y[count - 1];
    while (x[j] < a) j++;
    return y[j - 1] + (y[j] - y[j - 1]) / (x[j] - x[j - 1]) * (a - x[j - 1]);
}

#endif
