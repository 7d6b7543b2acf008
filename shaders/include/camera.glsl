// Camera rays (scene/camera/camera.hpp defines the camera).

struct CameraRay {
    vec3 origin;
    vec3 direction; ///< unit
    float tMin, tMax;
};

/// The ray through picture coordinates s, t in [0, 1], from the left and from the top.
CameraRay cameraRay(float s, float t) {
    const vec3 offset = (2.0 * s - 1.0) * frame.cameraRight + (1.0 - 2.0 * t) * frame.cameraUp;
    CameraRay ray;
    ray.origin = frame.cameraPosition;
    ray.direction = -frame.cameraBack;
    float alongAxis = 1.0; // length of the ray per unit of depth
    if (ORTHOGRAPHIC) {
        ray.origin += offset;
    } else {
        const vec3 d = offset - frame.cameraBack;
        ray.direction = unit(d);
        if (!CLIP_ALONG_RAY) alongAxis = length(d);
    }
    ray.tMin = frame.nearDistance * alongAxis;
    ray.tMax = min(frame.farDistance * alongAxis, INFINITE_DISTANCE);
    return ray;
}
