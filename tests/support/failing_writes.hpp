#pragma once

#include <csignal>
#include <cstdlib>
#include <sys/resource.h>
#include <unistd.h>

namespace stromboli::test {

/// Root may write anywhere; as nobody, permissions count.
class AsNobody {
  public:
    AsNobody() : wasRoot_(::geteuid() == 0), changed_(!wasRoot_ || ::seteuid(65534) == 0) {}
    ~AsNobody() {
        if (wasRoot_ && changed_ && ::seteuid(0) != 0) std::abort();
    }
    AsNobody(const AsNobody&) = delete;
    AsNobody& operator=(const AsNobody&) = delete;
    bool works() const { return changed_; }

  private:
    bool wasRoot_, changed_;
};

/// Files of this process can grow no longer than `bytes`: the same path through the code as a
/// full disk, which needs no privilege to set up.
class FileSizeLimit {
  public:
    explicit FileSizeLimit(rlim_t bytes) {
        ::getrlimit(RLIMIT_FSIZE, &before_);
        const rlimit limit{bytes, before_.rlim_max};
        ::setrlimit(RLIMIT_FSIZE, &limit);
        handler_ = std::signal(SIGXFSZ, SIG_IGN);
    }
    ~FileSizeLimit() {
        ::setrlimit(RLIMIT_FSIZE, &before_);
        std::signal(SIGXFSZ, handler_);
    }
    FileSizeLimit(const FileSizeLimit&) = delete;
    FileSizeLimit& operator=(const FileSizeLimit&) = delete;

  private:
    rlimit before_{};
    void (*handler_)(int);
};

} // namespace stromboli::test
