#pragma once

#include <string>

namespace stromboli::build {

/// The text that gzip made such bytes of; bytes that are not gzip's stay as they are. Throws
/// SceneError for damaged ones, and for texts that do not fit in the machine's memory.
std::string gunzipped(std::string bytes, const std::string& file);

} // namespace stromboli::build
