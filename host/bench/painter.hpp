#pragma once

#include "host/bench/alternate.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stromboli::bench {

/// A renderer and the picture it goes on with from measurement to measurement.
class Painter {
  public:
    /// What a measurement is divided by.
    enum class Item { Path, Ray };

    Painter(std::string name, std::unique_ptr<Backend> backend, const RenderSettings& settings,
            Item item = Item::Path);

    const std::string& name() const { return name_; }
    const Film& film() const { return film_; }
    const Backend& backend() const { return *backend_; }
    /// As many samples of every pixel as the settings say.
    Work goOn();

  private:
    double deviceSeconds() const;

    std::string name_;
    std::unique_ptr<Backend> backend_;
    RenderSettings settings_;
    Item item_;
    uint32_t samples_ = 0;
    Film film_;
};

/// In turn, each measurement as long as it is, so that all pictures have the same samples.
std::vector<Series> race(std::vector<Painter>& painters, AlternatePlan plan);

} // namespace stromboli::bench
