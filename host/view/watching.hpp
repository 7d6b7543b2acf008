#pragma once

#include "host/view/exchange.hpp"
#include "host/view/observer.hpp"

#include <memory>
#include <string>

namespace stromboli::view {

/// Makes frames of the render for pages that look at it by this exchange, which outlives it. Pages
/// change nothing. `name`: of the scene.
std::unique_ptr<Observer> watching(Exchange& exchange, std::string name);

} // namespace stromboli::view
