#include "host/render/team_backend.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <stdexcept>
#include <thread>

namespace stromboli {
namespace {

/// The first piece of a member whose speed nobody knows is so small a part of an equal share that
/// one which is a hundred times slower than the others does not keep them waiting.
constexpr double kFirstPart = 1.0 / 256;

/// From one piece of a member to the next, in time.
constexpr double kGrowth = 4;

} // namespace

PiecePlan::PiecePlan(size_t members, double leastSeconds)
    : paces_(members), leastSeconds_(leastSeconds) {}

/// The sum of the speeds of all members; one whose speed nobody knows counts as the mean of the
/// others.
double PiecePlan::speedOfAll() const {
    double speed = 0;
    size_t known = 0, count = 0;
    for (const Pace& p : paces_) {
        if (p.isOut) continue;
        ++count;
        if (!p.isKnown()) continue;
        speed += p.speed();
        ++known;
    }
    return speed * double(count) / double(known);
}

uint64_t PiecePlan::next(size_t member, uint64_t left) const {
    const Pace& own = paces_[member];
    double wanted = double(left) * kFirstPart / double(paces_.size());
    if (own.isKnown()) {
        const double halfOfTheRest = double(left) / speedOfAll() / 2;
        wanted = own.speed() *
                 std::min(std::max(halfOfTheRest, leastSeconds_), kGrowth * own.lastSeconds);
    }
    return std::clamp<uint64_t>(uint64_t(std::min(wanted, double(left))), 1, left);
}

void PiecePlan::took(size_t member, uint64_t samples, double seconds) {
    Pace& p = paces_[member];
    p.samples = p.samples / 2 + double(samples);
    p.seconds = p.seconds / 2 + seconds;
    p.lastSeconds = seconds;
}

void PiecePlan::dropOut(size_t member) {
    paces_[member].isOut = true;
}

namespace {

/// About what a dispatch takes (KernelTuning::targetSeconds): in a shorter piece the lanes of a
/// device would not be busy.
constexpr double kLeastSeconds = 0.1;

using Piece = std::span<const PixelTarget>;

/// From the first pixel of a piece to its last.
PixelRun runOf(Piece piece) {
    return {piece.front().pixel, piece.back().pixel - piece.front().pixel + 1};
}

} // namespace

struct TeamBackend::Player {
    size_t number;
    TeamMember member;
    bool isOut = false;
    // While it plays other threads see what it has published:
    std::atomic<uint64_t> paths{0}, rays{0};
    std::atomic<uint64_t> samplesOfPiece{0};

    void publish(uint64_t samples) {
        const RenderCounters counters = member.backend->counters();
        paths = counters.paths;
        rays = counters.rays;
        samplesOfPiece = samples;
    }
};

/// What is left of a pass, for all players.
class TeamBackend::Pass {
  public:
    Pass(Piece targets, const Film& film, PiecePlan& plan, size_t players)
        : plan_(plan), film_(film), ahead_(targets), playing_(players), present_(players) {
        const auto isBefore = [](const PixelTarget& a, const PixelTarget& b) {
            return a.pixel < b.pixel;
        };
        if (!std::is_sorted(targets.begin(), targets.end(), isBefore))
            throw std::logic_error("targets of several devices are not in the order of pixels");
        for (const PixelTarget& t : targets)
            left_ += samplesFor(t);
    }

    /// For a player that has nothing to do; empty: there is no more. Waits while pieces are under
    /// way that may come back.
    Piece take(size_t player) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] {
            return stops_ || !ahead_.empty() || !returned_.empty() || underWay_ == 0;
        });
        if (stops_ || (ahead_.empty() && returned_.empty())) return {};
        ++underWay_;
        if (!returned_.empty()) {
            const Piece piece = returned_.back();
            returned_.pop_back();
            return piece;
        }
        return cut(plan_.next(player, std::max<uint64_t>(left_, 1)));
    }

    void finished(size_t player, uint64_t samples, double seconds) {
        const std::lock_guard lock(mutex_);
        plan_.took(player, samples, seconds);
        done_ += samples;
        --underWay_;
        changed_.notify_all();
    }

    /// The player has dropped out, and others are to take its piece.
    void giveBack(size_t player, Piece piece, std::string message) {
        const std::lock_guard lock(mutex_);
        plan_.dropOut(player);
        returned_.push_back(piece);
        messages_.push_back(std::move(message));
        deviceError_ = std::current_exception();
        --underWay_;
        changed_.notify_all();
    }

    /// By an error that is not the device's.
    void fail() {
        const std::lock_guard lock(mutex_);
        if (!error_) error_ = std::current_exception();
        stops_ = true;
        --underWay_;
        changed_.notify_all();
    }

    void dropOut() { --present_; }

    void left() {
        const std::lock_guard lock(mutex_);
        --playing_;
        changed_.notify_all();
    }

    void stop() {
        const std::lock_guard lock(mutex_);
        stops_ = true;
        changed_.notify_all();
    }
    bool stops() const { return stops_; }
    /// Whether a device is left.
    bool isPlayed() const { return present_ > 0; }

    void wake() {
        const std::lock_guard lock(mutex_); // or the one who waits might not wait yet
        changed_.notify_all();
    }
    /// Waits until something has changed. False: nobody plays any more.
    bool wait(std::vector<std::string>& messages) {
        std::unique_lock lock(mutex_);
        if (playing_ > 0) changed_.wait(lock);
        messages.swap(messages_);
        return playing_ > 0;
    }

    uint64_t done() const { return done_; }
    const std::vector<Piece>& returned() const { return returned_; }

    /// Once nobody plays.
    void rethrow() const {
        if (error_) std::rethrow_exception(error_);
        const bool isComplete = ahead_.empty() && returned_.empty();
        if (!isComplete && !stops_) std::rethrow_exception(deviceError_);
    }

  private:
    uint64_t samplesFor(const PixelTarget& t) const {
        const uint64_t taken = film_.pixels[t.pixel].taken();
        return t.samples > taken ? t.samples - taken : 0;
    }

    Piece cut(uint64_t samples) {
        uint64_t taken = 0;
        size_t count = 0;
        while (count < ahead_.size() && taken < samples)
            taken += samplesFor(ahead_[count++]);
        const Piece piece = ahead_.first(count);
        ahead_ = ahead_.subspan(count);
        left_ -= taken;
        return piece;
    }

    PiecePlan& plan_;
    const Film& film_;
    std::mutex mutex_;
    std::condition_variable changed_;
    Piece ahead_;                 ///< that nobody has taken
    std::vector<Piece> returned_; ///< of players that have dropped out
    uint64_t left_ = 0;           ///< samples of `ahead_`
    std::atomic<uint64_t> done_{0};
    size_t underWay_ = 0, playing_;
    std::atomic<size_t> present_; ///< players that have not dropped out
    std::atomic<bool> stops_{false};
    std::vector<std::string> messages_;
    std::exception_ptr error_, deviceError_;
};

TeamBackend::TeamBackend(std::vector<TeamMember> members, const PictureArea& area,
                         std::function<void(const std::string&)> say)
    : kept_(members.front().backend->save({}, {})), plan_(members.size(), kLeastSeconds),
      say_(std::move(say)) {
    kept_.empty(area.pixelCount());
    for (TeamMember& m : members) {
        if (!m.backend->save({}, {}).sameKind(kept_))
            throw std::logic_error("devices of a team keep pixels in unequal ways");
        players_.push_back(std::make_unique<Player>(players_.size(), std::move(m)));
    }
}

TeamBackend::~TeamBackend() = default;

void TeamBackend::sample(Piece targets, Film& film, const PassProgress& progress) {
    if (targets.empty()) return;
    const std::vector<size_t> numbers = present();
    Pass pass(targets, film, plan_, numbers.size());
    {
        std::vector<std::jthread> threads;
        for (const size_t i : numbers)
            threads.emplace_back([&, i] { play(*players_[i], pass, film); });
        follow(pass, progress);
    }
    pass.rethrow();
    for (const Piece piece : pass.returned()) { // the pass was stopped before it was taken again
        const PixelRun run = runOf(piece);
        first().restore(run, kept_.part(run), film);
    }
}

/// Tells the caller how far the pass is until it ends.
void TeamBackend::follow(Pass& pass, const PassProgress& progress) {
    try {
        std::vector<std::string> messages;
        for (bool goesOn = true; goesOn;) {
            goesOn = pass.wait(messages);
            for (const std::string& message : messages)
                say_(message);
            messages.clear();
            uint64_t done = pass.done();
            for (const auto& player : players_)
                done += player->samplesOfPiece;
            if (progress && !progress(done)) pass.stop();
        }
    } catch (...) {
        pass.stop();
        throw;
    }
}

void TeamBackend::play(Player& player, Pass& pass, Film& film) {
    while (!player.isOut) {
        const Piece piece = pass.take(player.number);
        if (piece.empty()) break;
        try {
            takePiece(player, pass, piece, film);
        } catch (const DeviceError& error) {
            player.isOut = true;
            pass.dropOut();
            player.samplesOfPiece = 0;
            pass.giveBack(player.number, piece,
                          fmt::format("{} takes no more samples: {}{}", player.member.name,
                                      error.what(),
                                      pass.isPlayed() ? "; the others do its work again" : ""));
        } catch (...) {
            pass.fail();
            break;
        }
    }
    pass.left();
}

void TeamBackend::takePiece(Player& player, Pass& pass, Piece piece, Film& film) {
    const Stopwatch watch;
    const PixelRun run = runOf(piece);
    Backend& backend = *player.member.backend;
    backend.restore(run, kept_.part(run), film);
    uint64_t samples = 0;
    backend.sample(piece, film, [&](uint64_t done) {
        samples = done;
        player.publish(done);
        pass.wake();
        return !pass.stops();
    });
    kept_.put(run, backend.save(film, run));
    player.samplesOfPiece = 0;
    pass.finished(player.number, samples, watch.seconds());
}

std::vector<size_t> TeamBackend::present() const {
    std::vector<size_t> numbers;
    for (const auto& player : players_)
        if (!player->isOut) numbers.push_back(player->number);
    return numbers;
}

Backend& TeamBackend::first() const {
    const std::vector<size_t> numbers = present();
    if (numbers.empty()) throw DeviceLostError("no device is left");
    return *players_[numbers.front()]->member.backend;
}

SampleValue TeamBackend::sampleAlone(uint32_t pixel, uint32_t sample) {
    return first().sampleAlone(pixel, sample);
}

RenderCounters TeamBackend::counters() const {
    RenderCounters sum;
    for (const auto& player : players_) {
        sum.paths += player->paths;
        sum.rays += player->rays;
    }
    return sum;
}

void TeamBackend::beginAt(uint32_t firstSample) {
    kept_.empty(kept_.count());
    for (const size_t i : present())
        players_[i]->member.backend->beginAt(firstSample);
}

KeptPixels TeamBackend::save(const Film&, PixelRun run) {
    return kept_.part(run);
}

void TeamBackend::restore(PixelRun run, const KeptPixels& pixels, Film& film) {
    kept_.put(run, pixels);
    first().restore(run, pixels, film);
}

} // namespace stromboli
