// A scene that is served, as its pages see it, without a browser.
#include "host/core/error.hpp"
#include "host/film/image_formats.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/view/served_view.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <thread>

namespace stromboli::view {
namespace {

using namespace test;
using stromboli::test::alone;
using stromboli::test::fromTheSide;
using stromboli::test::smallPicture;
using testing::HasSubstr;

/// The path that steers to a pose.
std::string steerTo(const glm::dvec3& from, const glm::dvec3& at, double fov, bool moving = false) {
    return fmt::format("/steer?fromx={}&fromy={}&fromz={}&atx={}&aty={}&atz={}&fov={}&moving={}",
                       from.x, from.y, from.z, at.x, at.y, at.z, fov, int(moving));
}

/// That the frame has the means of the film, as half floats: eleven digits of the binary system.
void expectSame(const ReadFrame& frame, const Film& film) {
    ASSERT_EQ(frame.values.size(), film.pixels.size() * 3);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double mean = film.pixels[i].mean[c];
            EXPECT_NEAR(frame.values[i * 3 + c], mean, mean / 2048 + 1e-7) << i;
        }
}

TEST(ServedView, EndsWithThePictureThatARenderMakes) {
    const RenderRequest request = smallPicture(16);
    const ServedView view(request);
    const ReadFrame last = view.client().finished();
    EXPECT_TRUE(last.says("coarse", "false"));
    EXPECT_EQ(last.number("samples"), 16);
    EXPECT_EQ(last.number("share"), 1);
    expectSame(last, alone(onTheReference(), view.scene(), request));
}

TEST(ServedView, ShowsACoarsePictureFirst) {
    const ServedView view(smallPicture(16));
    const Client client = view.client();
    client.finished();
    client.post("/steer?paused=1"); // so that it stays
    client.post(steerTo({0.4, 0.6, 1.1}, {0, 0.5, 0}, 35));
    ReadFrame frame = client.frame(0);
    while (!(frame.number("epoch") > 1))
        frame = client.frame(uint64_t(frame.number("number")));
    EXPECT_TRUE(frame.says("coarse", "true"));
    EXPECT_LT(frame.number("width"), 24);
    EXPECT_EQ(frame.number("fullWidth"), 24);
    EXPECT_EQ(frame.number("fullHeight"), 18);
    EXPECT_THAT(frame.values, testing::Contains(testing::Gt(0.0f)));
    EXPECT_EQ(client.get("/save?format=png").status, 400); // there is nothing worth a file yet
    client.post("/steer?paused=0");
    EXPECT_GT(client.finished().number("epoch"), 1);
}

/// How long nobody looks says nothing of how long a picture takes.
TEST(ServedView, NobodyLookingMakesPicturesNoCoarser) {
    const ServedView view(smallPicture(16));
    const Client client = view.client();
    client.post("/steer?paused=1");
    client.post(steerTo({0.4, 0.6, 1.1}, {0, 0.5, 0}, 35));
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    client.post(steerTo({0.4, 0.6, 1.2}, {0, 0.5, 0}, 35));
    std::this_thread::sleep_for(std::chrono::milliseconds(900));
    client.post(steerTo({0.4, 0.6, 1.3}, {0, 0.5, 0}, 35));
    ReadFrame frame = client.frame(0); // of steps that came together there is the last alone
    while (nlohmann::json::parse(frame.text).at("pose").at("from").at(2) < 1.25)
        frame = client.frame(uint64_t(frame.number("number")));
    EXPECT_TRUE(frame.says("coarse", "true"));
    EXPECT_GE(frame.number("width"), 24 / 4);
}

TEST(ServedView, AMovedCameraHasThePictureOfARenderWithoutBuildingAnything) {
    RenderRequest request = smallPicture(8);
    const ServedView view(request);
    const Client client = view.client();
    const double before = client.finished().number("number");
    const size_t built = view.count(Stage::Building), loaded = view.count(Stage::Loading);
    for (int i = 0; i <= 4; ++i)
        EXPECT_EQ(client.post(steerTo({0.4 * i / 4, 0.6, 1.1}, {0, 0.5, 0}, 35, i < 4)).status,
                  204);
    ReadFrame frame = client.frame(uint64_t(before));
    for (;;) { // until it has come to rest
        const auto pose = nlohmann::json::parse(frame.text).at("pose");
        if (frame.says("state", "\"done\"") && pose.at("from").at(0) == 0.4) break;
        frame = client.frame(uint64_t(frame.number("number")));
    }
    request.camera = fromTheSide();
    request.camera.fieldOfView = 35 * std::acos(-1.0) / 180;
    expectSame(frame, alone(onTheReference(), view.scene(), request));
    EXPECT_EQ(view.count(Stage::Building), built);
    EXPECT_EQ(view.count(Stage::Loading), loaded);
    EXPECT_GT(frame.number("epoch"), 1);
}

TEST(ServedView, TellsOfLayersNoiseAndPixels) {
    const ServedView view(smallPicture(8));
    const Client client = view.client();
    client.finished();
    for (const auto& [shown, channels] : {std::pair{"albedo", 3},
                                          {"normal", 3},
                                          {"depth", 1},
                                          {"noise", 1},
                                          {"samples", 1},
                                          {"denoised", 3}}) {
        const ReadFrame frame = client.frame(0, shown);
        EXPECT_EQ(frame.number("channels"), channels) << shown;
        EXPECT_TRUE(frame.says("shown", '"' + std::string(shown) + '"'));
    }
    EXPECT_THAT(client.frame(0, "samples").values, testing::Each(8.0f));
    // The back wall of the box is one of its walls, whose normals have length 1.
    const ReadFrame normal = client.frame(0, "normal"), depth = client.frame(0, "depth");
    const auto probe = nlohmann::json::parse(client.get("/probe?x=12&y=6").body);
    const size_t i = 6 * 24 + 12;
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(probe.at("normal").at(c).get<double>(), normal.values[i * 3 + c], 1e-3);
    EXPECT_NEAR(probe.at("depth").get<double>(), depth.values[i], 1e-2);
    EXPECT_EQ(probe.at("samples"), 8);
    EXPECT_TRUE(probe.at("object").is_string());
    EXPECT_TRUE(probe.at("material").is_string());
    EXPECT_EQ(client.get("/probe?x=24&y=6").status, 400);
}

TEST(ServedView, SavesThePictureThatARenderMakes) {
    const RenderRequest request = smallPicture(8);
    const ServedView view(request);
    view.client().finished();
    const Answer answer = view.client().get("/save?format=exr");
    ASSERT_EQ(answer.status, 200);
    EXPECT_THAT(answer.headers.at("Content-Disposition"), HasSubstr("view.exr"));
    const TemporaryFolder folder;
    std::ofstream(folder / "saved.exr", std::ios::binary) << answer.body;
    const FloatImage saved = readExr(folder / "saved.exr");
    const Film expected = alone(onTheReference(), view.scene(), request);
    const FloatImage linear = linearPicture(expected, false);
    EXPECT_EQ(saved.channels, linear.channels);

    const Answer png = view.client().get("/save?format=png&view=agx&exposure=1.5");
    ASSERT_EQ(png.status, 200);
    std::ofstream(folder / "saved.png", std::ios::binary) << png.body;
    ToneMapping tone;
    tone.view = View::AgX;
    tone.curve.exposure = 1.5;
    EXPECT_EQ(readPng(folder / "saved.png").rgb, toneMap<uint8_t>(linear, tone, false).rgb);
}

TEST(ServedView, PausesAndGoesOn) {
    const ServedView view(smallPicture(3000));
    const Client client = view.client();
    ReadFrame frame = client.frame(0);
    while (frame.says("coarse", "true"))
        frame = client.frame(uint64_t(frame.number("number")));
    EXPECT_EQ(client.post("/steer?paused=1").status, 204);
    while (!frame.says("state", "\"paused\""))
        frame = client.frame(uint64_t(frame.number("number")));
    EXPECT_TRUE(frame.says("paused", "true"));
    const double samples = client.frame(0).number("samples");
    client.get("/probe?x=0&y=0"); // the render answers, and takes none
    EXPECT_EQ(client.frame(0).number("samples"), samples);
    EXPECT_EQ(client.post("/steer?paused=0").status, 204);
    while (frame.number("samples") <= samples)
        frame = client.frame(uint64_t(frame.number("number")));
}

TEST(ServedView, TwoPagesSeeTheSamePicture) {
    const ServedView view(smallPicture(8));
    ReadFrame other;
    std::thread page([&] { other = view.client().finished(); });
    const ReadFrame frame = view.client().finished();
    page.join();
    EXPECT_EQ(frame.values, other.values);
}

TEST(ServedView, WritesTheCommandOfWhatIsSeen) {
    const ServedView view(smallPicture(4));
    const Client client = view.client();
    client.finished();
    EXPECT_EQ(client.get("/command?view=agx&exposure=-1.25&denoised=1").body,
              "-1 -1 agx -1.25 true");
    EXPECT_EQ(client.get("/command?view=other").status, 400);
    EXPECT_EQ(client.get("/command?exposure=nan").status, 400);
    EXPECT_EQ(client.get("/command?exposure=1;rm").status, 400);
    client.post("/steer?camera=0");
    EXPECT_EQ(client.get("/command").body, "-1 0 standard 0 false");
}

/// A question that comes after steering is answered when that has been done, however busy the
/// renderer is, and does not wait for steering that comes after it.
TEST(Exchange, AnswersAreOfWhatWasSteeredToBefore) {
    struct Nothing : Answers {
        Reply probe(uint32_t, uint32_t) override { return {}; }
        Reply save(const SaveRequest&) override { return {}; }
        Reply command(const ToneWords&, bool) override { return {200, "text/plain", "it", ""}; }
    } answers;
    Exchange exchange;
    Steering pause;
    pause.paused = true;
    exchange.steer(pause);
    Reply reply;
    std::thread page(
        [&] { reply = exchange.ask([](Answers& a) { return a.command({}, false); }, 60); });
    while (!exchange.isAsked())
        std::this_thread::yield();
    exchange.answer(answers);
    EXPECT_TRUE(exchange.isAsked());
    EXPECT_TRUE(exchange.takeSteering().paused);
    exchange.steer(pause);
    exchange.answer(answers);
    EXPECT_FALSE(exchange.isAsked());
    exchange.close(); // so that the page ends, answered or not
    page.join();
    EXPECT_EQ(reply.body, "it");
}

TEST(ServedView, ThePageIsOneDocumentThatMayFetchNothingElsewhere) {
    const ServedView view(smallPicture(1));
    const Answer page = view.client().get("/", {{"X-Stromboli-Token", ""}});
    ASSERT_EQ(page.status, 200);
    EXPECT_THAT(page.body, HasSubstr(view.server().token()));
    EXPECT_THAT(page.body, testing::Not(HasSubstr("@@")));
    EXPECT_THAT(page.body, testing::Not(testing::ContainsRegex("(src|href)=\"?https?:")));
    const std::string policy = page.headers.at("Content-Security-Policy");
    EXPECT_THAT(policy, HasSubstr("default-src 'none'"));
    EXPECT_THAT(policy, testing::Not(HasSubstr("unsafe")));
    EXPECT_EQ(page.headers.at("Cache-Control"), "no-store");
    EXPECT_FALSE(page.headers.contains("Access-Control-Allow-Origin"));
}

TEST(ServedView, ReadOnlyPagesSteerNothing) {
    ServerOptions options;
    options.readOnly = true;
    const ServedView view(smallPicture(1), options);
    EXPECT_EQ(view.client().post("/steer?paused=1").status, 403);
    EXPECT_EQ(view.client().post(steerTo({1, 1, 1}, {0, 0, 0}, 40)).status, 403);
    EXPECT_TRUE(view.client().finished().says("epoch", "1"));
}

TEST(ServedView, AtOtherAddressesNothingIsServedWithoutTheToken) {
    ServerOptions options;
    options.host = "0.0.0.0";
    const ServedView view(smallPicture(1), options);
    EXPECT_THAT(view.server().address(), HasSubstr("?token=" + view.server().token()));
    const Client client = view.client();
    EXPECT_EQ(client.get("/", {{"X-Stromboli-Token", ""}}).status, 403);
    EXPECT_THAT(
        client.raw("GET /?token=" + view.server().token() + " HTTP/1.1\r\nHost: a:1\r\n\r\n",
                   false),
        testing::StartsWith("HTTP/1.1 200"));
    EXPECT_EQ(client.get("/").status, 200);
    EXPECT_EQ(Client(view.server().port(), "0").get("/").status, 403);
}

TEST(ServedView, ATakenPortIsAnError) {
    const ServedView view(smallPicture(1));
    ServerOptions options;
    options.port = view.server().port();
    Exchange exchange;
    EXPECT_THROW(std::make_unique<Server>(options, exchange), UsageError);
    options = {};
    options.host = "no.such.host.invalid";
    EXPECT_THROW(std::make_unique<Server>(options, exchange), UsageError);
}

TEST(ServedView, PosesThatNoCameraCanHaveAreRefused) {
    const ServedView view(smallPicture(1));
    const Client client = view.client();
    client.finished();
    for (const std::string& path : {steerTo({1, 1, 1}, {1, 1, 1}, 40),
                                    steerTo({1, 1, 1}, {0, 0, 0}, 180),
                                    steerTo({NAN, 1, 1}, {0, 0, 0}, 40),
                                    steerTo({1e30, 1, 1}, {0, 0, 0}, 40),
                                    std::string("/steer?fromx=1"),
                                    std::string("/steer?camera=-1"),
                                    std::string("/steer?moving=2"),
                                    std::string("/steer?turn=nan"),
                                    std::string("/steer?turn=1e9"),
                                    std::string("/steer?turn="),
                                    std::string("/steer?azimuth=10"),
                                    std::string("/steer?azimuth=inf&elevation=10"),
                                    std::string("/steer?azimuth=10&elevation=-1"),
                                    std::string("/steer?variant=-2"),
                                    std::string("/steer?variant=red"),
                                    std::string("/steer?variant=1e99"),
                                    std::string("/steer?seconds=-2"),
                                    std::string("/steer?seconds=1e10"),
                                    "/steer?seconds=" + std::string(1000, '9'),
                                    std::string("/frame?shown=../etc/passwd&after=0"),
                                    std::string("/frame?shown=picture&after=-1"),
                                    std::string("/save?format=/etc/passwd")})
        EXPECT_EQ((path.starts_with("/steer") ? client.post(path) : client.get(path)).status, 400)
            << path;
    // What is not there is not changed.
    for (const char* path : {"/steer?camera=77", "/steer?turn=10", "/steer?azimuth=10&elevation=20",
                             "/steer?variant=5", "/steer?seconds=1"})
        EXPECT_EQ(client.post(path).status, 204) << path;
    EXPECT_TRUE(client.frame(0).says("epoch", "1"));
}

} // namespace
} // namespace stromboli::view
