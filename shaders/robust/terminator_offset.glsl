/// How high the smooth surface that the corner normals speak of is over a point of the triangle, on
/// the side of `facing`, the geometric normal towards wo; 0 where it is below, or where the normals are
/// on both sides.
///
/// Lit from where it is flat, a coarse mesh shades itself in steps of the shape of its triangles, the
/// "shadow terminator". After Hanika, "Hacking the Shadow Terminator" (Ray Tracing Gems II, 2021),
/// reflected light leaves from the smooth surface instead. His height, what a point lacks to the
/// tangent planes of the corners, is a sum over the edges where the mesh is convex; taken by edges,
/// normals that are tilted but parallel do not lift (docs/theory/numerics.md, "Shading normals").
float liftAt(CornerNormals n, PlacedPrimitive at, vec3 b, vec3 facing) {
    const vec3 c = vec3(dot(n.n0, facing), dot(n.n1, facing), dot(n.n2, facing));
    const float least = min(c.x, min(c.y, c.z)), most = max(c.x, max(c.y, c.z));
    const float side = least > 0.0 ? 1.0 : (most < 0.0 ? -1.0 : 0.0);
    // An edge bulges by as much as its normals diverge.
    const vec3 bulge = side * vec3(dot(n.n0 - n.n1, at.v0 - at.v1), dot(n.n1 - n.n2, at.v1 - at.v2),
                                   dot(n.n2 - n.n0, at.v2 - at.v0));
    return max(dot(b.xyz * b.yzx, max(bulge, vec3(0.0))), 0.0);
}
