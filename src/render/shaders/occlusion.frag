// SIDE, a constant of the build: samples along the side of a pixel.
// Multiplied into the picture of what the walls still see of the sky.
#include "rays.glsl"
#include "names.glsl"
#include "occlusion.glsl"

uniform usampler2D names;
uniform sampler2D depths;

flat in vec4 ball;
layout(location = 0) out float share;

void main() {
  ivec2 sampled = ivec2(gl_FragCoord.xy) * SIDE + SIDE / 2;
  uint name = texelFetch(names, sampled, 0).r;
  vec3 point = rayThrough(vec2(sampled) + 0.5) * (nearPlane / max(texelFetch(depths, sampled, 0).r, 1e-9));
  vec3 towards = ball.xyz - point;
  float reach = length(towards) / ball.w;
  float hidden = hiddenBy(normalOf(name), towards, ball.w) * (1.0 - smoothstep(1.6, 3.0, reach));
  share = isWall(name) ? 1.0 - hidden : 1.0;
}
