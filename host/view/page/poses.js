// Poses: from where the camera looks at what. What a drag, the wheel and the keys make of one.

const plus = (a, b, s = 1) => a.map((v, i) => v + s * b[i]);
const times = (a, s) => a.map((v) => v * s);
const length = (a) => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
// Steeper views have another up (lookingAt() of scene/camera): the picture would jump by a turn.
const steepest = Math.acos(0.899);

function axes(pose) {
  const back = times(plus(pose.from, pose.at, -1), 1 / length(plus(pose.from, pose.at, -1)));
  const up = Math.abs(back[1]) < 0.9 ? [0, 1, 0] : [0, 0, 1];
  const right = times(cross(up, back), 1 / length(cross(up, back)));
  return { back, right, up: cross(back, right) };
}

function orbited(pose, turn, rise) {
  const d = plus(pose.from, pose.at, -1), r = length(d);
  const theta = Math.atan2(d[0], d[2]) + turn;
  const phi = Math.min(Math.max(Math.acos(d[1] / r) + rise, steepest), Math.PI - steepest);
  const to = [Math.sin(phi) * Math.sin(theta), Math.cos(phi), Math.sin(phi) * Math.cos(theta)];
  return { ...pose, from: plus(pose.at, to, r) };
}

function shifted(pose, x, y, z = 0) { // in heights of the picture, at the distance of what is looked at
  const { back, right, up } = axes(pose);
  const unit = 2 * Math.tan(pose.fov * Math.PI / 360) * length(plus(pose.from, pose.at, -1));
  const by = plus(plus(times(right, x * unit), up, y * unit), back, -z * unit);
  return { ...pose, from: plus(pose.from, by), at: plus(pose.at, by) };
}

const dollied = (pose, factor) => ({ ...pose, from: plus(pose.at, plus(pose.from, pose.at, -1), factor) });
