#pragma once

#include "host/view/frame.hpp"

#include <glm/glm.hpp>

#include <array>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace stromboli::view {

// --- What pages ask for --------------------------------------------------------------------------

/// A view that somebody has steered to: what --look-from, --look-at, --fov, --aperture and --focus
/// say, in the units of these options.
struct Pose {
    glm::dvec3 from{0.0}, at{0.0}; ///< metres, in the scene's coordinates
    double fieldOfView = 40;       ///< degrees, over the height of the picture
    double aperture = 0;           ///< diameter of the lens, metres; 0: a pinhole
    double focus = 1;              ///< metres, along the view axis

    bool operator==(const Pose&) const = default;
};

/// Where the sun of a sky stands, as --sun says it: degrees.
struct SunPlace {
    double azimuth = 0, elevation = 45;

    bool operator==(const SunPlace&) const = default;
};

/// What is to change; what is empty stays as it is.
struct Steering {
    std::optional<Pose> pose;
    std::optional<size_t> fileCamera; ///< its place in Scene::cameras
    std::optional<bool> moving;       ///< more will follow at once
    std::optional<bool> paused;
    std::optional<double> turn; ///< of the environment, as --env-rotate: degrees
    std::optional<SunPlace> sun;
    /// A set of materials of the file, its place in Scene::variants; negative: the file's own.
    std::optional<int> variant;
    std::optional<double> seconds; ///< of the file's animation; negative: what stands without it

    bool operator==(const Steering&) const = default;
    bool isEmpty() const { return *this == Steering(); }
    /// What comes later takes the place of what was before.
    void add(const Steering& later);
};

/// How radiance becomes a picture for a screen, in the words of the options of that name.
struct ToneWords {
    std::string view = "standard";
    std::string exposure = "0"; ///< a number, or auto
};

/// A file that is asked for.
struct SaveRequest {
    enum class Format { Png, Exr } format = Format::Png;
    ToneWords tone;
    bool denoised = false;
};

/// An answer to a page.
struct Reply {
    int status = 200;
    std::string type = "text/plain"; ///< of the body
    std::string body;
    std::string fileName; ///< under which the page saves it; empty: it does not
};

/// Whoever renders answers these, between two passes. Any may throw UsageError.
class Answers {
  public:
    virtual ~Answers() = default;
    /// What is known of a pixel of the picture; JSON.
    virtual Reply probe(uint32_t x, uint32_t y) = 0;
    virtual Reply save(const SaveRequest& request) = 0;
    /// The command line that makes the picture.
    virtual Reply command(const ToneWords& tone, bool denoised) = 0;
};
using Question = std::function<Reply(Answers&)>;

// --- The place where they meet -------------------------------------------------------------------

/// Between the threads of a server, which speak with pages, and the one that renders, which waits
/// for nobody: pages take the latest frame whenever they are ready, so that a slow one misses
/// frames and delays nothing.
class Exchange {
  public:
    static constexpr size_t kMostWaiting = 12;   ///< pages that wait for a frame at the same time
    static constexpr size_t kMostQuestions = 16; ///< that wait for an answer

    // Servers; any thread.

    /// Waits for a frame of this kind with a number above `after`, for so many seconds. Null: there
    /// was none in time, or it is over (isClosed()).
    std::shared_ptr<const std::string> frameAfter(Shown shown, uint64_t after, double seconds);
    /// False: too many wait already, and this one must not.
    bool mayWait() const;
    /// The answer, or one that says that there is none (503, 504).
    Reply ask(Question question, double seconds);
    void steer(const Steering& steering);

    // Who renders; one thread.

    static constexpr double kRecently = 1; ///< seconds

    /// What somebody waits for, or has waited for just now: who draws a frame asks for the next one
    /// a moment later.
    std::array<bool, kNamedValues<Shown>.size()> awaited() const;
    bool isAwaited() const;
    /// Somebody waits for what there is no frame of yet.
    bool lacksAFrame() const;
    bool isSteered() const;
    bool isAsked() const;
    /// What has been asked for since the last call.
    Steering takeSteering();
    /// Answers the questions that wait, but for those that were asked after steering which has not
    /// been taken yet: who steers and then asks is told of what was steered to. What an answer
    /// throws becomes one that says so.
    void answer(Answers& answers);
    void publish(Shown shown, uint64_t number, std::shared_ptr<const std::string> frame);
    /// Frames that are there are of an earlier picture or of fewer samples.
    void forgetFrames();
    /// Waits until somebody steers, asks, or lacks a frame; for so many seconds at most.
    void waitForWork(double seconds);
    /// Nobody renders any more: who waits is sent away, now and later.
    void close();
    bool isClosed() const;

  private:
    struct Slot {
        uint64_t number = 0;
        std::shared_ptr<const std::string> frame;
        size_t waiting = 0;
        std::optional<std::chrono::steady_clock::time_point>
            left; ///< when one last stopped to wait
        bool isAwaited() const;
    };
    struct Asked {
        Question question;
        uint64_t steerings = 0; ///< that came before it
        std::optional<Reply> reply;
    };
    bool hasWork() const; ///< the mutex is held

    mutable std::mutex mutex_;
    std::condition_variable forServers_, forRenderer_;
    std::array<Slot, kNamedValues<Shown>.size()> slots_;
    std::deque<std::shared_ptr<Asked>> asked_;
    Steering steering_;
    uint64_t steerings_ = 0, steeringsTaken_ = 0; ///< how many, since the beginning
    bool closed_ = false;
};

} // namespace stromboli::view
