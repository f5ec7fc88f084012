/* The state of the model as a copy in memory, and as bytes for this kind of machine. */
#include <stdlib.h>
#include <string.h>

#include "core.h"

typedef struct {
    char token[sizeof MODEL_TOKEN];
    int nodes, segments;
} Head;

static void *copy(const void *from, size_t size) {
    void *made = malloc(size ? size : 1);
    if (made && size) memcpy(made, from, size);
    return made;
}

static size_t node_bytes(const Fixed *f) { return (size_t)f->nodes * sizeof(Node); }

static size_t segment_bytes(const Fixed *f) { return (size_t)f->segments * sizeof(Segment); }

void snapshot_free(Snapshot *s) {
    if (!s) return;
    free(s->node);
    free(s->segment);
    free(s);
}

/* Copy the model's state, into an earlier copy where one is given; NULL without memory. */
Snapshot *snapshot_take(const Model *m, Snapshot *into) {
    Node *node = copy(m->node, node_bytes(&m->f));
    Segment *segment = copy(m->segment, segment_bytes(&m->f));
    Snapshot *s = into ? into : calloc(1, sizeof *s);
    if (!node || !segment || !s) {
        free(node);
        free(segment);
        if (!into) free(s);
        return NULL;
    }
    free(s->node);
    free(s->segment);
    s->f = m->f;
    s->node = node;
    s->segment = segment;
    return s;
}

int snapshot_restore(Model *m, const Snapshot *s) {
    Node *node = copy(s->node, node_bytes(&s->f));
    Segment *segment = copy(s->segment, segment_bytes(&s->f));
    if (!node || !segment) {
        free(node);
        free(segment);
        return 0;
    }
    free(m->node);
    free(m->segment);
    m->f = s->f;
    m->node = node;
    m->segment = segment;
    m->node_room = s->f.nodes;
    m->segment_room = s->f.segments;
    return 1;
}

size_t snapshot_size(const Snapshot *s) {
    return sizeof(Head) + sizeof(Fixed) + node_bytes(&s->f) + segment_bytes(&s->f);
}

void snapshot_write(const Snapshot *s, char *bytes) {
    Head head;
    memset(&head, 0, sizeof head);
    memcpy(head.token, MODEL_TOKEN, sizeof head.token);
    head.nodes = s->f.nodes;
    head.segments = s->f.segments;
    memcpy(bytes, &head, sizeof head);
    memcpy(bytes += sizeof head, &s->f, sizeof s->f);
    memcpy(bytes += sizeof s->f, s->node, node_bytes(&s->f));
    memcpy(bytes + node_bytes(&s->f), s->segment, segment_bytes(&s->f));
}

/* Read a state from bytes; NULL if they are not of this model. */
Snapshot *snapshot_read(const char *bytes, size_t size) {
    Model m;
    Head head;
    memset(&m, 0, sizeof m);
    if (size < sizeof head + sizeof(Fixed)) return NULL;
    memcpy(&head, bytes, sizeof head);
    memcpy(&m.f, bytes + sizeof head, sizeof m.f);
    if (memcmp(head.token, MODEL_TOKEN, sizeof head.token) != 0) return NULL;
    if (m.f.nodes < 0 || m.f.segments < 0 || m.f.nodes != head.nodes || m.f.segments != head.segments) return NULL;
    if (size != sizeof head + sizeof m.f + node_bytes(&m.f) + segment_bytes(&m.f)) return NULL;
    bytes += sizeof head + sizeof m.f;
    m.node = copy(bytes, node_bytes(&m.f));
    m.segment = copy(bytes + node_bytes(&m.f), segment_bytes(&m.f));
    Snapshot *s = m.node && m.segment ? snapshot_take(&m, NULL) : NULL;
    free(m.node);
    free(m.segment);
    return s;
}
