#pragma once

#include "host/core/messages.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/tone_mapping.hpp"
#include "host/view/exchange.hpp"
#include "host/view/frame.hpp"

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace stromboli::view {

/// The tone mapping that the words mean. Throws UsageError if they are none that the options take.
ToneMapping toneOf(const ToneWords& words);

/// Reads what pages want to see of the picture that a session makes; not during a pass. What does
/// not depend on the samples is kept until the next picture.
class PictureSource {
  public:
    /// The session outlives it.
    explicit PictureSource(RenderSession& session) : session_(session) {}

    /// What is kept is of an earlier picture.
    void beginPicture() { layers_.reset(); }
    /// Throws std::logic_error before the first sample. isUnwanted: may be asked several times a
    /// second; where it says so, the raster is empty.
    Raster raster(Shown what, const std::function<bool()>& isUnwanted = {});
    /// What is known of a pixel, as JSON: radiance, noise, samples, albedo, normal, depth, object
    /// and material. The place is that in the part that is rendered. Throws UsageError outside.
    std::string probe(uint32_t x, uint32_t y);
    /// The bytes of a picture file. Throws OutputError, UsageError.
    std::string file(const SaveRequest& request, const PictureNotes& notes);

  private:
    const FloatImage& layers();

    RenderSession& session_;
    std::optional<FloatImage> layers_;
};

} // namespace stromboli::view
