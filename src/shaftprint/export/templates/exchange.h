/* Model exchange where FMI 2.0 and 3.0 have it alike but for the names: before this is included, FMI(name) is a name of the
   version, and Instance, Status, problem() and tell() are its own. */

static Status ended(Instance *c, int good) {
    tell(c);
    return good ? OK : problem(c, ERROR);
}

EXPORTED Status FMI(EnterContinuousTimeMode)(void *instance) {
    Instance *c = instance;
    if (c->m.f.mode != EVENTS && c->m.f.mode != CONTINUOUS) return problem(c, ERROR);
    const int good = core_begin_continuous(&c->m);
    c->m.f.mode = CONTINUOUS;
    return ended(c, good);
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
