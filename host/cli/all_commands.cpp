// All commands, in the order in which --help lists them, and how it teaches them: in groups, the
// options that are used most first, and examples.
#include "host/cli/declared_command.hpp"

#include <array>
#include <iterator>
#include <sstream>
#include <string>

namespace stromboli {
namespace {

struct Entry {
    const char* group; ///< of --help
    const char* name;
    const char* description;
    void (*declare)(DeclaredCommand&);
    /// Options that come first, with spaces between; of commands that have few: none.
    const char* common;
    std::array<const char*, 3> examples; ///< behind "stromboli NAME "
};

constexpr const char* kPictures = "Pictures";
constexpr const char* kScenes = "Scenes and devices";
constexpr const char* kJudging = "Judging and measuring";
constexpr const char* kMachines = "Several machines";

constexpr Entry kEntries[] = {
    {kPictures,
     "render",
     "Render a scene to a picture",
     declareRender,
     "-o -r -s --time --noise --denoise --preset --camera --look-from --look-at --env --view "
     "--exposure",
     {"room.gltf -o room.png --time 2m --denoise on",
      "room.gltf -o room.exr -r 1920x1080 --noise 2%",
      "helmet.glb -o helmet.png --preset product --ground on"}},
    {kPictures,
     "view",
     "Look at a scene in a browser, move about in it, and watch the picture get better",
     declareView,
     "-r -m --open --port --host --camera --look-from --look-at --env --sun --view --exposure "
     "--denoise",
     {"room.gltf --open", "helmet.glb --env studio --view agx",
      "room.gltf --host 0.0.0.0 --port 8000"}},
    {kPictures,
     "tonemap",
     "Make a picture for a screen from one of radiance (EXR, HDR, PFM), as render does",
     declareTonemap,
     "",
     {"room.exr -o room.png --view agx", "room.exr -o room.jpg --exposure auto --quality 90",
      "room.exr -o normals.png --layer normal"}},
    {kPictures,
     "denoise",
     "Take the noise out of a picture of radiance (EXR), and say how far it is from the truth",
     declareDenoise,
     "",
     {"room.exr -o room.png", "room.exr -o clean.exr", "room.exr -o room.png --with oidn"}},
    {kScenes,
     "info",
     "What a scene holds, what its kernel contains, sizes of all buffers, its BVH",
     declareInfo,
     "-r --camera --json --at --env --strict --scene --variant --instances --max-texture -m",
     {"room.gltf", "room.xml --json -", "room.png"}},
    {kScenes,
     "devices",
     "List Vulkan devices and which one is chosen, and why",
     declareDevices,
     "",
     {"", "--device cpu", "--device 0"}},
    {kScenes,
     "kernels",
     "What a GPU's driver makes of the kernels of scenes: registers, spills, waves",
     declareKernels,
     "--device --device-family -m --direct --light-choice --sampler --camera --env --instances",
     {"room.gltf", "reading_room atrium --device-family gfx1100", "room.gltf --direct lights"}},
    {kJudging,
     "check",
     "Render on the device and with the CPU reference; say whether they agree",
     declareCheck,
     "-s -r -m --camera --env --direct --seed --alpha --json --device",
     {"room.gltf", "room.gltf -r 320x240 -s 256", "cornell_boxes island --json -"}},
    {kJudging,
     "compare",
     "How far a picture is from a reference: relMSE, PSNR, SSIM, FLIP, bias; limits",
     declareCompare,
     "--max-relmse --max-flip --max-bias --ztest --diff --show --json --alpha",
     {"reference.exr room.exr", "reference.exr room.exr --max-relmse 0.01 --diff where.png",
      "a.exr b.exr --ztest"}},
    {kJudging,
     "regress",
     "Test a suite of pictures against golden ones, by statistics; for CI",
     declareRegress,
     "",
     {"suite.toml", "suite.toml --update", "suite.toml --only room -o build/regress"}},
    {kJudging,
     "study",
     "Error against time and samples of several configurations; a report to look at",
     declareStudy,
     "-o -c --list --quick -r -s --seeds --target-samples --most-seconds --device",
     {"room.gltf --quick",
      "reading_room atrium -c default -c hemisphere -c \"four=-l 4\" --seeds 8", "--list"}},
    {kJudging,
     "bench",
     "Measure BVH, rays, paths, start-up; against Embree where that is installed",
     declareBench,
     "",
     {"--quick", "room.gltf", "room.gltf --repeats 9 --json bench.json"}},
    {kJudging,
     "stress",
     "Try the hard cases of docs/hard_cases.md on the device: does it do them right?",
     declareStress,
     "",
     {"", "--list", "bad-samples --full"}},
    {kMachines,
     "submit",
     "Have a cluster render a picture in shares, or frames, each by a task",
     declareSubmit,
     "-o --shares --frames --turntable --job-time --sbatch --dry-run -r -s --noise --camera --env",
     {"slurm room.gltf -o room.exr -s 4096 --shares 16 --job-time 1:00:00",
      "slurm walk.glb -o frames/a%04d.png --frames 0..239",
      "slurm room.gltf -o room.exr -s 256 --shares 16 --noise 2% --dry-run"}},
    {kMachines,
     "merge",
     "Put films of shares (render --share) together: to a picture, or to a film again",
     declareMerge,
     "",
     {"part.1.film part.2.film -o room.exr", "--complete part.1.film part.2.film -o room.png",
      "part.1.film part.2.film -o both.film"}},
    {kMachines,
     "plan",
     "Spread the samples of the next round of shares to where films are noisy",
     declarePlan,
     "",
     {"part.1.film part.2.film --noise 2% -o round2.plan",
      "part.1.film part.2.film --noise 1% -s 4096 -o round2.plan",
      "part.1.film round2.1.film --noise 2% -o round3.plan"}},
};

Words wordsOf(const std::string& text) {
    std::istringstream stream(text);
    return {std::istream_iterator<std::string>(stream), {}};
}

} // namespace

std::deque<DeclaredCommand> declareCommands() {
    std::deque<DeclaredCommand> commands;
    for (const Entry& entry : kEntries) {
        DeclaredCommand& c = commands.emplace_back();
        c.name = entry.name;
        c.description = entry.description;
        c.group = entry.group;
        entry.declare(c);
        c.list.sayChangedDefaults();
        c.list.makeCommon(wordsOf(entry.common));
        c.footer += c.footer.empty() ? "Examples:" : "\nExamples:";
        for (const std::string example : entry.examples) {
            c.examples.push_back("stromboli " + c.name + (example.empty() ? "" : " " + example));
            c.footer += "\n  " + c.examples.back();
        }
    }
    return commands;
}

} // namespace stromboli
