#include "host/view/tev.hpp"

#include "host/core/error.hpp"
#include "host/core/text.hpp"
#include "host/view/picture_source.hpp"

#include <fmt/format.h>
#include <netdb.h>
#include <sys/socket.h>
#include <unistd.h>

#include <bit>
#include <condition_variable>
#include <cstring>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace stromboli::view {

// --- Packets -------------------------------------------------------------------------------------

namespace {

enum class TevPacket : uint8_t { Create = 4, Update = 6 };
constexpr uint32_t kTevChannels = 3;

class PacketWriter {
  public:
    PacketWriter(TevPacket type, size_t payload) {
        bytes_.reserve(payload);
        number(uint32_t(0)); // the length, known at the end
        bytes_ += char(type);
        bytes_ += char(0); // the window does not come to the front
    }
    template <class T>
    void number(T value) {
        for (size_t i = 0; i < sizeof(T); ++i)
            bytes_ += char(uint64_t(value) >> (8 * i) & 0xFF);
    }
    void text(const std::string& text) {
        bytes_.append(text.c_str(), std::strlen(text.c_str()) + 1); // to the first NUL
    }
    void channelNames() {
        number(int32_t(kTevChannels));
        for (const char* name : kColorChannels)
            text(name);
    }
    std::string finished() && {
        for (size_t i = 0; i < 4; ++i)
            bytes_[i] = char(uint32_t(bytes_.size()) >> (8 * i) & 0xFF);
        return std::move(bytes_);
    }

  private:
    std::string bytes_;
};

} // namespace

std::string tevCreate(const std::string& name, uint32_t width, uint32_t height) {
    PacketWriter packet(TevPacket::Create, 64 + name.size());
    packet.text(name);
    packet.number(int32_t(width));
    packet.number(int32_t(height));
    packet.channelNames();
    return std::move(packet).finished();
}

std::string tevUpdate(const std::string& name, uint32_t width, uint32_t height,
                      std::span<const float> values) {
    PacketWriter packet(TevPacket::Update, 128 + name.size() + 4 * values.size());
    packet.text(name);
    packet.channelNames();
    for (const uint32_t number : {0u, 0u, width, height})
        packet.number(int32_t(number));
    for (uint32_t c = 0; c < kTevChannels; ++c)
        packet.number(int64_t(c)); // where the channel begins
    for (uint32_t c = 0; c < kTevChannels; ++c)
        packet.number(int64_t(kTevChannels)); // from one pixel to the next
    for (const float value : values)
        packet.number(std::bit_cast<uint32_t>(value));
    return std::move(packet).finished();
}

// --- The connection ------------------------------------------------------------------------------

namespace {

constexpr int kTevPatience = 3;    ///< seconds for connecting, and for each piece that is sent
constexpr double kTevLongest = 10; ///< seconds for a picture

class Connection {
  public:
    Connection() = default;
    ~Connection() { close(); }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    bool isOpen() const { return socket_ >= 0; }
    void close() {
        if (socket_ >= 0) ::close(socket_);
        socket_ = -1;
    }
    void open(const std::string& host, const std::string& port) {
        addrinfo hints = {}, *found = nullptr;
        hints.ai_socktype = SOCK_STREAM;
        if (::getaddrinfo(host.c_str(), port.c_str(), &hints, &found) != 0) return;
        for (const addrinfo* a = found; a && !isOpen(); a = a->ai_next) {
            socket_ = ::socket(a->ai_family, a->ai_socktype | SOCK_CLOEXEC, a->ai_protocol);
            if (socket_ < 0) continue;
            const timeval patience = {kTevPatience, 0}; // Linux takes it for connect(), too
            ::setsockopt(socket_, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
            if (::connect(socket_, a->ai_addr, a->ai_addrlen) != 0) close();
        }
        ::freeaddrinfo(found);
    }
    /// Closes it where that fails or takes too long.
    void send(const std::string& bytes) {
        const Stopwatch watch;
        for (size_t sent = 0; isOpen() && sent < bytes.size();) {
            const ssize_t count =
                ::send(socket_, bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
            if (count <= 0 || watch.seconds() > kTevLongest)
                close();
            else
                sent += size_t(count);
        }
    }

  private:
    int socket_ = -1;
};

class TevObserver final : public Observer {
  public:
    TevObserver(std::string host, std::string port, std::string name, double everySeconds)
        : host_(std::move(host)), port_(std::move(port)), name_(std::move(name)),
          everySeconds_(everySeconds), thread_([this] { sendAll(); }) {}
    ~TevObserver() override {
        {
            const std::lock_guard lock(mutex_);
            ends_ = true;
        }
        changed_.notify_all();
        thread_.join();
    }

    void beginPicture() override { next_ = 0; }
    bool wants(const RenderProgress& progress) override {
        return progress.samplesDone > 0 && watch_.seconds() >= next_;
    }
    void look(RenderSession& session, bool isOver) override {
        if (!isOver && watch_.seconds() < next_) return;
        PictureSource source(session);
        Raster raster = source.raster(Shown::Picture);
        next_ = watch_.seconds() + everySeconds_;
        const std::lock_guard lock(mutex_);
        latest_ = std::move(raster);
        changed_.notify_all();
    }

  private:
    void sendAll() {
        Connection connection;
        uint32_t width = 0, height = 0; // of the picture that tev has
        for (;;) {
            std::optional<Raster> raster;
            {
                std::unique_lock lock(mutex_);
                changed_.wait(lock, [&] { return ends_ || latest_; });
                if (!latest_) return;
                raster = std::exchange(latest_, {});
            }
            if (!connection.isOpen()) {
                connection.open(host_, port_);
                width = 0;
            }
            if (width != raster->width || height != raster->height)
                connection.send(tevCreate(name_, raster->width, raster->height));
            connection.send(tevUpdate(name_, raster->width, raster->height, raster->values));
            width = raster->width;
            height = raster->height;
        }
    }

    std::string host_, port_, name_;
    double everySeconds_, next_ = 0;
    Stopwatch watch_;
    std::mutex mutex_;
    std::condition_variable changed_;
    std::optional<Raster> latest_;
    bool ends_ = false;
    std::thread thread_; ///< the last member: it uses the others
};

} // namespace

std::unique_ptr<Observer> sendingToTev(const std::string& address, const std::string& name,
                                       double everySeconds) {
    const size_t colon = address.rfind(':');
    const auto port = colon == std::string::npos
                          ? std::optional<uint64_t>()
                          : wholeNumber(std::string_view(address).substr(colon + 1));
    if (!port || *port == 0 || *port > 65535 || colon == 0)
        throw UsageError(
            fmt::format("--tev is '{}'; expected HOST:PORT, as 127.0.0.1:14158", address));
    std::string host = address.substr(0, colon);
    if (host.size() > 2 && host.front() == '[' && host.back() == ']')
        host = host.substr(1, host.size() - 2);
    return std::make_unique<TevObserver>(host, std::to_string(*port), name, everySeconds);
}

} // namespace stromboli::view
