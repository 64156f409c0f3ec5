// Colours here are sRGB-encoded and blended as such: two thin sheets look as painters expect, and eight bits are enough.
#include "rays.glsl"

uniform vec3 sun;

in vec4 shape;
in vec4 paint;
layout(location = 0) out vec4 colour;

void main() {
  vec3 towardsEye = -normalize(rayThrough(gl_FragCoord.xy));
  vec3 normal = normalize(shape.xyz);
  float facing = dot(normal, towardsEye);
  normal = facing < 0.0 ? -normal : normal;
  float grazing = 1.0 - abs(facing);
  // Like a pane: more opaque at a grazing angle, a glint where the sun is mirrored.
  float glint = pow(max(dot(normal, normalize(sun + towardsEye)), 0.0), 60.0);
  float faceOpacity = paint.a + (1.0 - paint.a) * (0.5 * grazing * grazing * grazing + 0.25 * glint);
  vec3 face = mix(paint.rgb, vec3(1.0), 0.15) * (0.9 + 0.1 * dot(normal, sun)) + 0.5 * glint;
  float lineOpacity = paint.a * clamp(shape.y + 0.5 - abs(shape.x), 0.0, 1.0);
  bool line = shape.w > 0.5;
  float opacity = line ? lineOpacity : min(faceOpacity, 1.0);
  colour = vec4((line ? paint.rgb : min(face, 1.0)) * opacity, opacity);
}
