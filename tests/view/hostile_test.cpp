// What strangers send to a server does no harm to the render.
#include "tests/view/served_view.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <memory>
#include <stdexcept>
#include <thread>
#include <vector>

namespace stromboli::view {
namespace {

using namespace test;
using stromboli::test::alone;
using stromboli::test::smallPicture;

/// A request with these lines, which end it.
std::string lines(std::initializer_list<std::string> all) {
    std::string text;
    for (const std::string& line : all)
        text += line + "\r\n";
    return text + "\r\n";
}

struct Hostile {
    std::string bytes;
    /// What the answer's first line holds; empty: nothing is known of it.
    std::string status;
};

/// Requests that are wrong, damaged, large, or of somebody who may not ask.
std::vector<Hostile> hostileRequests(uint16_t port, const std::string& token) {
    const std::string host = fmt::format("Host: 127.0.0.1:{}", port);
    const std::string known = "X-Stromboli-Token: " + token, empty = "Content-Length: 0";
    const std::string steer = "/steer?fromx=1&fromy=1&fromz=1&atx=0&aty=0&atz=0&fov=40";
    std::string many = "GET / HTTP/1.1\r\n" + host + "\r\n";
    for (int i = 0; i < 100; ++i)
        many += fmt::format("H{}: v\r\n", i);
    return {
        {"", ""},
        {"\r\n\r\n", ""},
        {std::string(1, '\0'), ""},
        {"GET", ""},
        {"GET / HTTP/9.9\r\n\r\n", ""},
        {"\x16\x03\x01\x02" + std::string(300, 'a'), ""}, // TLS
        {lines({"PRI * HTTP/2.0"}), ""},
        {lines({"GET / HTTP/1.1", host, "A: " + std::string(100000, 'a')}), ""},
        {lines({"GET / HTTP/1.1"}), " 403 "}, // no Host
        {lines({"GET / HTTP/1.1", "Host: evil.example"}), " 403 "},
        {lines({"GET /frame?shown=picture&after=0 HTTP/1.1", host}), " 403 "}, // no token
        {lines({"GET /frame?shown=picture&after=0 HTTP/1.1", host, "X-Stromboli-Token: 0"}),
         " 403 "},
        {lines({"GET /../../../etc/passwd HTTP/1.1", host, known}), " 404 "},
        {lines({"GET /%2e%2e%2fetc/passwd HTTP/1.1", host, known}), " 404 "},
        {lines({"GET /save?format=exr%00&file=/etc/passwd HTTP/1.1", host, known}), " 400 "},
        {lines({"GET /" + std::string(3000, '/') + " HTTP/1.1", host, known}), " 414 "},
        {lines({"GET /" + std::string(100000, '/') + " HTTP/1.1", host, known}), ""},
        {lines({"GET /probe?x=99999999999999999999&y=-1 HTTP/1.1", host, known}), " 400 "},
        {lines({"GET /probe?x=&y=nan HTTP/1.1", host, known}), " 400 "},
        {lines({"GET /probe HTTP/1.1", host, known}), " 400 "},
        {lines({"POST " + steer + " HTTP/1.1", host, empty}), " 403 "}, // no token
        {lines({"POST " + steer + " HTTP/1.1", host, known, "Origin: http://evil.example", empty}),
         " 403 "},
        {lines({"POST " + steer + " HTTP/1.1", host, known, "Sec-Fetch-Site: cross-site", empty}),
         " 403 "},
        {lines({"POST " + steer + " HTTP/1.1", "Host: evil.example", known, empty}), " 403 "},
        {lines({"POST /steer?paused=1 HTTP/1.1", host, known, "Content-Length: 4"}) + "body",
         " 413 "},
        {lines({"POST /steer?paused=1 HTTP/1.1", host, known, "Content-Length: 9999999999"}),
         " 413 "},
        {lines({"POST /steer?paused=1 HTTP/1.1", host, known, "Content-Length: -1"}), " 413 "},
        {lines({"POST /steer?paused=1 HTTP/1.1", host, known, "Transfer-Encoding: chunked"}) +
             "FFFFFFFFFFFFFFFF\r\n" + std::string(5000, 'a'),
         " 413 "},
        {lines({"POST /steer?paused=1 HTTP/1.1", host, known, "Transfer-Encoding: chunked"}) +
             "5\r\nhello\r\n0\r\n\r\n",
         " 413 "},
        {lines({"GET /reference HTTP/1.1", host}), " 403 "},
        {lines({"GET /reference?file=/etc/passwd HTTP/1.1", host, known}), " 404 "},
        {lines({"POST /steer?turn=1e400 HTTP/1.1", host, known, empty}), " 400 "},
        {lines({"POST /steer?azimuth=nan&elevation=1 HTTP/1.1", host, known, empty}), " 400 "},
        {lines({"POST /steer?variant=../../etc/passwd HTTP/1.1", host, known, empty}), " 400 "},
        {lines({"POST /steer?seconds=-inf HTTP/1.1", host, known, empty}), " 400 "},
        {lines({"POST /steer?turn=1 HTTP/1.1", host, empty}), " 403 "}, // no token
        {lines({"PUT / HTTP/1.1", host, known, empty}), " 405 "},
        {lines({"OPTIONS /steer HTTP/1.1", host, "Origin: http://evil.example"}), " 405 "},
        {lines({"TRACE / HTTP/1.1", host, known}), ""},
        {lines({"GET http://evil.example/ HTTP/1.1", "Host: evil.example"}), " 403 "},
        {many + "\r\n", " 431 "},
    };
}

TEST(HostileRequests, AThousandOfThemChangeNothing) {
    const RenderRequest request = smallPicture(400);
    const ServedView view(request);
    const Client client = view.client();
    client.frame(0);
    const std::vector<Hostile> all = hostileRequests(view.server().port(), view.server().token());
    std::array<std::thread, 4> senders;
    for (size_t s = 0; s < senders.size(); ++s)
        senders[s] = std::thread([&, s] {
            for (size_t i = s; i < 1000; i += senders.size()) {
                const Hostile& hostile = all[i % all.size()];
                const std::string answer = client.raw(hostile.bytes, hostile.status.empty());
                EXPECT_THAT(answer, testing::HasSubstr(hostile.status))
                    << hostile.bytes.substr(0, 200);
                EXPECT_THAT(answer, testing::Not(testing::HasSubstr(" 204 ")));
            }
        });
    for (std::thread& sender : senders)
        sender.join();
    const ReadFrame last = client.finished();
    EXPECT_TRUE(last.says("epoch", "1")); // nobody has moved the camera
    const Film film = alone(onTheReference(), view.scene(), request);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        EXPECT_NEAR(last.values[i * 3], film.pixels[i].mean.x, film.pixels[i].mean.x / 2048 + 1e-7);
}

/// A connection that asks for a lot and reads nothing.
class SlowReader {
  public:
    explicit SlowReader(uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        const int little = 4096;
        ::setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &little, sizeof little);
        sockaddr_in address = {};
        address.sin_family = AF_INET;
        address.sin_port = htons(port);
        address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        if (::connect(socket_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
            throw std::runtime_error("cannot connect");
        std::string pages; // ten megabytes of answers
        for (int i = 0; i < 400; ++i)
            pages += lines({"GET / HTTP/1.1", fmt::format("Host: 127.0.0.1:{}", port)});
        static_cast<void>(::send(socket_, pages.data(), pages.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
    }
    ~SlowReader() { ::close(socket_); }
    SlowReader(const SlowReader&) = delete;
    SlowReader& operator=(const SlowReader&) = delete;

  private:
    int socket_;
};

TEST(HostileRequests, SlowReadersKeepNobodyWaiting) {
    const ServedView view(smallPicture(200));
    std::vector<std::unique_ptr<SlowReader>> readers;
    for (int i = 0; i < 8; ++i)
        readers.push_back(std::make_unique<SlowReader>(view.server().port()));
    EXPECT_EQ(view.client().finished().number("samples"), 200);
}

TEST(HostileRequests, TooManyWaitingPagesAreSentAway) {
    const ServedView view(smallPicture(1));
    const Client client = view.client();
    const auto number = uint64_t(client.finished().number("number"));
    std::vector<std::thread> pages;
    std::atomic<int> away = 0, none = 0;
    for (size_t i = 0; i < Exchange::kMostWaiting + 4; ++i)
        pages.emplace_back([&] {
            const int status =
                client.get(fmt::format("/frame?shown=picture&after={}", number + 1000)).status;
            ++(status == 503 ? away : none);
        });
    for (std::thread& page : pages)
        page.join();
    EXPECT_GT(none, 0);
    EXPECT_GT(away, 0);
}

} // namespace
} // namespace stromboli::view
