#include "tests/view/served_view.hpp"

#include <arpa/inet.h>
#include <fmt/format.h>
#include <httplib.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <stdexcept>

namespace stromboli::view::test {
namespace {

httplib::Headers withToken(const std::map<std::string, std::string>& headers,
                           const std::string& token) {
    httplib::Headers all(headers.begin(), headers.end());
    if (!headers.contains("X-Stromboli-Token")) all.emplace("X-Stromboli-Token", token);
    return all;
}

Answer answerOf(const httplib::Result& result) {
    if (!result) return {};
    Answer answer{result->status, result->body, {}};
    for (const auto& [name, value] : result->headers)
        answer.headers.emplace(name, value);
    return answer;
}

LiveRequest liveRequest(std::shared_ptr<const Scene> scene, const std::string& source,
                        const RenderRequest& picture) {
    LiveRequest request;
    // A session takes a scene that nobody changes; LoadedScene's is one that loaders still may.
    request.scene.scene = std::const_pointer_cast<Scene>(scene);
    request.name = "the <scene>";
    request.picture = picture;
    request.source = {source, {}, {}};
    request.load = [](const SceneRequest& other) { return loadScene(other); };
    request.command = [](const Viewed& v) {
        return fmt::format("{} {} {} {} {}", v.pose ? v.pose->from.x : -1,
                           v.fileCamera ? int(*v.fileCamera) : -1, v.tone.view, v.tone.exposure,
                           v.denoised);
    };
    return request;
}

} // namespace

DeviceRequest onTheReference() {
    DeviceRequest request;
    request.backend = BackendChoice::Reference;
    return request;
}

// --- Frames --------------------------------------------------------------------------------------

float valueOfHalf(uint16_t half) {
    const float sign = half & 0x8000 ? -1.0f : 1.0f;
    const int exponent = half >> 10 & 31, digits = half & 1023;
    if (exponent == 31) return digits ? NAN : sign * INFINITY;
    if (exponent == 0) return sign * std::ldexp(float(digits), -24);
    return sign * std::ldexp(float(1024 + digits), exponent - 25);
}

ReadFrame readFrame(const std::string& bytes) {
    const auto byte = [&](size_t i) { return uint32_t(uint8_t(bytes.at(i))); };
    const size_t length = byte(0) | byte(1) << 8 | byte(2) << 16 | byte(3) << 24;
    ReadFrame frame;
    frame.text = bytes.substr(4, length);
    const int exponent = int(frame.number("exponent"));
    for (size_t i = 4 + length; i + 1 < bytes.size(); i += 2)
        frame.values.push_back(
            std::ldexp(valueOfHalf(uint16_t(byte(i) | byte(i + 1) << 8)), exponent));
    const double count = frame.number("width") * frame.number("height") * frame.number("channels");
    if (double(frame.values.size()) != count) throw std::runtime_error("a frame of another size");
    return frame;
}

double ReadFrame::number(const std::string& name) const {
    const auto json = nlohmann::json::parse(text);
    return json.at(name).is_number() ? json.at(name).get<double>() : NAN;
}

bool ReadFrame::says(const std::string& name, const std::string& value) const {
    return nlohmann::json::parse(text).at(name).dump() == value;
}

// --- Clients -------------------------------------------------------------------------------------

Answer Client::get(const std::string& path, std::map<std::string, std::string> headers) const {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(60);
    return answerOf(client.Get(path, withToken(headers, token_)));
}

Answer Client::post(const std::string& path, std::map<std::string, std::string> headers) const {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(60);
    return answerOf(client.Post(path, withToken(headers, token_), "", ""));
}

ReadFrame Client::frame(uint64_t after, const std::string& shown) const {
    for (;;) {
        const Answer answer = get(fmt::format("/frame?shown={}&after={}", shown, after));
        if (answer.status == 200) return readFrame(answer.body);
        if (answer.status != 204)
            throw std::runtime_error(fmt::format("{}: {}", answer.status, answer.body));
    }
}

ReadFrame Client::finished(const std::string& shown) const {
    for (uint64_t after = 0;;) {
        ReadFrame next = frame(after, shown);
        if (next.says("state", "\"done\"")) return next;
        after = uint64_t(next.number("number"));
    }
}

std::string Client::raw(const std::string& bytes, bool ends) const {
    const int socket = ::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in address = {};
    address.sin_family = AF_INET;
    address.sin_port = htons(port_);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    std::string answer;
    if (::connect(socket, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0) {
        static_cast<void>(::send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL));
        if (ends) ::shutdown(socket, SHUT_WR);
        char piece[4096];
        for (ssize_t count = 1; count > 0 && answer.find("\r\n\r\n") == std::string::npos;) {
            count = ::recv(socket, piece, sizeof piece, 0);
            if (count > 0) answer.append(piece, size_t(count));
        }
    }
    ::close(socket);
    return answer;
}

// --- A served view -------------------------------------------------------------------------------

ServedView::ServedView(const RenderRequest& request, ServerOptions options,
                       const std::string& scene)
    : scene_(stromboli::test::bundled(scene)), session_(onTheReference(), told_.listener()),
      live_(session_, exchange_, liveRequest(scene_, scene, request)), server_(options, exchange_),
      thread_([this] { live_.run([this] { return ends_.load(); }); }) {}

ServedView::~ServedView() {
    ends_ = true;
    thread_.join();
}

} // namespace stromboli::view::test
