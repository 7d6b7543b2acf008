// Roulette by throughput (docs/theory/estimator.md, "Sample").

/// The probability with which a path goes on after a bounce. throughput: its largest component. A path that has lost less
/// than two thirds of its light is not ended, nor one that has come to where it is bright beside what the sample has got
/// so far, such as into a lit room by a door: the rest of what it brings there would be the noise.
float survival(PathState path, float throughput) {
    const float beside = path.brightness / max(largestComponent(path.radiance), TINY);
    return min(1.0, throughput * max(ROULETTE_BOLDNESS, ROULETTE_BRIGHTNESS * beside));
}

/// A light sample at the path's surface has arrived, which brings `value` times the throughput.
void noteBrightness(inout PathState path, vec3 value) {
    if (endsByThroughput()) path.brightness = max(path.brightness, largestComponent(value));
}

/// The path leaves its surface: what is farther back counts less.
void fadeBrightness(inout PathState path) {
    if (endsByThroughput()) path.brightness *= 0.5;
}
