// Guided light samples (docs/theory/estimator.md, "Learned light samples"): what the kernel reads of what was learnt.
#ifndef STROMBOLI_SHARED_GUIDE_TYPES_H
#define STROMBOLI_SHARED_GUIDE_TYPES_H

#include "language.h"
#include "light_types.h"

SHARED_BEGIN

// Points where light samples are taken, by position and normal, are divided into cells by a tree of which each node has
// four children. The rows of the guide: the nodes, level by level from the root, then for each cell a table of
// GUIDE_TABLE_ROWS: TileColumns (light_types.h), then TileRatios.

/// Levels of the tree, and what follows from them.
SHARED_CONST uint GUIDE_LEVELS = 4u;
SHARED_CONST uint GUIDE_CELLS = 256u; ///< 4^GUIDE_LEVELS
SHARED_CONST uint GUIDE_NODES = 85u;  ///< 1 + 4 + 16 + 64

/// Cuts a cell in two, and each half again. A point is above a cut if its coordinate on the axis is larger. Axes 0 to 2
/// are those of the position, 3 to 5 those of the normal.
struct GuideNode {
    float cut, cutBelow, cutAbove;
    uint axes; ///< of the three cuts, in 8 bits each
};
SHARED_ROWS(GuideNode, 1);

/// How often samples go to tiles of the environment, over how often they do by weight alone: to a tile, to those on its
/// right and below, and to the one on the right of that below. The first tile of a row is on the right of the last.
struct TileRatios {
    float own, right, below, across;
};
SHARED_ROWS(TileRatios, 1);
SHARED_CONST uint GUIDE_TABLE_ROWS = ENVIRONMENT_COLUMN_ROWS + ENVIRONMENT_TILES;

SHARED_END

#endif
