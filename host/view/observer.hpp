#pragma once

#include "host/core/messages.hpp"
#include "host/core/system.hpp"
#include "host/engine/render_session.hpp"
#include "host/film/tone_mapping.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace stromboli::view {

/// Looks at a render that somebody else runs, between its passes. It changes nothing: the bytes of
/// the picture do not depend on who looks.
class Observer {
  public:
    virtual ~Observer() = default;
    /// Another picture has begun in the session.
    virtual void beginPicture() {}
    /// News of the render, on its thread. True: a pass is to be paused, for look().
    virtual bool wants(const RenderProgress& progress) = 0;
    /// The session is between two passes, or its picture is over.
    virtual void look(RenderSession& session, bool isOver) = 0;
};

/// Several of them, none of which can stop the render: who fails is left out, which is said once.
class Observers {
  public:
    explicit Observers(Messages messages) : messages_(std::move(messages)) {}
    void add(std::unique_ptr<Observer> observer) { all_.push_back(std::move(observer)); }
    bool isEmpty() const { return all_.empty(); }

    /// Runs the picture that the session has begun to its end, as RenderSession::run() does.
    RenderResult run(RenderSession& session, SessionEvents events);

  private:
    void look(RenderSession& session, bool isOver);

    Messages messages_;
    std::vector<std::unique_ptr<Observer>> all_;
};

/// Rewrites a picture file, complete at every moment, while the render goes on, and at its end:
/// for programs that show a file anew when it has changed. Throws UsageError if the name is not
/// that of a picture for a screen, OutputError where nothing can be written.
std::unique_ptr<Observer> updatingFile(const std::filesystem::path& file, double everySeconds,
                                       const ToneMapping& tone);

} // namespace stromboli::view
