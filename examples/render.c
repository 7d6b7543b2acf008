/* Renders a scene and says how bright and how noisy the picture is: cc render.c $(pkg-config
 * --cflags --libs stromboli) && ./a.out SCENE OUT.exr */
#include <stdio.h>
#include <stdlib.h>
#include <stromboli/stromboli.h>
static stromboli_error error;
static void check(stromboli_code code) {
    if (code != STROMBOLI_OK) exit(fprintf(stderr, "error %d: %s\n", (int)code, error.message) > 0);
}
int main(int count, char** words) {
    stromboli_scene* scene;
    stromboli_session* session;
    stromboli_info info;
    static float color[64 * 48 * 3];
    double sum = 0;
    check(stromboli_scene_load(count > 1 ? words[1] : "cornell_boxes", &scene, &error));
    check(stromboli_session_create(NULL, NULL, &session, &error)); /* the best device */
    check(stromboli_session_set(session, "samples", 16, &error));
    check(stromboli_session_set(session, "width", 64, &error));
    check(stromboli_session_set(session, "height", 48, &error));
    check(stromboli_session_begin(session, scene, &error));
    check(stromboli_session_run(session, &error));
    check(stromboli_session_info(session, &info, &error));
    check(stromboli_session_read_color(session, color, 64 * 48 * 3, &error));
    for (size_t i = 0; i < 64 * 48 * 3; ++i) sum += color[i];
    printf("mean %.6f, noise %.4f\n", sum / (64 * 48 * 3), info.noise);
    if (count > 2) check(stromboli_session_write(session, words[2], &error));
    stromboli_session_destroy(session);
    stromboli_scene_destroy(scene);
}
