#pragma once

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/system.hpp"
#include "host/film/film.hpp"
#include "host/render/sampling_session.hpp"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace stromboli {

/// Makes the backend of the settings, or makes one ready for them that others hold too; `again`:
/// the last one's device was lost.
using MakeBackend = std::function<std::shared_ptr<Backend>(const RenderSettings&, bool again)>;

/// A render whose state is put into a file now and then.
struct KeptRender {
    /// Asked for when the first checkpoint is written: most renders write none, and to read the
    /// whole scene and program for one takes time.
    std::function<RenderIdentity()> identity;
    RenderSettings settings;
    std::optional<SessionState> begun; ///< goes on from there
    std::filesystem::path file;        ///< empty: nowhere
    double everySeconds = 60;          ///< from one checkpoint to the next, and to the first
    bool keepsAtEnd = false;           ///< else the file is removed when the render is finished
};

/// What came of it.
struct KeptOutcome {
    Film film;
    RenderOutcome outcome;
    RenderCounters counters;         ///< of this run
    double prepareSeconds = 0;       ///< making backends
    double renderSeconds = 0;        ///< passes, with the checkpoints between them
    bool stopped = false;            ///< before it was finished
    bool fileIsThere = false;        ///< one can go on from it
    std::optional<std::string> lost; ///< what the device said when it was lost for the second time
};

/// A picture in the making that survives: its state is put into a file now and then, and where its
/// device is lost, a new backend goes on from the last checkpoint, or from the beginning where
/// there is none.
class KeptSession {
  public:
    using Say = std::function<void(const std::string&)>;

    /// Makes the backend. say: gets a line about checkpoints that fail and devices that are lost.
    KeptSession(KeptRender render, MakeBackend makeBackend, Say say);

    /// Takes samples until a pass is done, a checkpoint is written, or `progress` returns false,
    /// after which the next call goes on. False: there is no more to do, or the device was lost for
    /// the second time. Throws OutputError if a checkpoint cannot be written before there is one.
    bool pass(const ProgressCallback& progress = {});

    /// The picture so far; not during pass().
    const Film& film() const { return session_->film(); }
    /// What is known of its noise.
    RenderOutcome outcome() const { return session_->outcome(); }
    std::vector<glm::dvec3> squaredErrors() const { return session_->squaredErrors(); }
    bool isBetweenPasses() const { return session_->isBetweenPasses(); }
    uint64_t samplesDone() const { return session_->samplesDone(); }
    const KeptRender& render() const { return render_; }
    /// All that another session needs to go on with the same bytes.
    SessionState save() const { return session_->save(); }

    /// The render is finished, although its budget is not used up.
    void finish();
    /// Ends the render, finished or not, and says what came of it, without the film. Where it is
    /// not finished, the file keeps its state.
    const KeptOutcome& end();
    Film takeFilm() && { return std::move(*session_).takeFilm(); }

  private:
    void begin(bool again);
    bool sample(const ProgressCallback& progress);
    void close(bool finished);
    void recover(const std::string& why);
    void write();
    bool isDue() const;

    KeptRender render_;
    MakeBackend makeBackend_;
    Say say_;
    std::optional<RenderIdentity> identity_;
    std::shared_ptr<Backend> backend_;
    std::optional<SamplingSession> session_;
    uint64_t samplesBefore_ = 0; ///< of the sessions that this one continues
    Stopwatch sinceLast_;        ///< checkpoint
    bool written_ = false, removed_ = false;
    bool recovered_ = false; ///< from a loss
    bool over_ = false;
    KeptOutcome result_;
};

/// Passes until the render is finished, `progress` says stop, or the device is lost twice. What was
/// sampled before a stop or a second loss is in the film.
KeptOutcome renderKept(const KeptRender& render, const MakeBackend& makeBackend,
                       const ProgressCallback& progress, const KeptSession::Say& say);

} // namespace stromboli
