#pragma once

#include "host/film/picture_area.hpp"
#include "host/render/backend.hpp"
#include "host/render/piece_plan.hpp"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stromboli {

/// One of several backends that share the work.
struct TeamMember {
    std::string name; ///< for messages
    std::shared_ptr<Backend> backend;
};

/// Takes samples with several backends at once, each on a thread of its own. A pass is cut into
/// runs of pixels; a backend that has nothing to do takes the next one, and with it the statistics
/// that its pixels have so far. So each pixel's samples are added up in their order, whoever takes
/// them: backends that take the same samples to the last bit make the same film together as alone.
///
/// A backend that throws a DeviceError drops out for good, and others take its run again.
class TeamBackend final : public Backend {
  public:
    /// The members were made for the same picture of this area, by the same kind of backend, and
    /// have taken no sample yet. say: is told who drops out, on the caller's thread.
    TeamBackend(std::vector<TeamMember> members, const PictureArea& area,
                std::function<void(const std::string&)> say);
    ~TeamBackend() override;

    /// The targets are in the order of their pixels. Throws the DeviceError of the last member if
    /// all of them have dropped out.
    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override;
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override;
    RenderCounters counters() const override;
    void beginAt(uint32_t firstSample) override;
    std::vector<PixelSums> save(const Film& film, PixelRun run) override;
    void restore(PixelRun run, std::span<const PixelSums> sums, Film& film) override;

    /// Those that have not dropped out, by their numbers.
    std::vector<size_t> present() const;

  private:
    class Pass;
    struct Player;

    void play(Player& player, Pass& pass, Film& film);
    void takePiece(Player& player, Pass& pass, std::span<const PixelTarget> piece, Film& film);
    void follow(Pass& pass, const PassProgress& progress);
    Backend& first() const;

    std::vector<std::unique_ptr<Player>> players_;
    std::vector<PixelSums> sums_; ///< of all pixels, when nobody has them
    PiecePlan plan_;
    std::function<void(const std::string&)> say_;
};

} // namespace stromboli
