// What a pixel shows, as a depth: then the early depth test spares each pixel the work for what it does not show.
// SIDE, a constant of the build: samples along the side of a pixel.
#include "names.glsl"

uniform usampler2D names;

void main() {
  ivec2 first = ivec2(gl_FragCoord.xy) * SIDE;
  bool walls = false, grains = false;
  for (int k = 0; k < SIDE * SIDE; ++k) {
    uint name = texelFetch(names, first + ivec2(k % SIDE, k / SIDE), 0).r;
    walls = walls || isWall(name);
    grains = grains || (name != 0u && !isWall(name));
  }
  gl_FragDepth = grains ? 0.75 : walls ? 0.5 : 0.25;  // as in Painter::resolve
}
