// Options: the device, the host's threads, how much is said.
#include "host/cli/declared_command.hpp"

namespace stromboli {

void declareFilmMemory(DeclaredCommand& c) {
    c.list.group("Device");
    c.list
        .number("--film-memory", "MIB",
                "mebibytes for the film and what belongs to it; a picture that needs more is "
                "rendered in bands",
                c.options.filmMebibytes, {1, 1u << 30})
        .usually("half of the machine's memory")
        .besidePicture();
}

void declareDevice(DeclaredCommand& c) {
    c.list.group("Device");
    c.list
        .text("--device", "D",
              "number, UUID or part of a name from 'stromboli devices', or cpu; of 'render' also "
              "several, with commas between them, or all",
              c.options.device)
        .usually("the best")
        .besidePicture()
        .proposes({"cpu", "all"});
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
