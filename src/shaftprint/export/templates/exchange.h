/* Model exchange where FMI 2.0 and 3.0 have it alike but for the names: before this is included, FMI(name) is a name of the
   version, and Instance, Status and problem() are its own. */

static Status ended(Instance *c, int good) { return good ? OK : problem(c, ERROR); }

EXPORTED Status FMI(EnterContinuousTimeMode)(void *instance) {
    ((Instance *)instance)->m.f.mode = CONTINUOUS;
    return OK;
}

EXPORTED Status FMI(SetTime)(void *instance, double time) {
    ((Instance *)instance)->m.f.time = time;
    return OK;
}

EXPORTED Status FMI(SetContinuousStates)(void *instance, const double x[], size_t count) {
    Instance *c = instance;
    if (count != STATES) return problem(c, ERROR);
    memcpy(c->m.f.v.x, x, count * sizeof(double));
    return OK;
}

EXPORTED Status FMI(GetEventIndicators)(void *instance, double indicators[], size_t count) {
    Instance *c = instance;
    if (count != INDICATORS || !core_ready(&c->m)) return problem(c, ERROR);
    core_indicators(&c->m, indicators);
    return OK;
}

EXPORTED Status FMI(GetContinuousStates)(void *instance, double x[], size_t count) {
    Instance *c = instance;
    if (count != STATES || !core_ready(&c->m)) return problem(c, ERROR);
    memcpy(x, c->m.f.v.x, count * sizeof(double));
    return OK;
}

EXPORTED Status FMI(GetNominalsOfContinuousStates)(void *instance, double nominals[], size_t count) {
    if (count != STATES) return problem(instance, ERROR);
    for (size_t i = 0; i < count; i++) nominals[i] = 1.0;
    return OK;
}
