/* Stromboli as a library: a path tracer that runs in Vulkan compute shaders.
 *
 * Handles are opaque, and belong to whoever made them until they are destroyed; NULL may be
 * destroyed. Functions return STROMBOLI_OK or say what went wrong by the code that they return
 * and, if `error` is not NULL, in words. After an error, what a function was to give is untouched.
 * A handle is used by one thread at a time; different handles by any threads at the same time.
 * Nothing that belongs to the process is changed: no environment variable, no signal handler, no
 * option of the allocator (docs/guide/library.md says what programs may want to set themselves).
 *
 * Lengths are metres, y is up, angles are degrees, colours are linear (ITU-R BT.709). Matrices
 * have 16 numbers, column after column. */
#ifndef STROMBOLI_H
#define STROMBOLI_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#if defined(__GNUC__)
#define STROMBOLI_API __attribute__((visibility("default")))
#else
#define STROMBOLI_API
#endif

/* ---- Versions ------------------------------------------------------------------------------- */

/* Of this header. Functions are added with the minor number; what exists keeps its meaning until
 * the major number changes (and, while that is 0, the minor one). */
#define STROMBOLI_VERSION_MAJOR 0
#define STROMBOLI_VERSION_MINOR 1
#define STROMBOLI_VERSION_PATCH 0
#define STROMBOLI_VERSION                                                                          \
    (STROMBOLI_VERSION_MAJOR * 1000000 + STROMBOLI_VERSION_MINOR * 1000 + STROMBOLI_VERSION_PATCH)

/* Of the library that runs, as STROMBOLI_VERSION has it. */
STROMBOLI_API int32_t stromboli_version(void);
/* The same in words, with the commit: "0.1.0+12.gabcdef1". */
STROMBOLI_API const char* stromboli_version_text(void);

/* ---- Errors --------------------------------------------------------------------------------- */

typedef enum stromboli_code {
    STROMBOLI_OK = 0,
    STROMBOLI_ERROR_USAGE = 1,       /* what is asked for makes no sense */
    STROMBOLI_ERROR_SCENE = 2,       /* the scene cannot be read or makes no sense */
    STROMBOLI_ERROR_DEVICE = 3,      /* there is no usable device, or it fails */
    STROMBOLI_ERROR_DEVICE_LOST = 4, /* the device stopped working; another try may succeed */
    STROMBOLI_ERROR_OUTPUT = 5,      /* a file cannot be written */
    STROMBOLI_ERROR_MEMORY = 6,      /* the host has no memory left */
    STROMBOLI_ERROR_INTERNAL = 7     /* a mistake in the library */
} stromboli_code;

#define STROMBOLI_MESSAGE_BYTES 1024

/* What went wrong: one line of UTF-8, cut off where it is longer. Untouched by what succeeds. */
typedef struct stromboli_error {
    stromboli_code code;
    char message[STROMBOLI_MESSAGE_BYTES];
} stromboli_error;

/* ---- Scenes --------------------------------------------------------------------------------- */

/* A scene in memory, which does not change. Sessions share it, and keep it for as long as they need
 * it. */
typedef struct stromboli_scene stromboli_scene;

/* Reads a file, or a bundled scene by its name. */
STROMBOLI_API stromboli_code stromboli_scene_load(const char* source, stromboli_scene** scene,
                                                  stromboli_error* error);
/* How a file is read, by name: "environment", "strict", "variant", ... (docs/guide/library.md has
 * the table). A word, or `count` numbers where `word` is NULL. */
typedef struct stromboli_option {
    const char* name;
    const char* word;
    double numbers[3];
    size_t count;
} stromboli_option;
STROMBOLI_API stromboli_code stromboli_scene_load_with(const char* source,
                                                       const stromboli_option* options,
                                                       size_t option_count, stromboli_scene** scene,
                                                       stromboli_error* error);
STROMBOLI_API void stromboli_scene_destroy(stromboli_scene* scene);

STROMBOLI_API size_t stromboli_scene_material_count(const stromboli_scene* scene);
/* The number of the first material of that name. */
STROMBOLI_API stromboli_code stromboli_scene_find_material(const stromboli_scene* scene,
                                                           const char* name, uint32_t* number,
                                                           stromboli_error* error);
/* Lights that are not the emission of a surface; those with an area are surfaces, and objects. */
STROMBOLI_API size_t stromboli_scene_light_count(const stromboli_scene* scene);
STROMBOLI_API stromboli_code stromboli_scene_find_light(const stromboli_scene* scene,
                                                        const char* name, uint32_t* number,
                                                        stromboli_error* error);
/* Meshes and spheres where the scene has them. */
STROMBOLI_API size_t stromboli_scene_object_count(const stromboli_scene* scene);
/* NULL behind the last. Belongs to the scene. */
STROMBOLI_API const char* stromboli_scene_object_name(const stromboli_scene* scene,
                                                      uint32_t number);
STROMBOLI_API stromboli_code stromboli_scene_find_object(const stromboli_scene* scene,
                                                         const char* name, uint32_t* number,
                                                         stromboli_error* error);
/* What was left out, forgiven or assumed when the scene was read: `line` counts from 0; NULL behind
 * the last. Belongs to the scene. */
STROMBOLI_API const char* stromboli_scene_report(const stromboli_scene* scene, size_t line);

/* ---- Scenes made in memory ------------------------------------------------------------------ */

typedef struct stromboli_maker stromboli_maker;

STROMBOLI_API stromboli_code stromboli_maker_create(const char* name, stromboli_maker** maker,
                                                    stromboli_error* error);
STROMBOLI_API void stromboli_maker_destroy(stromboli_maker* maker);

/* kind: diffuse, mirror, refraction, principled, conductor, dielectric, thin_dielectric, plastic or
 * burley. */
STROMBOLI_API stromboli_code stromboli_maker_add_material(stromboli_maker* maker, const char* kind,
                                                          const char* name, uint32_t* number,
                                                          stromboli_error* error);
/* A parameter of the material's kind ("albedo", "roughness", "emission", ...; docs/guide/library.md
 * has the table): one number, or as many as the parameter has. */
STROMBOLI_API stromboli_code stromboli_maker_set_material(stromboli_maker* maker, uint32_t number,
                                                          const char* parameter,
                                                          const double* values, size_t count,
                                                          stromboli_error* error);

/* `bytes`: channels (3 or 4) for each of width x height texels, from the top. */
STROMBOLI_API stromboli_code stromboli_maker_add_texture(stromboli_maker* maker, uint32_t width,
                                                         uint32_t height, uint32_t channels,
                                                         const uint8_t* bytes, int is_srgb,
                                                         uint32_t* number, stromboli_error* error);
/* The same of linear floats from -65504 to 65504, which are kept in 16 bits. */
STROMBOLI_API stromboli_code stromboli_maker_add_float_texture(
    stromboli_maker* maker, uint32_t width, uint32_t height, uint32_t channels, const float* values,
    uint32_t* number, stromboli_error* error);
/* slot: base_color, roughness_metallic, normal or emission. */
STROMBOLI_API stromboli_code stromboli_maker_use_texture(stromboli_maker* maker, uint32_t material,
                                                         const char* slot, uint32_t texture,
                                                         stromboli_error* error);

/* A mesh in the caller's arrays, which are copied. */
typedef struct stromboli_mesh {
    const char* name;        /* may be NULL */
    const double* positions; /* 3 for each vertex */
    size_t vertex_count;
    const uint32_t* triangles; /* 3 vertices for each, counter-clockwise in front */
    size_t triangle_count;
    const double* normals;  /* 3 for each vertex; NULL: shaded flat */
    const double* uvs;      /* 2 for each vertex, from the upper left corner; NULL: none */
    const double* to_world; /* a matrix; NULL: the identity */
    uint32_t material;
} stromboli_mesh;
STROMBOLI_API stromboli_code stromboli_maker_add_mesh(stromboli_maker* maker,
                                                      const stromboli_mesh* mesh,
                                                      stromboli_error* error);
STROMBOLI_API stromboli_code stromboli_maker_add_sphere(stromboli_maker* maker,
                                                        const double center[3], double radius,
                                                        uint32_t material, stromboli_error* error);

/* A light that is not the emission of a surface. Start from STROMBOLI_LIGHT. */
typedef struct stromboli_light {
    const char* kind;    /* directional, point, spot, ambient or area */
    double color[3];     /* directional: irradiance; point, spot: intensity; else radiance */
    double position[3];  /* point, spot; area: the middle of the rectangle */
    double direction[3]; /* directional, spot, area: where the light goes */
    double size[2];      /* area: of the rectangle */
    double angle;        /* spot: full angle of the cone */
    double inner_angle;  /* spot: of the cone in which it is undiminished; below 0: a sharp edge */
} stromboli_light;
#define STROMBOLI_LIGHT                                                                            \
    { "point", {1, 1, 1}, {0, 0, 0}, {0, -1, 0}, {1, 1}, 90, -1 }
STROMBOLI_API stromboli_code stromboli_maker_add_light(stromboli_maker* maker,
                                                       const stromboli_light* light,
                                                       stromboli_error* error);
/* fov: over the height of the picture. */
STROMBOLI_API stromboli_code stromboli_maker_add_camera(stromboli_maker* maker,
                                                        const double from[3], const double at[3],
                                                        const double up[3], double fov,
                                                        stromboli_error* error);
/* An equirectangular picture of width x height x 3 radiances, from the top; 1 x 1: the same from
 * everywhere. rotation: about +y. */
STROMBOLI_API stromboli_code stromboli_maker_set_environment(stromboli_maker* maker, uint32_t width,
                                                             uint32_t height, const float* radiance,
                                                             double strength, double rotation,
                                                             stromboli_error* error);
/* The scene. The maker is empty afterwards. */
STROMBOLI_API stromboli_code stromboli_maker_finish(stromboli_maker* maker, stromboli_scene** scene,
                                                    stromboli_error* error);

/* ---- Sessions ------------------------------------------------------------------------------- */

/* Pictures of scenes, one after the other. Devices, built scenes and compiled kernels are kept from
 * one to the next. */
typedef struct stromboli_session stromboli_session;

/* backend: vulkan or reference; NULL: vulkan. device: as `stromboli render --device` has it; NULL:
 * the best. */
STROMBOLI_API stromboli_code stromboli_session_create(const char* backend, const char* device,
                                                      stromboli_session** session,
                                                      stromboli_error* error);
STROMBOLI_API void stromboli_session_destroy(stromboli_session* session);

/* A setting of the pictures that are begun from now on: "samples", "width", "height", "seed",
 * "max_bounces", "look_from", "layers", ... (docs/guide/library.md has the table). Yes and no are 1
 * and 0. */
STROMBOLI_API stromboli_code stromboli_session_set(stromboli_session* session, const char* name,
                                                   double value, stromboli_error* error);
STROMBOLI_API stromboli_code stromboli_session_set_numbers(stromboli_session* session,
                                                           const char* name, const double* values,
                                                           size_t count, stromboli_error* error);
STROMBOLI_API stromboli_code stromboli_session_set_word(stromboli_session* session,
                                                        const char* name, const char* value,
                                                        stromboli_error* error);
/* All settings are those of `stromboli render` again. */
STROMBOLI_API void stromboli_session_reset(stromboli_session* session);

/* Called several times a second while samples are taken, on the thread that takes them; share: of
 * the work, 0 to 1. Not 0: the picture is cancelled. */
typedef int (*stromboli_progress)(double share, void* user);
STROMBOLI_API void stromboli_session_on_progress(stromboli_session* session,
                                                 stromboli_progress progress, void* user);

/* Begins a picture. Nothing is built before the first pass. */
STROMBOLI_API stromboli_code stromboli_session_begin(stromboli_session* session,
                                                     const stromboli_scene* scene,
                                                     stromboli_error* error);
/* Begins it again, seen from another point. fov: 0 keeps the angle that it has. The settings keep
 * the camera that they have. */
STROMBOLI_API stromboli_code stromboli_session_move_camera(stromboli_session* session,
                                                           const double from[3], const double at[3],
                                                           double fov, stromboli_error* error);
/* Begins it again with another number of a material, of the session alone: neither the scene is
 * built anew nor, in most cases, a kernel compiled. */
STROMBOLI_API stromboli_code stromboli_session_set_material(stromboli_session* session,
                                                            uint32_t number, const char* parameter,
                                                            const double* values, size_t count,
                                                            stromboli_error* error);
/* Likewise of a light: "color", "position", "direction", "angle", "inner_angle" (stromboli_light).
 * Nothing is built anew. */
STROMBOLI_API stromboli_code stromboli_session_set_light(stromboli_session* session,
                                                         uint32_t number, const char* parameter,
                                                         const double* values, size_t count,
                                                         stromboli_error* error);
/* Begins it again with an object elsewhere: `motion`, a matrix, is from where the scene has it;
 * NULL puts it back. It has an inverse and does not mirror; that of a sphere stretches all
 * directions alike. What the first motion leaves where it is gets a tree of its own, and is not
 * built again by those that follow. */
STROMBOLI_API stromboli_code stromboli_session_move_object(stromboli_session* session,
                                                           uint32_t number, const double motion[16],
                                                           stromboli_error* error);

/* Takes samples until a pass is done. *has_more becomes 0 when the picture is finished or
 * cancelled. */
STROMBOLI_API stromboli_code stromboli_session_pass(stromboli_session* session, int* has_more,
                                                    stromboli_error* error);
/* All passes. */
STROMBOLI_API stromboli_code stromboli_session_run(stromboli_session* session,
                                                   stromboli_error* error);
/* From any thread: the picture ends within a fraction of a second of sampling. */
STROMBOLI_API void stromboli_session_cancel(stromboli_session* session);

/* ---- What a picture holds, between passes and when it is over ------------------------------- */

typedef struct stromboli_info {
    uint32_t width, height; /* of what is rendered: the crop, or the whole */
    int is_over, is_cancelled;
    double samples_per_pixel; /* on the mean */
    double render_seconds;
    /* The square root of the picture's relMSE, and a range that holds it in 95 of 100 renders;
     * below 0: not known. */
    double noise, noise_least, noise_most;
} stromboli_info;
STROMBOLI_API stromboli_code stromboli_session_info(stromboli_session* session,
                                                    stromboli_info* info, stromboli_error* error);

/* Copies width x height floats of a channel, rows from the top: R, G, B (radiance), samples,
 * variance.R, .G, .B (of the mean), A, and those of the layers that the settings name. count: of
 * floats that `values` has room for. */
STROMBOLI_API stromboli_code stromboli_session_read(stromboli_session* session, const char* channel,
                                                    float* values, size_t count,
                                                    stromboli_error* error);
/* R, G, B of each pixel, one pixel after the other: width x height x 3 floats. */
STROMBOLI_API stromboli_code stromboli_session_read_color(stromboli_session* session, float* values,
                                                          size_t count, stromboli_error* error);
/* Writes the picture: .exr (with all channels), .png, .jpg or .webp. */
STROMBOLI_API stromboli_code stromboli_session_write(stromboli_session* session, const char* file,
                                                     stromboli_error* error);

/* What the library has to say, oldest first: a line at a time, 0 if there is none. severity: 0
 * detail, 1 information, 2 warning, 3 error. The line is cut off where `text` has no room. */
STROMBOLI_API int stromboli_session_message(stromboli_session* session, int* severity, char* text,
                                            size_t bytes);

#ifdef __cplusplus
}
#endif

#endif
