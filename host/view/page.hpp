#pragma once

#include <string>

namespace stromboli::view {

/// What a page is told when it is opened.
struct PageFacts {
    std::string token; ///< that its requests show
    std::string nonce; ///< of its script and its style (Content-Security-Policy)
    bool readOnly = false;
    std::string view = "standard", exposure = "auto"; ///< to begin with
    bool denoised = false;
    bool hasReference = false; ///< the server has a picture to compare with
};

/// The page: one document, which fetches nothing but what this server has.
std::string pageText(const PageFacts& facts);

/// What the page may do: the header Content-Security-Policy.
std::string contentPolicy(const std::string& nonce);

} // namespace stromboli::view
