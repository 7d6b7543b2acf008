// The groups of children that a traversal has put off, newest first; 0: none. Each level of the
// tree leaves at most one (host/bvh/wide_layout.hpp), and STACK_SIZE counts one more. In registers
// the stack moves as a whole, in memory each lane has an index of its own (docs/kernel.md,
// "The traversal stack").

uint stack[STACK_SIZE];
uint stackTop; ///< entries in use, where they are in memory

void clearStack() {
    stackTop = 0u;
    if (STACK_IN_REGISTERS)
        for (uint i = 0u; i + 1u < STACK_SIZE; ++i)
            stack[i] = 0u;
}

uint entriesInUse() {
    if (!STACK_IN_REGISTERS) return stackTop;
    uint n = 0u;
    for (uint i = 0u; i + 1u < STACK_SIZE; ++i)
        n += stack[i] != 0u ? 1u : 0u;
    return n;
}

/// Puts off `group` if `push`, else takes the newest group if `pop`. Returns that: 0 if there is none.
uint moveStack(bool push, bool pop, uint group) {
    if (STACK_IN_REGISTERS) {
        const uint newest = STACK_SIZE > 1u ? stack[0] : 0u;
        uint newer = group;
        for (uint i = 0u; i + 1u < STACK_SIZE; ++i) {
            const uint older = i + 2u < STACK_SIZE ? stack[i + 1u] : 0u, here = stack[i];
            stack[i] = push ? newer : (pop ? older : here);
            newer = here;
        }
        return newest;
    }
    stack[stackTop] = group; // counts only where `push` keeps it
    stackTop += push ? 1u : 0u;
    const bool empty = stackTop == 0u;
    stackTop -= pop && !empty ? 1u : 0u;
    return empty ? 0u : stack[stackTop];
}
