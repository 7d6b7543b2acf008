// Those who look at a render that goes on: pages, a file, tev. The render's bytes do not depend on
// them.
#include "host/core/error.hpp"
#include "host/film/image_formats.hpp"
#include "host/view/observer.hpp"
#include "host/view/tev.hpp"
#include "host/view/watching.hpp"
#include "tests/film/temporary_folder.hpp"
#include "tests/view/served_view.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <fstream>
#include <thread>

namespace stromboli::view {
namespace {

using namespace test;
using stromboli::test::alone;
using stromboli::test::bundled;
using stromboli::test::sameBytes;
using stromboli::test::smallPicture;

/// Renders with these observers.
Film observed(std::shared_ptr<const Scene> scene, const RenderRequest& request,
              Observers& observers) {
    RenderSession session(onTheReference());
    session.begin(std::move(scene), request);
    observers.run(session, {});
    return session.film();
}

TEST(Observers, TheBytesDoNotDependOnWhoWatches) {
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(64);
    const Film expected = alone(onTheReference(), scene, request);
    for (const int pages : {0, 1, 4}) {
        Exchange exchange;
        ServerOptions options;
        options.readOnly = true;
        Server server(options, exchange);
        Observers observers({});
        observers.add(watching(exchange, "scene"));
        std::vector<std::thread> readers;
        std::atomic<int> finished = 0;
        for (int i = 0; i < pages; ++i)
            readers.emplace_back([&] {
                const Client client(server.port(), server.token());
                if (client.finished().number("samples") == 64) ++finished;
            });
        EXPECT_TRUE(sameBytes(observed(scene, request, observers), expected)) << pages;
        // The render is over, and its last frame is there for who comes a little later.
        for (std::thread& reader : readers)
            reader.join();
        EXPECT_EQ(finished, pages);
    }
}

TEST(Observers, AFileIsRewrittenAndIsThePictureInTheEnd) {
    const TemporaryFolder folder;
    const std::filesystem::path file = folder / "live.png";
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(32);
    ToneMapping tone;
    tone.curve.exposure = 1;
    Observers observers({});
    observers.add(updatingFile(file, 0.1, tone));
    const Film film = observed(scene, request, observers);
    EXPECT_EQ(readPng(file).rgb, toneMap(film, tone.curve).rgb);
    EXPECT_EQ(folder.size(), 1u); // no temporary file is left
}

TEST(Observers, OneThatFailsIsLeftOutAndTheRenderGoesOn) {
    std::vector<std::string> said;
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(16);
    Observers observers([&](Severity, const std::string& text) { said.push_back(text); });
    {
        const TemporaryFolder folder;
        observers.add(updatingFile(folder / "live.png", 0.1, {}));
    } // the folder is gone
    EXPECT_TRUE(
        sameBytes(observed(scene, request, observers), alone(onTheReference(), scene, request)));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_THAT(said[0], testing::HasSubstr("live.png"));
    EXPECT_TRUE(observers.isEmpty());
}

TEST(Observers, UnfitNamesAreRefused) {
    EXPECT_THROW(updatingFile("live.exr", 1, {}), UsageError);
    EXPECT_THROW(updatingFile("live", 1, {}), UsageError);
    EXPECT_THROW(updatingFile("/nowhere/live.png", 1, {}), OutputError);
    for (const char* address : {"", "host", "host:", ":1", "host:0", "host:65536", "host:x"})
        EXPECT_THROW(sendingToTev(address, "name", 1), UsageError) << address;
}

// --- tev -----------------------------------------------------------------------------------------

/// As much of tev as reads what it is sent.
class SmallTev {
  public:
    SmallTev() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t length = sizeof address;
        if (::bind(socket_, reinterpret_cast<sockaddr*>(&address), length) != 0 ||
            ::listen(socket_, 1) != 0 ||
            ::getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &length) != 0)
            throw std::runtime_error("no socket");
        port_ = ntohs(address.sin_port);
    }
    ~SmallTev() { ::close(socket_); }
    SmallTev(const SmallTev&) = delete;
    SmallTev& operator=(const SmallTev&) = delete;

    std::string address() const { return fmt::format("127.0.0.1:{}", port_); }
    /// All bytes of one connection.
    std::string takeConnection() const {
        const int connection = ::accept(socket_, nullptr, nullptr);
        std::string all;
        char piece[4096];
        for (ssize_t count; (count = ::recv(connection, piece, sizeof piece, 0)) > 0;)
            all.append(piece, size_t(count));
        ::close(connection);
        return all;
    }

  private:
    int socket_;
    uint16_t port_ = 0;
};

/// Reads a packet from its beginning on, as tev does.
class PacketReader {
  public:
    explicit PacketReader(std::string bytes) : bytes_(std::move(bytes)) {}
    template <class T>
    T number() {
        uint64_t value = 0;
        for (size_t i = 0; i < sizeof(T); ++i)
            value |= uint64_t(uint8_t(bytes_.at(at_++))) << (8 * i);
        return T(value);
    }
    std::string text() {
        const std::string result = bytes_.c_str() + at_;
        at_ += result.size() + 1;
        return result;
    }
    bool isAtEnd() const { return at_ == bytes_.size(); }

  private:
    std::string bytes_;
    size_t at_ = 0;
};

void expectChannelNames(PacketReader& packet) {
    EXPECT_EQ(packet.number<int32_t>(), 3);
    for (const char* name : {"R", "G", "B"})
        EXPECT_EQ(packet.text(), name);
}

TEST(Tev, APictureIsMadeAndFilled) {
    const SmallTev tev;
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(8);
    Film film;
    std::thread render([&] {
        Observers observers({});
        observers.add(sendingToTev(tev.address(), "the scene", 1e6)); // at the end once more
        film = observed(scene, request, observers);
    });
    const std::string all = tev.takeConnection();
    render.join();
    std::vector<std::string> packets;
    for (size_t at = 0; at < all.size();) {
        const auto length = PacketReader(all.substr(at, 4)).number<uint32_t>();
        ASSERT_GE(length, 6u);
        packets.push_back(all.substr(at, length));
        at += length;
    }
    ASSERT_GE(packets.size(), 2u);
    PacketReader create(packets.front());
    create.number<uint32_t>();
    EXPECT_EQ(create.number<uint8_t>(), 4);
    EXPECT_EQ(create.number<uint8_t>(), 0);
    EXPECT_EQ(create.text(), "the scene");
    EXPECT_EQ(create.number<int32_t>(), 24);
    EXPECT_EQ(create.number<int32_t>(), 18);
    expectChannelNames(create);
    EXPECT_TRUE(create.isAtEnd());

    PacketReader update(packets.back());
    update.number<uint32_t>();
    EXPECT_EQ(update.number<uint8_t>(), 6);
    EXPECT_EQ(update.number<uint8_t>(), 0);
    EXPECT_EQ(update.text(), "the scene");
    expectChannelNames(update);
    for (const int32_t number : {0, 0, 24, 18})
        EXPECT_EQ(update.number<int32_t>(), number);
    for (int64_t c = 0; c < 3; ++c)
        EXPECT_EQ(update.number<int64_t>(), c);
    for (int64_t c = 0; c < 3; ++c)
        EXPECT_EQ(update.number<int64_t>(), 3);
    for (const PixelStatistics& pixel : film.pixels)
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(std::bit_cast<float>(update.number<uint32_t>()), float(pixel.mean[c]));
    EXPECT_TRUE(update.isAtEnd());
}

TEST(Tev, OneThatIsNotThereDelaysNothing) {
    std::string address;
    {
        const SmallTev gone;
        address = gone.address();
    }
    const auto scene = bundled("cornell_spheres");
    const RenderRequest request = smallPicture(8);
    Observers observers({});
    observers.add(sendingToTev(address, "name", 0.01));
    EXPECT_TRUE(
        sameBytes(observed(scene, request, observers), alone(onTheReference(), scene, request)));
}

} // namespace
} // namespace stromboli::view
