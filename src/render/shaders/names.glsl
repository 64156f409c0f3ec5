// What the visibility buffer holds: 0 for nothing, 1 + grain, or a wall with its look and its normal (towards the eye).
const uint wallFlag = 0x80000000u;
const uint lookShift = 20u;
const uint lookMask = 0x7ffu;

bool isWall(uint name) { return (name & wallFlag) != 0u; }
int lookOf(uint name) { return int((name >> lookShift) & lookMask); }

// Octahedral map with 10 bits a side: good to a fifth of a degree.
uint packedNormal(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0.0) p = (1.0 - abs(p.yx)) * vec2(p.x < 0.0 ? -1.0 : 1.0, p.y < 0.0 ? -1.0 : 1.0);
  uvec2 q = uvec2(clamp(p * 511.0 + 511.5, 0.0, 1022.9));
  return q.x | (q.y << 10);
}

vec3 normalOf(uint name) {
  vec2 p = (vec2(name & 1023u, (name >> 10) & 1023u) - 511.0) / 511.0;
  vec3 n = vec3(p, 1.0 - abs(p.x) - abs(p.y));
  if (n.z < 0.0) n.xy = (1.0 - abs(n.yx)) * vec2(n.x < 0.0 ? -1.0 : 1.0, n.y < 0.0 ? -1.0 : 1.0);
  return normalize(n);
}
