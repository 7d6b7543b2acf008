#pragma once

#include "host/view/exchange.hpp"

#include <cstdint>
#include <memory>
#include <string>

namespace stromboli::view {

struct ServerOptions {
    std::string host = "127.0.0.1"; ///< the address to listen at
    uint16_t port = 0;              ///< 0: any that is free
    bool readOnly = false;          ///< pages look and do not steer
    ToneWords tone;                 ///< that pages begin with
    bool denoised = false;          ///< pages begin with the denoised picture
    /// The frame of a picture that pages compare with; null: none.
    std::shared_ptr<const std::string> reference;
};

/// Serves the page, and what it asks for, on threads of its own, from when it is made to its end.
/// At other addresses than this machine's own (loopback) nothing is served to those who do not
/// know the token, which is in address().
class Server {
  public:
    /// The exchange outlives it. Throws UsageError if it cannot listen there.
    Server(const ServerOptions& options, Exchange& exchange);
    /// Closes the exchange, so that nobody waits.
    ~Server();
    Server(const Server&) = delete;
    Server& operator=(const Server&) = delete;

    /// To be opened in a browser: "http://127.0.0.1:8080/".
    const std::string& address() const;
    uint16_t port() const;
    const std::string& token() const;

  private:
    class Threads;
    std::unique_ptr<Threads> threads_;
};

} // namespace stromboli::view
