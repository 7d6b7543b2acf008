// States of paths in memory (shared/path_fields.h). The scheduler says which fields it keeps (KEPT, of their readers'
// bits). The words of a path lie together: queues mix up the numbers of paths, and of words that lie path beside path
// each lane would fetch a sector of memory of its own (docs/results.md, "On a GPU").

#include "shared/path_fields.h"

layout(set = 0, binding = BINDING_PATHS, std430) buffer PathBuffer { uint pathWords[]; };

/// Where a path lies.
struct PathSlot {
    uint number; ///< among all paths
    uint first;  ///< number of its first word
};

uint pathWord(PathSlot slot, uint word) { return pathWords[slot.first + word]; }
void setPathWord(PathSlot slot, uint word, uint value) { pathWords[slot.first + word] = value; }

const uint WORDS_uint = 1u, WORDS_float = 1u, WORDS_bool = 1u, WORDS_vec2 = 2u, WORDS_vec3 = 3u;
const uint WORDS_vec4 = 4u, WORDS_uvec4 = 4u;

void load(PathSlot slot, uint word, out uint x) { x = pathWord(slot, word); }
void load(PathSlot slot, uint word, out float x) { x = uintBitsToFloat(pathWord(slot, word)); }
void load(PathSlot slot, uint word, out bool x) { x = pathWord(slot, word) != 0u; }
void load(PathSlot slot, uint word, out vec2 v) {
    v = uintBitsToFloat(uvec2(pathWord(slot, word), pathWord(slot, word + 1u)));
}
void load(PathSlot slot, uint word, out vec3 v) {
    v = uintBitsToFloat(uvec3(pathWord(slot, word), pathWord(slot, word + 1u), pathWord(slot, word + 2u)));
}
void load(PathSlot slot, uint word, out uvec4 v) {
    v = uvec4(pathWord(slot, word), pathWord(slot, word + 1u), pathWord(slot, word + 2u), pathWord(slot, word + 3u));
}
void load(PathSlot slot, uint word, out vec4 v) {
    uvec4 bits;
    load(slot, word, bits);
    v = uintBitsToFloat(bits);
}

void store(PathSlot slot, uint word, uint x) { setPathWord(slot, word, x); }
void store(PathSlot slot, uint word, float x) { setPathWord(slot, word, floatBitsToUint(x)); }
void store(PathSlot slot, uint word, bool x) { setPathWord(slot, word, x ? 1u : 0u); }
void store(PathSlot slot, uint word, vec2 v) {
    store(slot, word, v.x);
    store(slot, word + 1u, v.y);
}
void store(PathSlot slot, uint word, vec3 v) {
    store(slot, word, v.xy);
    store(slot, word + 2u, v.z);
}
void store(PathSlot slot, uint word, uvec4 v) {
    setPathWord(slot, word, v.x);
    setPathWord(slot, word + 1u, v.y);
    setPathWord(slot, word + 2u, v.z);
    setPathWord(slot, word + 3u, v.w);
}
void store(PathSlot slot, uint word, vec4 v) { store(slot, word, floatBitsToUint(v)); }

/// 32-bit words of a path (host/kernel/path_kernel.cpp). kept: as KEPT.
uint wordsOfPath(uint kept) {
    uint words = 0u;
#define COUNT_FIELD(type, member, exists, readers, writers)                                        \
    words += (exists) && ((readers) & kept) != 0u ? WORDS_##type : 0u;
    PATH_FIELDS(COUNT_FIELD)
#undef COUNT_FIELD
    return words;
}

PathSlot slotOf(uint number) { return PathSlot(number, number * wordsOfPath(KEPT)); }

/// Loads the fields that a stage reads. reader: its BY_ bit, or an AT_ bit.
void loadPath(PathSlot slot, inout PathState path, inout Job job, uint reader) {
    path.ray.hitPlacement = NO_PLACEMENT; // hitWords() reads it in all scenes
    uint word = 0u;
#define LOAD_FIELD(type, member, exists, readers, writers)                                         \
    if ((exists) && ((readers) & reader) != 0u) load(slot, word, member);                          \
    word += (exists) && ((readers) & KEPT) != 0u ? WORDS_##type : 0u;
    PATH_FIELDS(LOAD_FIELD)
#undef LOAD_FIELD
}

/// Stores the fields that a stage changes. writer: its BY_ bit, or an AT_ bit.
void storePath(PathSlot slot, PathState path, Job job, uint writer) {
    uint word = 0u;
#define STORE_FIELD(type, member, exists, readers, writers)                                        \
    if ((exists) && ((writers) & writer) != 0u) store(slot, word, member);                         \
    word += (exists) && ((readers) & KEPT) != 0u ? WORDS_##type : 0u;
    PATH_FIELDS(STORE_FIELD)
#undef STORE_FIELD
}
