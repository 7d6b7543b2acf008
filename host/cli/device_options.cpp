// Options: the device, the host's threads, how much is said.
#include "host/cli/declared_command.hpp"

namespace stromboli {

void declareDevice(DeclaredCommand& c) {
    c.list.group("Device");
    c.list
        .text("--device", "D", "number, UUID or part of a name from 'stromboli devices', or cpu",
              c.options.device)
        .usually("the best")
        .besidePicture()
        .proposes({"cpu"});
}

void declareHost(DeclaredCommand& c) {
    Options& o = c.options;
    c.list.group("Device");
    c.list
        .number("-t,--threads", "N", "host threads (BVH, reference); 0: all", o.threads, {0, 65536})
        .usually("all")
        .besidePicture();
    c.list.group("Messages");
    c.list.flag("-q,--quiet", "warnings and errors only", [&o] { o.verbosity = Verbosity::Quiet; })
        .besidePicture();
    c.list.flag("-v,--verbose", "more detail", [&o] { o.verbosity = Verbosity::Verbose; })
        .besidePicture()
        .excludes("-q");
}

} // namespace stromboli
