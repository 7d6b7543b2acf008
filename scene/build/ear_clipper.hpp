#pragma once

#include "scene/build/corner_tree.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::build {

/// Triangulation by cutting off ears: corners that turn left and whose triangle holds no other
/// corner (G. H. Meisters, "Polygons have ears", 1975). Only corners that do not turn left can lie
/// in an ear's triangle (D. Eberly, "Triangulation by Ear Clipping"); they are kept in a tree, so
/// that polygons of many corners do not take quadratic time unless they are built to.
class EarClipper {
  public:
    /// `polygon`, of finite points, runs counter-clockwise and must outlive the clipper.
    explicit EarClipper(std::span<const glm::dvec2> polygon);

    /// Appends the triangles as corner numbers. Returns false if corners remain of which none is
    /// an ear, as when the polygon crosses itself; they are then cut as a fan.
    bool run(std::vector<std::array<uint32_t, 3>>& triangles);

  private:
    bool turnsLeft(uint32_t corner) const;
    bool isEar(uint32_t corner) const;
    bool blocks(uint32_t corner, uint32_t a, uint32_t b, uint32_t c) const;
    void update(uint32_t corner);
    bool clipAll(std::vector<std::array<uint32_t, 3>>& triangles);

    std::span<const glm::dvec2> points_;
    std::vector<uint32_t> previous_, next_; ///< the ring of corners that remain
    std::vector<bool> isReflex_;            ///< remains and does not turn left
    std::vector<bool> isGone_;
    uint32_t remaining_ = 0, start_ = 0;

    CornerTree reflex_; ///< the corners that isReflex_
};

} // namespace stromboli::build
