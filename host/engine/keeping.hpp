#pragma once

#include "host/checkpoint/kept_render.hpp"
#include "host/engine/load_scene.hpp"
#include "host/engine/render_request.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// Where a render keeps its state, and what it goes on from.
struct Keeping {
    std::string file;         ///< empty: nowhere
    double everySeconds = 60; ///< from one checkpoint to the next
    bool keepsAtEnd = false;  ///< also of a render that is finished
    /// To go on from: the state of the whole picture, or of the first band that has one.
    std::optional<Checkpoint> begun;
    uint32_t bands = 0; ///< `begun` is one of so many bands, each in its bandFile(); 0: of no band
};

/// Adds what the file has to go on from. Says so, and begins anew, if there is nothing.
/// Throws UsageError if it cannot be used.
Keeping takeUp(Keeping keeping, const Listener& listener = {});

/// The request with what has to be as it was when the render began and is not asked for otherwise.
/// Throws UsageError if that does not go together.
RenderRequest toGoOn(RenderRequest request, const Keeping& keeping);

/// The bands to render, of at most so many pixels each; where checkpoints are of bands, the same
/// ones. Throws UsageError if what was begun does not fit.
std::vector<PictureArea> bandsToRender(const PictureArea& area, uint64_t mostPixels,
                                       const Keeping& keeping, const Listener& listener);

/// Where a band of so many is kept, and what it goes on from.
Keeping keepingOfBand(const Keeping& keeping, size_t band, size_t count);

/// Removes the checkpoints of an earlier render in the place of those of this one, of `bands`
/// bands.
void forgetEarlier(const std::string& file, size_t bands);

/// The render of a picture or of a band of it by its settings. Throws UsageError if the checkpoint
/// is of another one.
KeptRender keptRender(const RenderSettings& settings, const Keeping& keeping,
                      std::function<RenderIdentity()> identity, const std::string& device,
                      const Listener& listener);

} // namespace stromboli
