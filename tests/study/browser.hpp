#pragma once

#include <filesystem>
#include <string>

namespace stromboli::study {

/// Whether there is a headless browser to test with: Debian's package chromium.
bool hasBrowser();

/// Loads a page without a network, runs `script` in it when it has loaded, and returns the
/// document's HTML. A script leaves what it found in attributes of the document's element.
std::string loadPage(const std::filesystem::path& folder, const std::string& page,
                     const std::string& script, bool dark);

/// The value of an attribute of the <html> element, its entities resolved; empty if there is none.
std::string attributeOf(const std::string& document, const std::string& name);

} // namespace stromboli::study
