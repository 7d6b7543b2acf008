/// Widening of a box's far end: 1 + 2^-18 = 1 + 64 u (docs/theory/numerics.md, "Boxes": 33 u are needed for the two
/// ends of a slab, 40 u against the distance of a primitive).
const float BOX_SLACK = 1.000003814697265625;
