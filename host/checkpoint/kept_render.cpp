#include "host/checkpoint/kept_render.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// The file of a render, and when it is to be written.
class Keeper {
  public:
    Keeper(const KeptRender& render, const std::function<void(const std::string&)>& say)
        : render_(render), say_(say) {}

    bool isDue() const {
        return !render_.file.empty() && sinceLast_.seconds() >= render_.everySeconds;
    }
    /// There is a file to go on from.
    bool hasFile() const { return written_ || render_.begun; }

    /// A disk that is full costs the checkpoint, not the render: the old one stays.
    void write(const RenderSession& session) {
        sinceLast_ = {};
        try {
            if (!identity_) identity_ = render_.identity();
            writeCheckpoint(render_.file, {*identity_, session.save()});
            written_ = true;
        } catch (const OutputError& error) {
            say_(fmt::format("no checkpoint: {}; the render goes on", error.what()));
        }
    }

    /// Empty: the render has to begin anew.
    std::optional<SessionState> lastState() const {
        return written_ ? readCheckpoint(render_.file).state : render_.begun;
    }

    void end(const RenderSession& session, bool finished, bool hasMore) {
        if (render_.file.empty()) return;
        if (!finished || render_.keepsAtEnd) {
            if (hasMore || !render_.begun) write(session); // else the file has all of it
        } else if (hasFile()) {
            std::error_code failed; // what cannot be removed does no harm
            isRemoved_ = std::filesystem::remove(render_.file, failed);
        }
    }
    bool isThere() const { return hasFile() && !isRemoved_; }

  private:
    const KeptRender& render_;
    const std::function<void(const std::string&)>& say_;
    std::optional<RenderIdentity> identity_;
    bool written_ = false, isRemoved_ = false;
    Stopwatch sinceLast_;
};

/// Passes until there is no more to do. False if `progress` said stop.
bool runPasses(RenderSession& session, Keeper& keeper, const ProgressCallback& progress) {
    for (;;) {
        bool stopped = false, due = false;
        const bool goesOn = session.pass([&](const RenderProgress& state) {
            stopped = progress && !progress(state);
            due = keeper.isDue();
            return !stopped && !due;
        });
        if (stopped) return false;
        if (due || keeper.isDue()) keeper.write(session);
        if (!goesOn && !due) return true;
    }
}

} // namespace

KeptOutcome renderKept(const KeptRender& render, const MakeBackend& makeBackend,
                       const ProgressCallback& progress,
                       const std::function<void(const std::string&)>& say) {
    Keeper keeper(render, say);
    KeptOutcome result;
    std::optional<SessionState> begun = render.begun;
    for (bool again = false;; again = true) {
        const Stopwatch preparing;
        const std::shared_ptr<Backend> backend = makeBackend(render.settings, again);
        RenderSession session =
            begun ? RenderSession(*backend, *begun) : RenderSession(*backend, render.settings);
        const uint64_t samplesBefore = session.samplesDone();
        result.prepareSeconds += preparing.seconds();
        const Stopwatch rendering;
        try {
            result.stopped = !runPasses(session, keeper, progress);
            result.outcome = session.outcome();
            keeper.end(session, !result.stopped, session.samplesDone() > samplesBefore);
        } catch (const DeviceLostError& error) {
            if (!again) {
                result.renderSeconds += rendering.seconds();
                begun = keeper.lastState();
                say(fmt::format("{}; once more, from {}", error.what(),
                                begun ? "the last checkpoint" : "the beginning"));
                continue;
            }
            result.lost = error.what();
        }
        result.renderSeconds += rendering.seconds();
        result.counters = backend->counters();
        result.film = std::move(session).takeFilm();
        result.fileIsThere = keeper.isThere();
        return result;
    }
}

} // namespace stromboli
