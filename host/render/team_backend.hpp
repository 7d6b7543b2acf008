#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stromboli {

/// How much of a pass each of several backends takes next, by their speeds so far, so that all of
/// them end at about the same time: guided self-scheduling (Polychronopoulos and Kuck 1987) with
/// weights.
class PiecePlan {
  public:
    /// leastSeconds: what a piece takes at least. At the end a backend waits for about as long.
    PiecePlan(size_t members, double leastSeconds);

    /// Samples for a member that has nothing to do, of `left` (at least 1) that nobody has taken:
    /// half of its share of what is left, but not what should take four times as long as its last
    /// piece: of so much less work its speed is a poor guess.
    uint64_t next(size_t member, uint64_t left) const;

    /// The member has taken so many samples in that time.
    void took(size_t member, uint64_t samples, double seconds);
    /// The member takes no more.
    void dropOut(size_t member);

  private:
    struct Pace {
        double samples = 0, seconds = 0; ///< what was long ago counts for less
        double lastSeconds = 0;          ///< of its last piece
        bool isOut = false;

        bool isKnown() const { return samples > 0 && seconds > 0; }
        double speed() const { return samples / seconds; }
    };

    double speedOfAll() const;

    std::vector<Pace> paces_;
    double leastSeconds_;
};

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
    /// The members were made for the same picture of this area, by the same kind of backend, with
    /// the same number of strands, and have taken no sample yet. say: is told who drops out, on the
    /// caller's thread.
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
    KeptPixels save(const Film& film, PixelRun run) override;
    void restore(PixelRun run, const KeptPixels& pixels, Film& film) override;

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
    KeptPixels kept_; ///< all pixels, when nobody has them
    PiecePlan plan_;
    std::function<void(const std::string&)> say_;
};

} // namespace stromboli
