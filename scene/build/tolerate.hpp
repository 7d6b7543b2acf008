#pragma once

#include "host/core/error.hpp"
#include "scene/build/report.hpp"

#include <utility>

namespace stromboli::build {

/// What is wrong with the command line rather than with the file: it is an error however
/// forgivingly the file is read.
class UnusableScene : public SceneError {
  public:
    explicit UnusableScene(const SceneError& error) : SceneError(error) {}
};

/// The net around everything that can be left out of a scene: what `read` throws is said, as the
/// table of kinds says what becomes of it, and false is returned.
template <class Read>
bool tolerate(Report& report, Shortfall kind, Read&& read) {
    try {
        std::forward<Read>(read)();
        return true;
    } catch (const UnusableScene&) {
        throw;
    } catch (const Error& error) {
        report.replace(error, kind);
        return false;
    }
}

} // namespace stromboli::build
