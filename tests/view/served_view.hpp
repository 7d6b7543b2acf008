#pragma once

#include "host/view/live_view.hpp"
#include "host/view/server.hpp"
#include "tests/engine/engine_fixture.hpp"

#include <atomic>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <thread>
#include <vector>

namespace stromboli::view::test {

/// A frame as a page reads it.
struct ReadFrame {
    std::string text; ///< JSON
    std::vector<float> values;

    /// A number that the text has under this name; NaN: it has none.
    double number(const std::string& name) const;
    /// Whether the text has "name":value.
    bool says(const std::string& name, const std::string& value) const;
};
/// Throws std::runtime_error if the bytes are no frame.
ReadFrame readFrame(const std::string& bytes);

/// The number that a half float is.
float valueOfHalf(uint16_t half);

/// An answer of a server, whatever sent the question.
struct Answer {
    int status = 0; ///< 0: none
    std::string body;
    std::map<std::string, std::string> headers;
};

/// A server's page, without a browser.
class Client {
  public:
    Client(uint16_t port, std::string token) : port_(port), token_(std::move(token)) {}
    Answer get(const std::string& path, std::map<std::string, std::string> headers = {}) const;
    Answer post(const std::string& path, std::map<std::string, std::string> headers = {}) const;
    /// The next frame with a number above `after`, asked for until it comes.
    ReadFrame frame(uint64_t after, const std::string& shown = "picture") const;
    /// Frames until one is of full size and finished.
    ReadFrame finished(const std::string& shown = "picture") const;
    /// Sends these bytes, and returns what comes back up to the end of the answer's headers or,
    /// where the connection is closed before, up to there. `ends`: nothing more will be sent, and
    /// the server can know.
    std::string raw(const std::string& bytes, bool ends) const;

  private:
    uint16_t port_;
    std::string token_;
};

/// A scene that is served, on the reference, which needs no device.
class ServedView {
  public:
    explicit ServedView(const RenderRequest& request, ServerOptions options = {},
                        const std::string& scene = "cornell_spheres");
    ~ServedView();
    ServedView(const ServedView&) = delete;
    ServedView& operator=(const ServedView&) = delete;

    Client client() const { return {server_.port(), server_.token()}; }
    const Server& server() const { return server_; }
    std::shared_ptr<const Scene> scene() const { return scene_; }
    size_t count(Stage stage) const { return told_.count(stage); }

  private:
    stromboli::test::Told told_;
    Exchange exchange_;
    std::shared_ptr<const Scene> scene_;
    RenderSession session_;
    LiveView live_;
    Server server_;
    std::atomic<bool> ends_ = false;
    std::thread thread_;
};

/// The device request of the reference.
DeviceRequest onTheReference();

} // namespace stromboli::view::test
