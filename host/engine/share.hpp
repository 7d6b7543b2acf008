#pragma once

#include "host/engine/render_session.hpp"
#include "host/farm/film_header.hpp"
#include "host/farm/round_plan.hpp"

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// What a film says of the picture that it is a part of, beside its settings.
struct FilmOrigin {
    std::string scene;                ///< as it was asked for
    std::vector<std::string> command; ///< that renders the picture in one go
};

/// Part of the samples of all pixels of a picture, or of a plan, as a film.
struct ShareRequest {
    ShareName share;
    std::optional<RoundPlan> plan; ///< of a round after the first
    std::string planFile;          ///< its name, for messages
    FilmOrigin origin;
    std::string film;       ///< the file to write
    bool keepsFilm = false; ///< that is there already, from an earlier run
};

/// A word for scene, camera and program: another word, another picture.
std::string fingerprintOf(const Scene& scene, const Camera& camera);
/// Throws SceneError that names `source`, or UsageError for the program, if another one than this
/// is expected.
void requireFingerprint(const std::string& expected, const Scene& scene, const Camera& camera,
                        const std::string& source);

/// A film of the whole picture, before it has samples, by a backend and device of these names.
FilmHeader headerOfPicture(const Scene& scene, const ResolvedPicture& picture,
                           const RenderRequest& request, const FilmOrigin& origin,
                           const std::string& backend, const std::string& device);

/// What came of a share.
struct ShareResult {
    RenderResult render;
    double writeSeconds = 0;
    bool wasThere = false; ///< and nothing was done
};

/// Takes the samples of the share, band by band, and writes its film: all of it or, where progress
/// says Cancel, none. What of an earlier film cannot be read is said and taken anew. Throws
/// UsageError if the plan, or the film that is there, is of another picture or share, DeviceError,
/// OutputError.
ShareResult takeShare(Renderer& renderer, std::shared_ptr<const Scene> scene,
                      const ResolvedPicture& picture, const RenderRequest& request,
                      const ShareRequest& share, const SessionEvents& events = {},
                      const Listener& listener = {});

} // namespace stromboli
