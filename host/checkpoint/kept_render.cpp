#include "host/checkpoint/kept_render.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli {
namespace {

/// Adds the seconds that it lives to a sum.
class Timed {
  public:
    explicit Timed(double& sum) : sum_(sum) {}
    ~Timed() { sum_ += watch_.seconds(); }
    Timed(const Timed&) = delete;
    Timed& operator=(const Timed&) = delete;

  private:
    double& sum_;
    Stopwatch watch_;
};

} // namespace

KeptSession::KeptSession(KeptRender render, MakeBackend makeBackend, Say say)
    : render_(std::move(render)), makeBackend_(std::move(makeBackend)), say_(std::move(say)) {
    begin(false);
}

void KeptSession::begin(bool again) {
    const Timed preparing(result_.prepareSeconds);
    std::optional<SessionState> begun = render_.begun;
    if (written_) begun = readCheckpoint(render_.file).state;
    session_.reset();
    backend_.reset(); // before the memory of the next is asked for
    RenderSettings settings = render_.settings;
    if (begun) settings.strands = begun->pixels.strands;
    backend_ = makeBackend_(settings, again);
    if (begun)
        session_.emplace(*backend_, *begun);
    else
        session_.emplace(*backend_, settings);
    samplesBefore_ = session_->samplesDone();
}

bool KeptSession::isDue() const {
    return !render_.file.empty() && sinceLast_.seconds() >= render_.everySeconds;
}

/// A disk that is full costs the checkpoint, not the render: the old one stays.
void KeptSession::write() {
    sinceLast_ = {};
    try {
        if (!identity_) identity_ = render_.identity();
        writeCheckpoint(render_.file, {*identity_, session_->save()});
        written_ = true;
    } catch (const OutputError& error) {
        say_(fmt::format("no checkpoint: {}; the render goes on", error.what()));
    }
}

bool KeptSession::sample(const ProgressCallback& progress) {
    bool asked = false, due = false;
    const bool goesOn = session_->pass([&](const RenderProgress& state) {
        asked = progress && !progress(state);
        due = isDue();
        return !asked && !due;
    });
    if (asked) return true; // whoever asked says whether it goes on
    if (due || isDue()) write();
    return goesOn || due;
}

bool KeptSession::pass(const ProgressCallback& progress) {
    if (over_) return false;
    try {
        const Timed rendering(result_.renderSeconds);
        if (sample(progress)) return true;
        close(true);
        return false;
    } catch (const DeviceLostError& error) {
        recover(error.what());
    }
    return !over_;
}

/// The noise is known, and the file is left or removed.
void KeptSession::close(bool finished) {
    result_.outcome = session_->outcome();
    result_.stopped = !finished;
    if (!render_.file.empty()) {
        const bool hasFile = written_ || render_.begun;
        if (!finished || render_.keepsAtEnd) {
            // Where nothing was added, the file has all of it.
            if (session_->samplesDone() > samplesBefore_ || !render_.begun) write();
        } else if (hasFile) {
            std::error_code failed; // what cannot be removed does no harm
            removed_ = std::filesystem::remove(render_.file, failed);
        }
    }
    over_ = true;
}

/// After the first loss a new backend goes on; the second one is the end.
void KeptSession::recover(const std::string& why) {
    if (recovered_) {
        result_.lost = why;
        over_ = true;
        return;
    }
    recovered_ = true;
    say_(fmt::format("{}; once more, from {}", why,
                     written_ || render_.begun ? "the last checkpoint" : "the beginning"));
    begin(true);
}

void KeptSession::finish() {
    if (!over_) close(true);
}

const KeptOutcome& KeptSession::end() {
    while (!over_) {
        try {
            const Timed rendering(result_.renderSeconds);
            close(false);
        } catch (const DeviceLostError& error) {
            recover(error.what());
        }
    }
    result_.counters = backend_->counters();
    result_.fileIsThere = (written_ || render_.begun) && !removed_;
    return result_;
}

KeptOutcome renderKept(const KeptRender& render, const MakeBackend& makeBackend,
                       const ProgressCallback& progress, const KeptSession::Say& say) {
    KeptSession session(render, makeBackend, say);
    bool stopped = false;
    while (!stopped && session.pass([&](const RenderProgress& state) {
        stopped = progress && !progress(state);
        return !stopped;
    })) {
    }
    KeptOutcome outcome = session.end();
    outcome.film = std::move(session).takeFilm();
    return outcome;
}

} // namespace stromboli
