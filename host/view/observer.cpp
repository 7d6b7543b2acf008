#include "host/view/observer.hpp"

#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "host/film/shown_film.hpp"
#include "host/render/sampling_plan.hpp"

#include <fmt/format.h>

#include <exception>
#include <optional>
#include <utility>

namespace stromboli::view {

// --- Observers -----------------------------------------------------------------------------------

RenderResult Observers::run(RenderSession& session, SessionEvents events) {
    if (all_.empty()) return session.run(events);
    for (const auto& observer : all_)
        observer->beginPicture();
    const auto progress = std::move(events.progress);
    events.progress = [&](const RenderProgress& state) {
        const Next next = progress ? progress(state) : Next::GoOn;
        if (next != Next::GoOn) return next;
        bool isWanted = false;
        for (const auto& observer : all_)
            isWanted = observer->wants(state) || isWanted; // all hear the news
        return isWanted ? Next::Pause : Next::GoOn;
    };
    while (session.pass(events))
        look(session, false);
    look(session, true);
    return session.result();
}

void Observers::look(RenderSession& session, bool isOver) {
    for (auto observer = all_.begin(); observer != all_.end();) {
        try {
            (*observer)->look(session, isOver);
            ++observer;
        } catch (const std::exception& error) {
            tell(messages_, Severity::Warning,
                 fmt::format("{}: the render goes on without it", error.what()));
            observer = all_.erase(observer);
        }
    }
}

// --- A file --------------------------------------------------------------------------------------

namespace {

class UpdatedFile final : public Observer {
  public:
    UpdatedFile(std::filesystem::path file, double everySeconds, const ToneMapping& tone)
        : file_(std::move(file)), everySeconds_(everySeconds), tone_(tone) {}

    void beginPicture() override {
        sinceBegun_ = {};
        nextSeconds_ = 0;
    }
    bool wants(const RenderProgress& progress) override {
        return progress.samplesDone > 0 && sinceBegun_.seconds() >= nextSeconds_;
    }
    void look(RenderSession& session, bool isOver) override {
        if (!isOver && sinceBegun_.seconds() < nextSeconds_) return;
        const Film film = session.shownFilm();
        PictureFile picture(file_, film.area, {tone_, false, {}, {}});
        picture.place(film);
        picture.write();
        nextSeconds_ = sinceBegun_.seconds() + everySeconds_;
    }

  private:
    std::filesystem::path file_;
    double everySeconds_;
    ToneMapping tone_;
    Stopwatch sinceBegun_;
    double nextSeconds_ = 0;
};

} // namespace

std::unique_ptr<Observer> updatingFile(const std::filesystem::path& file, double everySeconds,
                                       const ToneMapping& tone) {
    if (!namesPicture(file) || !isToneMapped(file))
        throw UsageError(fmt::format("--update: '{}' is not the name of a picture for a screen "
                                     "(.png, .jpg, .webp)",
                                     file.string()));
    checkWritable(file);
    return std::make_unique<UpdatedFile>(file, everySeconds, tone);
}

} // namespace stromboli::view
