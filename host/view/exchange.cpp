#include "host/view/exchange.hpp"

#include "host/core/error.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

namespace stromboli::view {
namespace {

std::chrono::steady_clock::time_point in(double seconds) {
    return std::chrono::steady_clock::now() +
           std::chrono::duration_cast<std::chrono::steady_clock::duration>(
               std::chrono::duration<double>(seconds));
}

template <class T>
void replace(std::optional<T>& before, const std::optional<T>& later) {
    if (later) before = later;
}

Reply answered(const Question& question, Answers& answers) {
    try {
        return question(answers);
    } catch (const UsageError& error) {
        return {400, "text/plain", error.what(), ""};
    } catch (const std::exception& error) {
        return {500, "text/plain", error.what(), ""};
    }
}

} // namespace

void Steering::add(const Steering& later) {
    if (later.pose) fileCamera.reset();
    if (later.fileCamera) pose.reset();
    replace(pose, later.pose);
    replace(fileCamera, later.fileCamera);
    replace(moving, later.moving);
    replace(paused, later.paused);
    replace(turn, later.turn);
    replace(sun, later.sun);
    replace(variant, later.variant);
    replace(seconds, later.seconds);
}

// --- Servers -------------------------------------------------------------------------------------

std::shared_ptr<const std::string> Exchange::frameAfter(Shown shown, uint64_t after,
                                                        double seconds) {
    std::unique_lock lock(mutex_);
    Slot& slot = slots_[size_t(shown)];
    const auto isThere = [&] { return closed_ || (slot.frame && slot.number > after); };
    if (!isThere()) {
        ++slot.waiting;
        forRenderer_.notify_all();
        forServers_.wait_until(lock, in(seconds), isThere);
        --slot.waiting;
    }
    slot.left = std::chrono::steady_clock::now();
    return slot.frame && slot.number > after ? slot.frame : nullptr;
}

bool Exchange::mayWait() const {
    const std::lock_guard lock(mutex_);
    size_t waiting = 0;
    for (const Slot& slot : slots_)
        waiting += slot.waiting;
    return waiting < kMostWaiting;
}

Reply Exchange::ask(Question question, double seconds) {
    const auto asked = std::make_shared<Asked>();
    asked->question = std::move(question);
    std::unique_lock lock(mutex_);
    asked->steerings = steerings_;
    if (closed_ || asked_.size() >= kMostQuestions)
        return {503, "text/plain", "nobody can answer now", ""};
    asked_.push_back(asked);
    forRenderer_.notify_all();
    forServers_.wait_until(lock, in(seconds), [&] { return closed_ || asked->reply; });
    if (asked->reply) return *std::move(asked->reply);
    std::erase(asked_, asked);
    return {504, "text/plain", "no answer in time: the render is busy", ""};
}

void Exchange::steer(const Steering& steering) {
    const std::lock_guard lock(mutex_);
    steering_.add(steering);
    ++steerings_;
    forRenderer_.notify_all();
}

// --- Who renders ---------------------------------------------------------------------------------

bool Exchange::Slot::isAwaited() const {
    return waiting > 0 || (left && *left > in(-kRecently));
}

std::array<bool, kNamedValues<Shown>.size()> Exchange::awaited() const {
    const std::lock_guard lock(mutex_);
    std::array<bool, kNamedValues<Shown>.size()> result{};
    for (size_t i = 0; i < slots_.size(); ++i)
        result[i] = slots_[i].isAwaited();
    return result;
}

bool Exchange::isAwaited() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(slots_, &Slot::isAwaited);
}

bool Exchange::lacksAFrame() const {
    const std::lock_guard lock(mutex_);
    return std::ranges::any_of(slots_,
                               [](const Slot& slot) { return slot.waiting > 0 && !slot.frame; });
}

bool Exchange::isSteered() const {
    const std::lock_guard lock(mutex_);
    return !steering_.isEmpty();
}

bool Exchange::isAsked() const {
    const std::lock_guard lock(mutex_);
    return !asked_.empty();
}

Steering Exchange::takeSteering() {
    const std::lock_guard lock(mutex_);
    steeringsTaken_ = steerings_;
    return std::exchange(steering_, {});
}

void Exchange::answer(Answers& answers) {
    for (;;) {
        std::shared_ptr<Asked> next;
        {
            const std::lock_guard lock(mutex_);
            if (asked_.empty() || asked_.front()->steerings > steeringsTaken_) return;
            next = asked_.front();
            asked_.pop_front();
        }
        Reply reply = answered(next->question, answers);
        const std::lock_guard lock(mutex_);
        next->reply = std::move(reply);
        forServers_.notify_all();
    }
}

void Exchange::publish(Shown shown, uint64_t number, std::shared_ptr<const std::string> frame) {
    const std::lock_guard lock(mutex_);
    Slot& slot = slots_[size_t(shown)];
    slot.number = number;
    slot.frame = std::move(frame);
    forServers_.notify_all();
}

void Exchange::forgetFrames() {
    const std::lock_guard lock(mutex_);
    for (Slot& slot : slots_)
        slot.frame.reset();
}

bool Exchange::hasWork() const {
    return closed_ || !asked_.empty() || !steering_.isEmpty() ||
           std::ranges::any_of(slots_,
                               [](const Slot& slot) { return slot.waiting > 0 && !slot.frame; });
}

void Exchange::waitForWork(double seconds) {
    std::unique_lock lock(mutex_);
    forRenderer_.wait_until(lock, in(seconds), [&] { return hasWork(); });
}

void Exchange::close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    forServers_.notify_all();
    forRenderer_.notify_all();
}

bool Exchange::isClosed() const {
    const std::lock_guard lock(mutex_);
    return closed_;
}

} // namespace stromboli::view
