// Where the ray meets the sphere: name and depth only. What it looks like there is found once per pixel, later.
#include "rays.glsl"

flat in vec4 ball;
flat in uint name;
layout(location = 0) out uint seen;

void main() {
  vec3 ray = rayThrough(gl_FragCoord.xy);
  float square = dot(ray, ray);
  float closest = dot(ball.xyz, ray) / square;
  vec3 miss = ball.xyz - closest * ray;  // from the ray to the centre: no difference of large numbers, so silhouettes stay sharp
  float rest = ball.w * ball.w - dot(miss, miss);
  if (!(rest >= 0.0)) discard;
  float hit = closest - sqrt(rest / square);
  if (!(hit >= nearPlane)) discard;
  gl_FragDepth = nearPlane / hit;
  seen = name;
}
