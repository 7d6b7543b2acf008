#pragma once

#include "scene/mitsuba/context.hpp"
#include "scene/model/medium.hpp"

#include <map>

namespace stromboli::mitsuba {

/// What is on the two sides of a shape.
struct Sides {
    const Plugin *inside = nullptr, *outside = nullptr; ///< media of the file; null: none
    const Plugin* under = nullptr; ///< what scatters under the surface, in place of `inside`

    bool areStated() const { return inside || outside; }
    auto operator<=>(const Sides&) const = default;
};

/// By its children named interior and exterior, and by a subsurface.
Sides sidesOf(const Plugin& shape);

/// The media of a scene, each made when something is in contact with it.
class Media {
  public:
    explicit Media(Context& context) : context_(context) {}

    /// The number of a medium; kNoMedium for null.
    uint32_t of(const Plugin* medium);
    /// What a subsurface of 0.x scatters with, as a medium under the surface: kNoMedium where it
    /// cannot be read, else `surface` becomes its interface, as rough as it was.
    uint32_t under(const Plugin& subsurface, Material& surface);

  private:
    Medium make(const Plugin& plugin);
    Medium makeUnder(const Plugin& plugin);

    Context& context_;
    std::map<const Plugin*, uint32_t> made_;
};

} // namespace stromboli::mitsuba
