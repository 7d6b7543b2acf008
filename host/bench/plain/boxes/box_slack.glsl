// In the place of shaders/robust/box_slack.glsl: boxes as rounding leaves them, which lose some hits.
const float BOX_SLACK = 1.0;
