#include "host/view/server.hpp"

#include "host/core/error.hpp"
#include "host/core/system.hpp"
#include "host/core/text.hpp"
#include "host/view/page.hpp"
#include "host/view/request_guard.hpp"

#include <fmt/format.h>
#include <httplib.h>
#include <sys/socket.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string_view>
#include <thread>
#include <utility>

namespace stromboli::view {
namespace {

constexpr size_t kThreads = 24; ///< each connection holds one
constexpr int kPatience = 5;    ///< seconds for the next bytes of a request or an answer
constexpr double kLongPoll = 8; ///< seconds that a page waits for a frame before it asks again
constexpr double kLongestAnswer = 20; ///< seconds for a question, and for the bytes of an answer
constexpr size_t kPiece = 64 << 10;   ///< bytes that are handed over at once
constexpr const char* kTokenHeader = "X-Stromboli-Token";

bool isLoopback(const std::string& host) {
    return host == "127.0.0.1" || host == "localhost" || host == "::1";
}

std::string inAddress(const std::string& host) {
    return host.find(':') == std::string::npos ? host : "[" + host + "]";
}

// --- Parameters ----------------------------------------------------------------------------------

/// Throws UsageError unless it is a number of the range.
double numberOf(const httplib::Request& request, const char* name, double least, double most) {
    const std::string text = request.get_param_value(name);
    const std::optional<double> value = realNumber(text);
    if (!value || !(*value >= least && *value <= most))
        throw UsageError(fmt::format("{} is not a number from {} to {}", name, least, most));
    return *value;
}

std::optional<double> numberIfGiven(const httplib::Request& request, const char* name, double least,
                                    double most) {
    if (!request.has_param(name)) return std::nullopt;
    return numberOf(request, name, least, most);
}

std::optional<bool> flagOf(const httplib::Request& request, const char* name) {
    if (!request.has_param(name)) return std::nullopt;
    const std::string text = request.get_param_value(name);
    if (text != "0" && text != "1") throw UsageError(fmt::format("{} is not 0 or 1", name));
    return text == "1";
}

constexpr double kFarthest = 1e18; ///< as for --look-from, metres

glm::dvec3 pointOf(const httplib::Request& request, const std::string& name) {
    glm::dvec3 point;
    for (int c = 0; c < 3; ++c)
        point[c] = numberOf(request, (name + "xyz"[c]).c_str(), -kFarthest, kFarthest);
    return point;
}

Steering steeringOf(const httplib::Request& request) {
    Steering steering;
    if (request.has_param("fromx")) {
        Pose pose;
        pose.from = pointOf(request, "from");
        pose.at = pointOf(request, "at");
        if (pose.from == pose.at) throw UsageError("the view is from where it looks at");
        pose.fieldOfView = numberOf(request, "fov", 1e-6, 179.999);
        pose.aperture = numberIfGiven(request, "aperture", 0, kFarthest).value_or(0);
        pose.focus = numberIfGiven(request, "focus", 1e-9, kFarthest).value_or(1);
        steering.pose = pose;
    }
    if (const auto camera = numberIfGiven(request, "camera", 0, 1e6))
        steering.fileCamera = size_t(*camera);
    steering.turn = numberIfGiven(request, "turn", -3600, 3600);
    if (request.has_param("azimuth"))
        steering.sun = {numberOf(request, "azimuth", -3600, 3600),
                        numberOf(request, "elevation", 0, 90)};
    if (const auto variant = numberIfGiven(request, "variant", -1, 1e6))
        steering.variant = int(*variant);
    steering.seconds = numberIfGiven(request, "seconds", -1, 1e9);
    steering.moving = flagOf(request, "moving");
    steering.paused = flagOf(request, "paused");
    return steering;
}

ToneWords toneWordsOf(const httplib::Request& request) {
    ToneWords tone;
    if (request.has_param("view")) tone.view = request.get_param_value("view");
    if (request.has_param("exposure")) tone.exposure = request.get_param_value("exposure");
    return tone;
}

SaveRequest saveOf(const httplib::Request& request) {
    SaveRequest save;
    const std::string format = request.get_param_value("format");
    if (format != "png" && format != "exr") throw UsageError("format is not png or exr");
    save.format = format == "png" ? SaveRequest::Format::Png : SaveRequest::Format::Exr;
    save.tone = toneWordsOf(request);
    save.denoised = flagOf(request, "denoised").value_or(false);
    return save;
}

// --- Requests and answers ------------------------------------------------------------------------

RequestFacts factsOf(const httplib::Request& request) {
    RequestFacts facts;
    facts.method = request.method;
    facts.path = request.path;
    facts.host = request.get_header_value("Host");
    facts.origin = request.get_header_value("Origin");
    facts.site = request.get_header_value("Sec-Fetch-Site");
    facts.token = request.has_header(kTokenHeader) ? request.get_header_value(kTokenHeader)
                                                   : request.get_param_value("token");
    facts.targetLength = request.target.size();
    facts.headerCount = request.headers.size();
    const std::string length = request.get_header_value("Content-Length");
    facts.hasBody = request.has_header("Transfer-Encoding") || (!length.empty() && length != "0");
    return facts;
}

void say(httplib::Response& response, int status, const std::string& text) {
    response.status = status;
    response.set_content(text + "\n", "text/plain");
}

/// Bytes that several pages may be reading, in pieces: whoever reads too slowly is left.
void send(httplib::Response& response, std::shared_ptr<const std::string> bytes,
          const std::string& type) {
    const auto watch = std::make_shared<Stopwatch>();
    response.set_content_provider(
        bytes->size(), type, [bytes, watch](size_t offset, size_t length, httplib::DataSink& sink) {
            if (watch->seconds() > kLongestAnswer) return false;
            return sink.write(bytes->data() + offset, std::min(length, kPiece));
        });
}

void send(httplib::Response& response, const Reply& reply) {
    if (reply.status != 200) return say(response, reply.status, reply.body);
    if (!reply.fileName.empty())
        response.set_header("Content-Disposition",
                            fmt::format("attachment; filename=\"{}\"", reply.fileName));
    send(response, std::make_shared<const std::string>(reply.body), reply.type);
}

/// What is wrong with a request is said to whoever sent it.
template <class Work>
httplib::Server::Handler answering(Work work) {
    return [work](const httplib::Request& request, httplib::Response& response) {
        try {
            work(request, response);
        } catch (const UsageError& error) {
            say(response, 400, error.what());
        }
    };
}

} // namespace

// --- The server ----------------------------------------------------------------------------------

class Server::Threads {
  public:
    Threads(const ServerOptions& options, Exchange& exchange)
        : options_(options), exchange_(exchange), token_(randomToken()) {
        setUp();
        port_ = bound(options);
        const bool isOurs = isLoopback(options.host);
        rules_.token = token_;
        rules_.wantsTokenForPage = !isOurs;
        if (isOurs)
            for (const char* name : {"127.0.0.1", "localhost", "[::1]"})
                rules_.hosts.push_back(fmt::format("{}:{}", name, port_));
        address_ = fmt::format("http://{}:{}/", inAddress(options.host), port_);
        if (!isOurs) address_ += "?token=" + token_;
        thread_ = std::thread([this] { server_.listen_after_bind(); });
        while (!server_.is_running())
            std::this_thread::yield();
    }
    ~Threads() {
        exchange_.close();
        server_.stop();
        thread_.join();
    }
    Threads(const Threads&) = delete;
    Threads& operator=(const Threads&) = delete;

    const std::string& address() const { return address_; }
    const std::string& token() const { return token_; }
    uint16_t port() const { return port_; }

  private:
    uint16_t bound(const ServerOptions& options) {
        const std::string& host = options.host;
        if (options.port == 0) {
            const int port = server_.bind_to_any_port(host);
            if (port > 0) return uint16_t(port);
            throw UsageError(
                fmt::format("cannot listen at {}: this machine has no such address", host));
        }
        if (server_.bind_to_port(host, options.port)) return options.port;
        throw UsageError(fmt::format("cannot listen at {}:{}: the port is taken, or this machine "
                                     "has no such address",
                                     host, options.port));
    }

    void setUp() {
        server_.new_task_queue = [] { return new httplib::ThreadPool(kThreads); };
        server_.set_tcp_nodelay(true);
        server_.set_payload_max_length(0);
        server_.set_read_timeout(kPatience);
        server_.set_write_timeout(kPatience);
        server_.set_keep_alive_timeout(kPatience);
        server_.set_keep_alive_max_count(1000);
        // By default two programs could listen at the same port (SO_REUSEPORT).
        server_.set_socket_options([](auto socket) {
            const int yes = 1;
            ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
        });
        server_.set_pre_routing_handler([this](const auto& request, auto& response) {
            response.set_header("Cache-Control", "no-store");
            response.set_header("X-Content-Type-Options", "nosniff");
            response.set_header("Referrer-Policy", "no-referrer");
            response.set_header("Cross-Origin-Resource-Policy", "same-origin");
            const std::optional<Refusal> refusal = refusalOf(factsOf(request), rules_);
            if (!refusal) return httplib::Server::HandlerResponse::Unhandled;
            say(response, refusal->status, refusal->reason);
            return httplib::Server::HandlerResponse::Handled;
        });
        server_.set_error_handler([](const auto&, auto& response) {
            if (response.body.empty()) say(response, response.status, "there is nothing here");
        });
        server_.Get("/", answering([this](const auto&, auto& response) { sendPage(response); }));
        server_.Get("/frame", answering([this](const auto& request, auto& response) {
                        sendFrame(request, response);
                    }));
        server_.Get("/reference", answering([this](const auto&, auto& response) {
                        if (!options_.reference) return say(response, 404, "there is none");
                        send(response, options_.reference, "application/octet-stream");
                    }));
        server_.Get("/probe", answering([this](const auto& request, auto& response) {
                        const auto x = uint32_t(numberOf(request, "x", 0, 65535)),
                                   y = uint32_t(numberOf(request, "y", 0, 65535));
                        send(response, exchange_.ask([x, y](Answers& a) { return a.probe(x, y); },
                                                     kLongestAnswer));
                    }));
        server_.Get("/save", answering([this](const auto& request, auto& response) {
                        send(response, exchange_.ask([save = saveOf(request)](
                                                         Answers& a) { return a.save(save); },
                                                     kLongestAnswer));
                    }));
        server_.Get("/command", answering([this](const auto& request, auto& response) {
                        const ToneWords tone = toneWordsOf(request);
                        const bool denoised = flagOf(request, "denoised").value_or(false);
                        send(response,
                             exchange_.ask(
                                 [tone, denoised](Answers& a) { return a.command(tone, denoised); },
                                 kLongestAnswer));
                    }));
        server_.Post("/steer", answering([this](const auto& request, auto& response) {
                         if (options_.readOnly)
                             return say(response, 403, "this render can only be watched");
                         exchange_.steer(steeringOf(request));
                         response.status = 204;
                     }));
    }

    void sendPage(httplib::Response& response) const {
        PageFacts facts;
        facts.token = token_;
        facts.nonce = randomToken();
        facts.readOnly = options_.readOnly;
        facts.view = options_.tone.view;
        facts.exposure = options_.tone.exposure;
        facts.denoised = options_.denoised;
        facts.hasReference = options_.reference != nullptr;
        response.set_header("Content-Security-Policy", contentPolicy(facts.nonce));
        response.set_content(pageText(facts), "text/html; charset=utf-8");
    }

    void sendFrame(const httplib::Request& request, httplib::Response& response) {
        const std::optional<Shown> shown = valueNamed<Shown>(request.get_param_value("shown"));
        if (!shown) throw UsageError("shown is not " + allNames<Shown>());
        const auto after = uint64_t(numberOf(request, "after", 0, 1e15));
        if (!exchange_.mayWait()) return say(response, 503, "too many pages are waiting");
        const auto frame = exchange_.frameAfter(*shown, after, kLongPoll);
        if (frame) return send(response, frame, "application/octet-stream");
        if (exchange_.isClosed()) return say(response, 410, "the render has ended");
        response.status = 204;
    }

    ServerOptions options_;
    Exchange& exchange_;
    std::string token_, address_;
    GuardRules rules_;
    uint16_t port_ = 0;
    httplib::Server server_;
    std::thread thread_;
};

Server::Server(const ServerOptions& options, Exchange& exchange)
    : threads_(std::make_unique<Threads>(options, exchange)) {}
Server::~Server() = default;

const std::string& Server::address() const {
    return threads_->address();
}

uint16_t Server::port() const {
    return threads_->port();
}

const std::string& Server::token() const {
    return threads_->token();
}

} // namespace stromboli::view
