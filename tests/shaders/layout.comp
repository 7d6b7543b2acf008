#version 460
#extension GL_GOOGLE_include_directive : require
// Writes back every field of every structure of shaders/shared, in the order of its declaration;
// the index of each is 1, so that the stride counts too.
#include "prelude.glsl"

layout(set = 0, binding = BINDING_WORK_ITEMS, std430) readonly buffer WorkBuffer {
    WorkItem workItems[];
};
layout(set = 0, binding = BINDING_PIXELS, std430) buffer PixelBuffer { PixelState pixels[]; };
layout(set = 0, binding = BINDING_SUSPENDED, std430) buffer SuspendedBuffer {
    SuspendedPath suspendedPaths[];
};
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(set = 0, binding = BINDING_ANSWERS, std430) buffer AnswerBuffer { uint words[]; };

uint written = 0u;
void put(uint x) { words[written++] = x; }
void put(float x) { put(floatBitsToUint(x)); }
void put(vec3 v) {
    put(v.x);
    put(v.y);
    put(v.z);
}

void putScene() {
    const Node n = fetchNode(1u);
    put(n.leftLow), put(n.left), put(n.leftHigh), put(n.right);
    put(n.rightLow), put(n.unused0), put(n.rightHigh), put(n.unused1);
    const Primitive p = fetchPrimitive(1u);
    put(p.v0), put(p.material), put(p.v1), put(p.normals), put(p.v2), put(p.kind);
    const NormalTriple t = fetchNormals(1u);
    put(t.n0), put(t.n1), put(t.n2), put(t.unused);
    const Material m = fetchMaterial(1u);
    put(m.reflectance), put(m.kind), put(m.emission), put(m.emitsBothSides);
    put(m.transmittanceOrEta), put(m.iorOrAlpha), put(m.k), put(m.unused);
    const Light l = fetchLight(1u);
    put(l.position), put(l.kind), put(l.edgeA), put(l.area), put(l.edgeB), put(l.bothSides);
    put(l.color), put(l.upperHemisphereOnly);
    put(l.firstEntry), put(l.entryCount), put(l.cosCutoff), put(l.falloffExponent);
    const EmitterEntry e = fetchEmitterEntry(1u);
    put(e.primitive), put(e.alias), put(e.threshold), put(e.unused);
}

void putFrame() {
    put(frame.cameraPosition), put(frame.width), put(frame.cameraRight), put(frame.height);
    put(frame.cameraUp), put(frame.cropX), put(frame.cameraBack), put(frame.cropY);
    put(frame.nearDistance), put(frame.farDistance), put(frame.cropWidth), put(frame.seed);
    put(frame.minBounce), put(frame.maxBounces), put(frame.terminationProbability);
    put(frame.lightSamples), put(frame.areaLights), put(frame.deltaLights);
    put(frame.areaSamples), put(frame.unused);
}

void putWork() {
    put(dispatch.itemCount), put(dispatch.segmentBase), put(dispatch.softIterations);
    put(dispatch.hardIterations);
    put(workItems[1].pixel), put(workItems[1].target);
    const PixelState s = pixels[1];
    put(s.sum), put(s.count), put(s.sumError), put(s.rejected), put(s.m2), put(s.firstRejected);
    put(s.m2Error), put(s.unused);
    const SuspendedPath p = suspendedPaths[1];
    put(p.origin), put(p.bounce), put(p.direction), put(p.skipPrimitive), put(p.throughput);
    put(p.countsEmission), put(p.radiance), put(p.unused);
    put(status.unfinishedItems), put(status.overflowedItems), put(status.rays);
    put(status.samples);
}

void main() {
    if (gl_GlobalInvocationID.x != 0u) return;
    putScene();
    putFrame();
    putWork();
    pixels[2] = pixels[1]; // as the kernel stores whole structures
    suspendedPaths[2] = suspendedPaths[1];
}
