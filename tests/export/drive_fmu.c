/* Drives the binary of an FMU as another program would, and prints what it gave with 17 digits. It is compiled against the
   headers of the standard, with VERSION 2 or 3.

   drive_fmu LIBRARY TOKEN DRIVE STATES INDICATORS INPUT OUTPUT...

   DRIVE is a file of times and inputs in pairs; INPUT and OUTPUT are value references. First an instance is asked for
   with a wrong token, then one of co-simulation and one of model exchange are driven. Lines that begin with a word say
   what comes, lines of numbers are what was found. */
#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#if VERSION == 2
#include "fmi2FunctionTypes.h"
#define PREFIX fmi2
#define STRING_PREFIX "fmi2"
#else
#include "fmi3FunctionTypes.h"
#define PREFIX fmi3
#define STRING_PREFIX "fmi3"
#endif

#define PASTED(a, b, c) a##b##c
#define PASTE(a, b, c) PASTED(a, b, c)
/* A function of the library by its name without the prefix, with the type that the standard declares. */
#define CALL(name) ((PASTE(PREFIX, name, TYPE) *)address(STRING_PREFIX #name))
#define MOST 64
#define LONGEST_DRIVE 4096

typedef void (*Function)(void);

#if defined(_WIN32)
#include <windows.h>
static HMODULE library;
static void load(const char *path) { library = LoadLibraryA(path); }
static Function found(const char *name) { return (Function)GetProcAddress(library, name); }
static int unload(void) { return FreeLibrary(library) != 0; }
#else
#include <dlfcn.h>
static void *library;
static void load(const char *path) { library = dlopen(path, RTLD_NOW | RTLD_LOCAL); }
static Function found(const char *name) { return (Function)dlsym(library, name); }
static int unload(void) { return dlclose(library) == 0; }
#endif

static char environment[] = "bridge";
static int states, indicators, outputs, times;
static unsigned int input, output[MOST];
static double time_s[LONGEST_DRIVE], set_point[LONGEST_DRIVE];

static void end(const char *words, const char *name) {
    printf("failed %s %s\n", words, name);
    exit(1);
}

static Function address(const char *name) {
    Function here = found(name);
    if (!here) end("to find", name);
    return here;
}

static void print(const double *values, int count) {
    for (int i = 0; i < count; i++) printf("%.17g ", values[i]);
}

#define GOOD(call) \
    if ((call) != 0) end("in", #call)

/* ---- what the versions have differently ---- */

#if VERSION == 2
typedef fmi2Component Instance;

static void say(void *given, fmi2String instance, fmi2Status status, fmi2String category, fmi2String message, ...) {
    va_list more;
    va_start(more, message);
    printf("message %s %s %d %s ", (char *)given, instance, (int)status, category);
    vprintf(message, more);
    printf("\n");
    va_end(more);
}

static const fmi2CallbackFunctions callbacks = {say, calloc, free, NULL, environment};

static Instance instantiate(const char *token, int co_simulation) {
    const fmi2Type kind = co_simulation ? fmi2CoSimulation : fmi2ModelExchange;
    return CALL(Instantiate)("tug", kind, token, "", &callbacks, fmi2False, fmi2True);
}

static void enter_initialisation(Instance c) {
    GOOD(CALL(SetupExperiment)(c, fmi2False, 0.0, time_s[0], fmi2False, 0.0));
    GOOD(CALL(EnterInitializationMode)(c));
}

static void set_input(Instance c, double value) { GOOD(CALL(SetReal)(c, &input, 1, &value)); }

static void get(Instance c, const unsigned int *which, int count, double *values) {
    GOOD(CALL(GetReal)(c, which, (size_t)count, values));
}

static void do_step(Instance c, double time, double duration) { GOOD(CALL(DoStep)(c, time, duration, fmi2True)); }

/* Take notice of an event; the time of the next is returned. */
static double update(Instance c) {
    fmi2EventInfo info;
    GOOD(CALL(NewDiscreteStates)(c, &info));
    if (info.newDiscreteStatesNeeded || info.terminateSimulation) end("in", "events");
    return info.nextEventTimeDefined ? info.nextEventTime : HUGE_VAL;
}

static void completed_step(Instance c) {
    fmi2Boolean event, terminate;
    GOOD(CALL(CompletedIntegratorStep)(c, fmi2True, &event, &terminate));
}

static void derivatives(Instance c, double *rates) { GOOD(CALL(GetDerivatives)(c, rates, (size_t)states)); }
#else
typedef fmi3Instance Instance;

static void say(void *given, fmi3Status status, fmi3String category, fmi3String message) {
    printf("message %s tug %d %s %s\n", (char *)given, (int)status, category, message);
}

static Instance instantiate(const char *token, int co_simulation) {
    if (!co_simulation) return CALL(InstantiateModelExchange)("tug", token, "", false, true, environment, say);
    return CALL(InstantiateCoSimulation)("tug", token, "", false, true, false, false, NULL, 0, environment, say, NULL);
}

static void enter_initialisation(Instance c) {
    GOOD(CALL(EnterInitializationMode)(c, false, 0.0, time_s[0], false, 0.0));
}

static void set_input(Instance c, double value) { GOOD(CALL(SetFloat64)(c, &input, 1, &value, 1)); }

static void get(Instance c, const unsigned int *which, int count, double *values) {
    GOOD(CALL(GetFloat64)(c, which, (size_t)count, values, (size_t)count));
}

static void do_step(Instance c, double time, double duration) {
    fmi3Boolean event, terminate, early;
    fmi3Float64 reached;
    GOOD(CALL(DoStep)(c, time, duration, true, &event, &terminate, &early, &reached));
    if (event || terminate || early) end("in", "a step");
}

/* Take notice of an event; the time of the next is returned. */
static double update(Instance c) {
    fmi3Boolean more, terminate, nominals, values, defined;
    fmi3Float64 next;
    GOOD(CALL(UpdateDiscreteStates)(c, &more, &terminate, &nominals, &values, &defined, &next));
    if (more || terminate) end("in", "events");
    return defined ? next : HUGE_VAL;
}

static void completed_step(Instance c) {
    fmi3Boolean event, terminate;
    GOOD(CALL(CompletedIntegratorStep)(c, true, &event, &terminate));
}

static void derivatives(Instance c, double *rates) {
    size_t count = 0;
    GOOD(CALL(GetNumberOfContinuousStates)(c, &count));
    if (count != (size_t)states) end("in", "the number of states");
    GOOD(CALL(GetNumberOfEventIndicators)(c, &count));
    if (count != (size_t)indicators) end("in", "the number of indicators");
    GOOD(CALL(GetContinuousStateDerivatives)(c, rates, (size_t)states));
}
#endif

/* ---- what is the same ---- */

static void start(Instance c) {
    enter_initialisation(c);
    set_input(c, set_point[0]);
    GOOD(CALL(ExitInitializationMode)(c));
}

static void print_signals(Instance c) {
    double values[MOST];
    get(c, &input, 1, values);
    get(c, output, outputs, values + 1);
    print(values, outputs + 1);
}

static void simulate(Instance c) {
    start(c);
    for (int k = 0; k + 1 < times; k++) {
        set_input(c, set_point[k]);
        do_step(c, time_s[k], time_s[k + 1] - time_s[k]);
        print_signals(c);
        printf("\n");
    }
    GOOD(CALL(Terminate)(c));
}

static double event(Instance c, double value) {
    GOOD(CALL(EnterEventMode)(c));
    set_input(c, value);
    const double next = update(c);
    GOOD(CALL(EnterContinuousTimeMode)(c));
    return next;
}

static void look(Instance c, double *rates, double *shown) {
    derivatives(c, rates);
    GOOD(CALL(GetEventIndicators)(c, shown, (size_t)indicators));
}

/* Go on by Euler's rule to a time; whether an indicator changed its sign is returned. */
static int advance(Instance c, double time, double duration, double *x) {
    double rates[MOST], before[MOST], after[MOST];
    int changed = 0;
    look(c, rates, before);
    for (int i = 0; i < states; i++) x[i] += duration * rates[i];
    GOOD(CALL(SetTime)(c, time));
    GOOD(CALL(SetContinuousStates)(c, x, (size_t)states));
    completed_step(c);
    look(c, rates, after);
    for (int i = 0; i < indicators; i++) changed |= before[i] * after[i] < 0.0;
    return changed;
}

/* Events are where the input jumps, where a time was foretold, and where an indicator changed its sign. */
static void exchange(Instance c) {
    double x[MOST] = {0.0}, rates[MOST], shown[MOST], now = time_s[0];
    start(c);
    double next = update(c);
    GOOD(CALL(EnterContinuousTimeMode)(c));
    GOOD(CALL(GetContinuousStates)(c, x, (size_t)states));
    for (int k = 0; k + 1 < times; k++) {
        if (k && set_point[k] != set_point[k - 1]) next = event(c, set_point[k]);
        look(c, rates, shown);
        print_signals(c);
        print(x, states);
        print(rates, states);
        print(shown, indicators);
        printf("\n");
        while (now < time_s[k + 1]) {
            const double reached = next < time_s[k + 1] ? next : time_s[k + 1];
            const int changed = advance(c, reached, reached - now, x);
            now = reached;
            if (changed || now == next) next = event(c, set_point[k]);
        }
    }
    GOOD(CALL(Terminate)(c));
}

static void read_drive(const char *path) {
    FILE *file = fopen(path, "r");
    if (!file) end("to open", path);
    while (times < LONGEST_DRIVE && fscanf(file, "%lf %lf", &time_s[times], &set_point[times]) == 2) times++;
    fclose(file);
}

int main(int count, char **words) {
    if (count < 8 || count - 7 > MOST) end("with these", "arguments");
    const char *token = words[2];
    read_drive(words[3]);
    states = atoi(words[4]);
    indicators = atoi(words[5]);
    input = (unsigned int)strtoul(words[6], NULL, 10);
    for (outputs = 0; outputs < count - 7; outputs++) output[outputs] = (unsigned int)strtoul(words[7 + outputs], NULL, 10);
    load(words[1]);
    if (!library) end("to load", words[1]);
    printf("version %s\n", CALL(GetVersion)());
    if (instantiate("{another}", 1)) end("to refuse", "another token");
    Instance one = instantiate(token, 1), other = instantiate(token, 0);
    if (!one || !other) end("to instantiate", token);
    printf("co-simulation\n");
    simulate(one);
    printf("model exchange\n");
    exchange(other);
    CALL(FreeInstance)(one);
    CALL(FreeInstance)(other);
    CALL(FreeInstance)(NULL);
    if (!unload()) end("to unload", words[1]);
    printf("freed\n");
    return 0;
}
