// Paint that turns with the grain. n: unit vector in the frame of the grain; width: of a pixel on its surface, in radii.
// Returns a factor for the colour.
vec3 turnedBy(vec4 q, vec3 v) { return v + 2.0 * cross(q.xyz, cross(q.xyz, v) + q.w * v); }

float painted(int pattern, vec3 n, float width) {
  float halves = smoothstep(-width, width, n.x);
  float belt = 1.0 - smoothstep(-width, width, abs(n.z) - 0.24);
  float caps = smoothstep(-width, width, abs(n.z) - 0.80);
  float tone = pattern == 1 ? halves : 1.0 - max(belt, caps);
  return pattern == 0 ? 1.0 : mix(0.45, 1.0, tone);
}
