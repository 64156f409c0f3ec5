// One rectangle a grain, just large enough for its picture, which off the axis is an ellipse.
#include "grains.glsl"

flat out vec4 ball;
flat out uint name;

void main() {
  int grain = gl_VertexID >> 2;
  ball = grainBall(grain);
  name = uint(grain) + 1u;
  gl_Position = vec4(cornerOf(grainBox(grain), gl_VertexID & 3), 0.5, 1.0);
}
