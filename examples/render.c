/* Renders a scene and says how bright and how noisy the picture is: cc render.c $(pkg-config
 * --cflags --libs stromboli) && ./a.out SCENE OUT.exr */
#include <stdio.h>
#include <stdlib.h>
#include <stromboli/stromboli.h>

static int show(double share, void* user) {
    (void)user;
    fprintf(stderr, "\r%3.0f %%", 100 * share);
    return 0; /* anything else cancels */
}

static void check(stromboli_code code, const stromboli_error* error) {
    if (code == STROMBOLI_OK) return;
    fprintf(stderr, "error %d: %s\n", (int)code, error->message);
    exit(1);
}

int main(int count, char** words) {
    stromboli_error e;
    stromboli_scene* scene;
    stromboli_session* session;
    stromboli_info info;
    check(stromboli_scene_load(count > 1 ? words[1] : "cornell_boxes", &scene, &e), &e);
    check(stromboli_session_create(NULL, NULL, &session, &e), &e);
    stromboli_session_on_progress(session, show, NULL);
    check(stromboli_session_set(session, "samples", 16, &e), &e);
    check(stromboli_session_set(session, "width", 64, &e), &e);
    check(stromboli_session_set(session, "height", 48, &e), &e);
    check(stromboli_session_begin(session, scene, &e), &e);
    check(stromboli_session_run(session, &e), &e);
    check(stromboli_session_info(session, &info, &e), &e);
    const size_t numbers = (size_t)info.width * info.height * 3;
    float* color = malloc(numbers * sizeof *color);
    check(stromboli_session_read_color(session, color, numbers, &e), &e);
    double sum = 0;
    for (size_t i = 0; i < numbers; ++i)
        sum += color[i];
    printf("mean %.6f, noise %.4f\n", sum / (double)numbers, info.noise);
    if (count > 2) check(stromboli_session_write(session, words[2], &e), &e);
    free(color);
    stromboli_session_destroy(session);
    stromboli_scene_destroy(scene);
    return 0;
}
