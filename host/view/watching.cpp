#include "host/view/watching.hpp"

#include "host/core/error.hpp"
#include "host/view/showing.hpp"

#include <optional>
#include <utility>

namespace stromboli::view {
namespace {

class Watching final : public Observer, public Answers {
  public:
    Watching(Exchange& exchange, std::string name) : exchange_(exchange), name_(std::move(name)) {}

    void beginPicture() override {
        ++epoch_;
        if (showing_) showing_->beginPicture();
    }
    bool wants(const RenderProgress& progress) override {
        progress_ = progress;
        const bool isDue = showing_ ? showing_->isDue() : exchange_.isAwaited();
        return progress.samplesDone > 0 && (isDue || exchange_.isAsked());
    }
    void look(RenderSession& session, bool isOver) override {
        if (!showing_) showing_.emplace(session, exchange_);
        if (isOver || showing_->isDue()) showing_->show(stateOf(session, isOver), isOver);
        exchange_.answer(*this);
    }

    Reply probe(uint32_t x, uint32_t y) override {
        return {200, "application/json", showing_->source().probe(x, y), ""};
    }
    Reply save(const SaveRequest& request) override {
        const bool isPng = request.format == SaveRequest::Format::Png;
        return {200, isPng ? "image/png" : "image/x-exr", showing_->source().file(request, {}),
                isPng ? "view.png" : "view.exr"};
    }
    Reply command(const ToneWords&, bool) override {
        throw UsageError("the command is the one that renders: the picture's notes have it");
    }

  private:
    ShownState stateOf(RenderSession& session, bool isOver) const {
        ShownState s;
        s.scene = name_;
        s.epoch = epoch_;
        s.fullWidth = session.film().width;
        s.fullHeight = session.film().height;
        s.state = isOver ? "done" : "rendering";
        s.share = isOver ? 1 : progress_.share;
        const double seconds = showing_->secondsOfPicture();
        s.raysPerSecond = seconds > 0 ? double(progress_.counters.rays) / seconds : 0;
        s.readOnly = true;
        return s;
    }

    Exchange& exchange_;
    std::string name_;
    std::optional<Showing> showing_;
    RenderProgress progress_;
    uint64_t epoch_ = 0;
};

} // namespace

std::unique_ptr<Observer> watching(Exchange& exchange, std::string name) {
    return std::make_unique<Watching>(exchange, std::move(name));
}

} // namespace stromboli::view
