#include "host/bench/plain_kernels.hpp"

#include "embedded/plain_path_all_storage.h"
#include "embedded/plain_path_all_texel.h"
#include "embedded/plain_path_offsets_storage.h"
#include "embedded/plain_path_offsets_texel.h"
#include "embedded/plain_path_terminator_storage.h"
#include "embedded/plain_path_terminator_texel.h"
#include "embedded/plain_rays_all_storage.h"
#include "embedded/plain_rays_all_texel.h"
#include "embedded/plain_rays_boxes_storage.h"
#include "embedded/plain_rays_boxes_texel.h"
#include "embedded/plain_rays_triangles_storage.h"
#include "embedded/plain_rays_triangles_texel.h"

namespace stromboli::bench {

std::vector<PlainKernel> plainRayKernels() {
    return {{"plain triangles", plain_rays_triangles_texel, plain_rays_triangles_storage},
            {"plain boxes", plain_rays_boxes_texel, plain_rays_boxes_storage},
            {"both plain", plain_rays_all_texel, plain_rays_all_storage}};
}

std::vector<PlainKernel> plainPathKernels() {
    return {{"plain offsets", plain_path_offsets_texel, plain_path_offsets_storage},
            {"no terminator", plain_path_terminator_texel, plain_path_terminator_storage},
            {"all plain", plain_path_all_texel, plain_path_all_storage}};
}

} // namespace stromboli::bench
