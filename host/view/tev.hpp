#pragma once

#include "host/view/observer.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>

namespace stromboli::view {

// The image viewer tev (github.com/Tom94/tev) shows what it is sent over TCP: packets of a length
// of 32 bits, which counts itself, a byte that says what it is, and what belongs to that; all in
// little-endian order, text ending in NUL.

/// Makes a picture of R, G and B in tev, in place of one of that name.
std::string tevCreate(const std::string& name, uint32_t width, uint32_t height);
/// All values of that picture, three for each pixel, rows from the top.
std::string tevUpdate(const std::string& name, uint32_t width, uint32_t height,
                      std::span<const float> values);

/// Sends the picture to a tev that listens at "HOST:PORT", on a thread of its own: one that is not
/// there, slow or gone delays nothing, and is tried again. Throws UsageError if `address` is none.
std::unique_ptr<Observer> sendingToTev(const std::string& address, const std::string& name,
                                       double everySeconds);

} // namespace stromboli::view
