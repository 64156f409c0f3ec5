// How much of the sun a point sees: 4×4 texels of the shadow map, weighted by a tent.
uniform sampler2D shadowMap;
uniform vec4 sunX, sunY, sunZ;  // frame of the eye to the map: texture coordinates, depth

vec4 litOf(vec2 at, float depth) {
  return step(vec4(depth), textureGather(shadowMap, at));
}

float sunlight(vec3 point) {
  vec4 p = vec4(point, 1.0);
  vec3 q = vec3(dot(sunX, p), dot(sunY, p), dot(sunZ, p));
  vec2 size = vec2(textureSize(shadowMap, 0));
  vec2 texel = q.xy * size - 0.5;
  vec2 base = floor(texel), f = texel - base;
  vec2 corner = (base + 0.5) / size;  // between four texels when one further
  vec2 one = 1.0 / size;
  // A gather yields (0,1), (1,1), (1,0), (0,0) of its 2×2 block.
  vec4 a = litOf(corner + vec2(-0.5, -0.5) * one, q.z);
  vec4 b = litOf(corner + vec2(1.5, -0.5) * one, q.z);
  vec4 c = litOf(corner + vec2(-0.5, 1.5) * one, q.z);
  vec4 d = litOf(corner + vec2(1.5, 1.5) * one, q.z);
  vec4 x = vec4(1.0 - f.x, 2.0 - f.x, 1.0 + f.x, f.x), y = vec4(1.0 - f.y, 2.0 - f.y, 1.0 + f.y, f.y);
  float lit = y.x * (x.x * a.w + x.y * a.z + x.z * b.w + x.w * b.z) + y.y * (x.x * a.x + x.y * a.y + x.z * b.x + x.w * b.y) +
              y.z * (x.x * c.w + x.y * c.z + x.z * d.w + x.w * d.z) + y.w * (x.x * c.x + x.y * c.y + x.z * d.x + x.w * d.y);
  bool within = all(greaterThan(q.xy, vec2(0.0))) && all(lessThan(q.xy, vec2(1.0)));
  return within ? lit / 16.0 : 1.0;
}
