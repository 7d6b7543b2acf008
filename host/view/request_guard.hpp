#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::view {

/// Who may ask.
struct GuardRules {
    /// What Host may say, with the port; empty: anything, where a token is asked for everywhere.
    std::vector<std::string> hosts;
    std::string token;
    bool wantsTokenForPage = false; ///< beside everything else, which always does
};

/// A request as it came, before any of it is believed.
struct RequestFacts {
    std::string method, path;       ///< the path without the query
    std::string host, origin, site; ///< headers Host, Origin, Sec-Fetch-Site; empty: not there
    std::string token;              ///< of the header or of the query
    size_t targetLength = 0;        ///< of path and query
    size_t headerCount = 0;
    bool hasBody = false; ///< announces one, of any length but 0
};

/// Why the request is refused.
struct Refusal {
    int status = 403;
    std::string reason;
};

/// Nothing: it may pass. What is refused: requests with a body, long ones, methods other than GET
/// and POST; names of this machine that are not its own (DNS rebinding); pages of other sites;
/// those who do not know the token.
std::optional<Refusal> refusalOf(const RequestFacts& request, const GuardRules& rules);

/// 32 hexadecimal digits of the system's random numbers.
std::string randomToken();

} // namespace stromboli::view
