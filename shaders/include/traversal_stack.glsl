// The groups of children that a traversal has put off, newest first. Each level of the tree leaves at most one
// (host/bvh/wide_layout.hpp), and STACK_SIZE counts one more.
//
// In registers the stack moves as a whole: two selections an entry. docs/theory/kernel.md, "The traversal stack", says when a
// memory that each lane indexes for itself is used instead.

/// Some of a node's children: the first child's record, and in bits 0-7 of `word` bit (slot ^ octant) for each
/// (Ray::octant), so that the highest one is the nearest, more or less. `word` is 0 where there are none.
/// The record lies in bits 8-31 of `word`; where the tree has more records than these can number, in `first`,
/// which other trees neither set nor read.
struct Group {
    uint word;
    uint first;
};

Group noGroup() { return Group(0u, 0u); }

/// record: < 2^24 and whatever bits above, or | RECORD_IS_NODE where the tree is large.
Group makeGroup(uint record, uint slots) {
    return LARGE_TREE ? Group(slots, record & RECORD_INDEX_MASK) : Group(record << 8u | slots, 0u);
}

bool isEmpty(Group g) { return g.word == 0u; }
uint firstRecord(Group g) { return LARGE_TREE ? g.first : g.word >> 8u; }
/// The bit of the nearest child; any if there is none.
uint nearestSlot(Group g) { return highestBit(g.word & 0xFFu) & 7u; }

Group without(Group g, uint bit) {
    const uint word = g.word & ~(1u << bit);
    return Group((word & 0xFFu) != 0u ? word : 0u, g.first);
}

Group select(bool takesFirst, Group first, Group second) {
    return Group(takesFirst ? first.word : second.word,
                 LARGE_TREE ? (takesFirst ? first.first : second.first) : 0u);
}

struct Stack {
    uint words[STACK_SIZE];
    uint firsts[LARGE_TREE ? STACK_SIZE : 1u]; ///< Group::first of each
    uint top;                                  ///< entries in use, where they are in memory
};

void clear(inout Stack stack) {
    stack.top = 0u;
    if (STACK_IN_REGISTERS)
        for (uint i = 0u; i + 1u < STACK_SIZE; ++i)
            stack.words[i] = 0u;
}

uint entriesInUse(Stack stack) {
    if (!STACK_IN_REGISTERS) return stack.top;
    uint n = 0u;
    for (uint i = 0u; i + 1u < STACK_SIZE; ++i)
        n += stack.words[i] != 0u ? 1u : 0u;
    return n;
}

Group moveRegisters(inout Stack stack, bool push, bool pop, Group group) {
    Group newest = noGroup();
    if (STACK_SIZE > 1u) newest.word = stack.words[0];
    if (STACK_SIZE > 1u && LARGE_TREE) newest.first = stack.firsts[0];
    Group newer = group;
    for (uint i = 0u; i + 1u < STACK_SIZE; ++i) {
        const uint older = i + 2u < STACK_SIZE ? stack.words[i + 1u] : 0u, here = stack.words[i];
        stack.words[i] = push ? newer.word : (pop ? older : here);
        newer.word = here;
        if (LARGE_TREE) {
            const uint olderFirst = i + 2u < STACK_SIZE ? stack.firsts[i + 1u] : 0u;
            const uint hereFirst = stack.firsts[i];
            stack.firsts[i] = push ? newer.first : (pop ? olderFirst : hereFirst);
            newer.first = hereFirst;
        }
    }
    return newest;
}

Group moveMemory(inout Stack stack, bool push, bool pop, Group group) {
    stack.words[stack.top] = group.word; // counts only where `push` keeps it
    if (LARGE_TREE) stack.firsts[stack.top] = group.first;
    stack.top += push ? 1u : 0u;
    const bool empty = stack.top == 0u;
    stack.top -= pop && !empty ? 1u : 0u;
    Group newest = noGroup();
    if (!empty) newest.word = stack.words[stack.top];
    if (!empty && LARGE_TREE) newest.first = stack.firsts[stack.top];
    return newest;
}

/// Puts off `group` if `push`, else takes the newest group if `pop`. Returns that: empty if there is none.
Group moveStack(inout Stack stack, bool push, bool pop, Group group) {
    return STACK_IN_REGISTERS ? moveRegisters(stack, push, pop, group) : moveMemory(stack, push, pop, group);
}
