// Camera rays (scene/camera/camera.hpp defines the camera).

struct CameraRay {
    vec3 origin;
    vec3 direction; ///< unit
    float tMin, tMax;
};

/// From the camera to the picture, at a distance of 1 (orthographic: 0): its top left corner, and the steps
/// from one pixel to the next. The same for all rays, so found before they are.
struct PictureGrid {
    vec3 corner, right, down;
};
PictureGrid pictureGrid;

void findPictureGrid() {
    // A middle beside the view axis is in cameraBack, whose part along the axis stays 1.
    pictureGrid.corner = frame.cameraUp - frame.cameraRight;
    if (!ORTHOGRAPHIC) pictureGrid.corner -= frame.cameraBack;
    pictureGrid.right = frame.cameraRight * (2.0 / float(frame.width));
    pictureGrid.down = frame.cameraUp * (-2.0 / float(frame.height));
}

/// The ray through a point of the picture: pixels from the left and from the top. onLens: of the unit disk.
CameraRay cameraRay(vec2 at, vec2 onLens) {
    const vec3 d = pictureGrid.corner + at.x * pictureGrid.right + at.y * pictureGrid.down;
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
