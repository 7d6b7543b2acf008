// Backends that share the work, with samples that need no renderer.
#include "host/render/team_backend.hpp"

#include "host/core/error.hpp"
#include "host/render/block_backend.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/render/drawn_samples.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <memory>
#include <stdexcept>
#include <string>

namespace stromboli {
namespace {

using namespace test;
using testing::HasSubstr;

/// A member whose pieces go wrong from some call on.
class Fragile final : public Backend {
  public:
    enum class How { NotAtAll, DeviceError, OtherError };

    /// everyone: waits before its first piece until all members have one; null: for nobody.
    Fragile(How how, int goodCalls, std::shared_ptr<std::latch> everyone)
        : how_(how), goodCalls_(goodCalls), everyone_(std::move(everyone)) {}

    void sample(std::span<const PixelTarget> targets, Film& film,
                const PassProgress& progress) override {
        if (++calls == 1 && everyone_) everyone_->arrive_and_wait();
        if (how_ != How::NotAtAll && calls > goodCalls_) {
            // Half of the piece is done when it happens.
            backend_.sample(targets.first(targets.size() / 2), film, progress);
            if (how_ == How::DeviceError) throw DeviceLostError("the cable is out");
            throw std::runtime_error("a bug");
        }
        backend_.sample(targets, film, progress);
    }
    SampleValue sampleAlone(uint32_t pixel, uint32_t sample) override {
        return backend_.sampleAlone(pixel, sample);
    }
    RenderCounters counters() const override { return {}; }
    void beginAt(uint32_t firstSample) override { backend_.beginAt(firstSample); }

    std::atomic<int> calls = 0;

  private:
    DrawnBackend backend_{uneven, 1};
    How how_;
    int goodCalls_;
    std::shared_ptr<std::latch> everyone_;
};

struct Team {
    std::vector<std::shared_ptr<Fragile>> backends;
    std::vector<std::string> said;
    std::shared_ptr<TeamBackend> backend;

    /// waits: each member has a first piece before any is done with it. Not where there may be
    /// fewer pieces than members: the rest of a pass that was stopped may be one.
    explicit Team(const std::vector<std::pair<Fragile::How, int>>& kinds, bool waits = true) {
        std::vector<TeamMember> members;
        const auto everyone =
            waits ? std::make_shared<std::latch>(std::ptrdiff_t(kinds.size())) : nullptr;
        for (const auto& [how, goodCalls] : kinds) {
            backends.push_back(std::make_shared<Fragile>(how, goodCalls, everyone));
            members.push_back({"member " + std::to_string(members.size()), backends.back()});
        }
        backend = std::make_shared<TeamBackend>(
            members, settingsOf(1).area, [this](const std::string& line) { said.push_back(line); });
    }
};

constexpr std::pair kSound{Fragile::How::NotAtAll, 0};

Film rendered(Backend& backend, const RenderSettings& s) {
    return render(backend, s);
}

void expectSame(const Film& a, const Film& b) {
    ASSERT_EQ(a.pixels.size(), b.pixels.size());
    for (size_t i = 0; i < a.pixels.size(); ++i) {
        EXPECT_EQ(a.pixels[i].taken(), b.pixels[i].taken()) << i;
        EXPECT_EQ(a.pixels[i].mean, b.pixels[i].mean) << i;
        EXPECT_EQ(a.pixels[i].m2, b.pixels[i].m2) << i;
    }
}

std::vector<RenderSettings> kindsOfRenders() {
    RenderSettings even = settingsOf(40), spread = settingsOf(kMostSamples), adaptive = even;
    spread.budget.meanSamplesPerPixel = 30;
    adaptive.budget.adaptive = {.enabled = true, .batch = 8, .tolerance = 0.2};
    return {even, spread, adaptive};
}

TEST(TeamBackend, MakesTheFilmThatOneMakes) {
    for (const RenderSettings& s : kindsOfRenders()) {
        Team team({kSound, kSound, kSound});
        expectSame(rendered(*team.backend, s), renderDrawn(uneven, s, 1).film);
    }
}

TEST(TeamBackend, SumsBlocks) {
    RenderSettings s = settingsOf(40);
    s.budget.samplesPerBlock = 7;
    Team team({kSound, kSound});
    BlockBackend together(team.backend, s.area, 7);
    BlockBackend alone(std::make_shared<DrawnBackend>(uneven, 1), s.area, 7);
    expectSame(rendered(together, s), rendered(alone, s));
}

TEST(TeamBackend, OneThatFailsDropsOutAndItsWorkIsDoneAgain) {
    int happened = 0;
    for (const int goodCalls : {0, 1, 3})
        for (const RenderSettings& s : kindsOfRenders()) {
            Team team({kSound, {Fragile::How::DeviceError, goodCalls}, kSound});
            expectSame(rendered(*team.backend, s), renderDrawn(uneven, s, 1).film);
            if (team.backends[1]->calls <= goodCalls) continue; // the others had no more for it
            ++happened;
            EXPECT_EQ(team.backends[1]->calls, goodCalls + 1);
            EXPECT_EQ(team.backend->present(), (std::vector<size_t>{0, 2}));
            ASSERT_EQ(team.said.size(), 1u);
            EXPECT_THAT(team.said[0],
                        HasSubstr("member 1 takes no more samples: the cable is out; the others"));
        }
    EXPECT_GE(happened, 3); // in its first piece it does always
}

/// A session would take again what a pass lacks: here there is one pass.
TEST(TeamBackend, APassIsCompleteWhoeverFails) {
    Team team({kSound, {Fragile::How::DeviceError, 0}, {Fragile::How::DeviceError, 0}});
    Film film(settingsOf(1).area);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < film.pixels.size(); i += 2)
        targets.push_back({i, 50});
    uint64_t last = 0;
    team.backend->sample(targets, film, [&](uint64_t done) {
        last = done;
        return true;
    });
    EXPECT_EQ(last, 50 * targets.size()); // what was lost does not count
    EXPECT_EQ(team.backend->present(), std::vector<size_t>{0});
    for (uint32_t i = 0; i < film.pixels.size(); ++i)
        EXPECT_EQ(film.pixels[i].taken(), i % 2 == 0 ? 50u : 0u);
}

TEST(TeamBackend, WithoutMembersItIsTheDevicesError) {
    Team team({{Fragile::How::DeviceError, 2}, {Fragile::How::DeviceError, 3}});
    EXPECT_THROW(rendered(*team.backend, settingsOf(40)), DeviceLostError);
    EXPECT_TRUE(team.backend->present().empty());
    ASSERT_EQ(team.said.size(), 2u);
    // The last to drop out says so; its line need not be the last.
    EXPECT_THAT(team.said, testing::Contains(testing::Not(HasSubstr("the others"))));
}

TEST(TeamBackend, OtherErrorsAreNotMended) {
    Team team({kSound, {Fragile::How::OtherError, 0}});
    EXPECT_THROW(rendered(*team.backend, settingsOf(4000)), std::runtime_error);
}

TEST(TeamBackend, ErrorsOfTheProgressEndThePass) {
    Team team({kSound, kSound});
    Film film(settingsOf(1).area);
    std::vector<PixelTarget> targets;
    for (uint32_t i = 0; i < film.pixels.size(); ++i)
        targets.push_back({i, 1000});
    EXPECT_THROW(team.backend->sample(targets, film,
                                      [](uint64_t) -> bool { throw std::runtime_error("stop"); }),
                 std::runtime_error);
}

/// Stopped at whatever moment, saved, and gone on with by another team.
TEST(TeamBackend, GoesOnWhereItWasStopped) {
    for (const RenderSettings& s : kindsOfRenders())
        for (const int reports : {1, 3, 10}) {
            auto team = std::make_unique<Team>(std::vector{kSound, kSound}, false);
            auto session = std::make_unique<SamplingSession>(*team->backend, s);
            for (bool isDone = false; !isDone;) {
                int left = reports;
                bool stopped = false;
                while (session->pass(
                    [&](const RenderProgress&) { return !(stopped = --left <= 0); })) {
                }
                isDone = !stopped;
                const std::vector<std::byte> bytes = toBytes(session->save());
                session.reset();
                team = std::make_unique<Team>(std::vector{kSound, kSound}, false);
                session =
                    std::make_unique<SamplingSession>(*team->backend, sessionFromBytes(bytes));
            }
            expectSame(session->film(), renderDrawn(uneven, s, 1).film);
        }
}

} // namespace
} // namespace stromboli
