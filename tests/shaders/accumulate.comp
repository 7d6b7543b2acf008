#version 460
#extension GL_GOOGLE_include_directive : require
// Adds samples to pixels: each query is a pixel's state and the samples it gets.
#include "prelude.glsl"

QUERIES_AND_ANSWERS(AccumulateQuery, AccumulateAnswer)

AccumulateAnswer answer(AccumulateQuery q) {
    AccumulateAnswer a = AccumulateAnswer(q.state, q.naiveSum, 0u);
    for (uint i = 0u; i < q.count; ++i) {
        vec3 x = (i & 1u) == 0u ? q.even : q.odd;
        if (q.random != 0u) // a heavy tail: most of the sum is in few samples
            x = q.even / (1.0 - randomBlock(q.random, a.state.count, 0u, 0u).xyz);
        if (i == q.injectAt) x = q.injected;
        addSample(a.state, x, 1.0);
        a.naiveSum += x;
    }
    return a;
}
