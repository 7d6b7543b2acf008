// stromboli_generate_scenes FOLDER: writes the generated scenes of scene/library.

#include "scene/generate/cornell_mesh.hpp"
#include "scene/generate/island.hpp"

#include <filesystem>
#include <fstream>
#include <iostream>

static bool write(const std::filesystem::path& path, const std::string& text) {
    std::ofstream file(path, std::ios::binary);
    file << text;
    file.close();
    if (!file) std::cerr << path.string() << ": cannot write\n";
    return bool(file);
}

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: stromboli_generate_scenes FOLDER\n";
        return 1;
    }
    const std::filesystem::path folder = argv[1];
    const bool written = write(folder / "cornell_mesh.dae",
                               stromboli::cornellMeshText(stromboli::cornellMesh(500, 50))) &&
                         write(folder / "island.dae", stromboli::islandScene());
    return written ? 0 : 1;
}
