// Camera rays (scene/camera/camera.hpp defines the camera).

struct CameraRay {
    vec3 origin;
    vec3 direction; ///< unit
    float tMin, tMax;
};

PictureGrid pictureGrid(const Frame frame) {
    PictureGrid grid;
    // A middle beside the view axis is in cameraBack, whose part along the axis stays 1.
    grid.corner = frame.cameraUp - frame.cameraRight;
    if (!ORTHOGRAPHIC) grid.corner -= frame.cameraBack;
    grid.right = frame.cameraRight * (2.0 / float(frame.width));
    grid.down = frame.cameraUp * (-2.0 / float(frame.height));
    return grid;
}

/// The ray through a point of the picture: pixels from the left and from the top. onLens: of the unit disk.
CameraRay cameraRay(const Frame frame, const PictureGrid grid, vec2 at, vec2 onLens) {
    const vec3 d = grid.corner + at.x * grid.right + at.y * grid.down;
    CameraRay ray;
    ray.origin = frame.cameraPosition;
    ray.direction = -frame.cameraBack;
    float alongAxis = 1.0; // length of the ray per unit of depth
    if (ORTHOGRAPHIC) {
        ray.origin += d;
    } else if (HAS_LENS) {
        const vec3 lens = frame.lensRadius * (onLens.x * unit(frame.cameraRight) + onLens.y * unit(frame.cameraUp));
        const vec3 w = frame.focusDistance * d - lens; // all rays through d meet at the distance of focus
        ray.origin += lens;
        ray.direction = unit(w);
        if (!CLIP_ALONG_RAY) alongAxis = length(w) / frame.focusDistance;
    } else {
        ray.direction = unit(d);
        if (!CLIP_ALONG_RAY) alongAxis = length(d);
    }
    ray.tMin = frame.nearDistance * alongAxis;
    ray.tMax = min(frame.farDistance * alongAxis, INFINITE_DISTANCE);
    return ray;
}
