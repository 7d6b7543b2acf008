// In the place of shaders/robust/terminator_offset.glsl: light leaves from the flat triangle.
float liftAt(CornerNormals n, PlacedPrimitive at, vec3 b, vec3 facing) { return 0.0; }
