// All commands, in the order in which --help lists them.
#include "host/cli/declared_command.hpp"

namespace stromboli {

std::deque<DeclaredCommand> declareCommands() {
    struct Row {
        const char* name;
        const char* description;
        void (*declare)(DeclaredCommand&);
    };
    static constexpr Row kRows[] = {
        {"render", "Render a scene to a picture", declareRender},
        {"check", "Render on the device and with the CPU reference; say whether they agree",
         declareCheck},
        {"info", "What a scene holds, what its kernel contains, sizes of all buffers, its BVH",
         declareInfo},
        {"kernels", "What a GPU's driver makes of the kernels of scenes: registers, spills, waves",
         declareKernels},
        {"devices", "List Vulkan devices and which one is chosen, and why", declareDevices},
        {"bench", "Measure BVH, rays, paths, start-up; against Embree where that is installed",
         declareBench},
        {"compare", "How far a picture is from a reference: relMSE, PSNR, SSIM, FLIP, bias; limits",
         declareCompare},
        {"merge", "Put films of shares (render --share) together: to a picture, or to a film again",
         declareMerge},
        {"plan", "Spread the samples of the next round of shares to where films are noisy",
         declarePlan},
        {"submit", "Have a cluster render a picture: shares on its nodes, and their merge",
         declareSubmit},
        {"study", "Error against time and samples of several configurations; a report to look at",
         declareStudy},
        {"stress", "Try the hard cases of docs/hard_cases.md on the device: does it do them right?",
         declareStress},
    };
    std::deque<DeclaredCommand> commands;
    for (const Row& row : kRows) {
        DeclaredCommand& c = commands.emplace_back();
        c.name = row.name;
        c.description = row.description;
        row.declare(c);
    }
    return commands;
}

} // namespace stromboli
