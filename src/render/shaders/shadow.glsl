// How much of the sun a point sees. The sun is a disc, so shadows soften with the distance between what throws and what receives them:
// a coarse map, whose discs are widened by the widest penumbra, tells that distance (and where there is no shadow near, and nothing to do);
// then the texels of the fine map within the penumbra are weighted by a tent.
uniform sampler2D shadowMap, coarseMap;
uniform vec4 sunX, sunY, sunZ;  // frame of the eye to the map: texture coordinates, depth
uniform vec2 penumbra;          // texels of the fine map per unit of depth

const float narrowest = 2.0;  // texels: half the width of the tent, to smooth the texels themselves
const float widest = 20.0;    // as in painter.cpp
const float taps = 6.0;       // blocks of 2×2 texels along a side, at most

// How the depth of a plane with that normal changes with the place in the map: a wall must not be shaded by its own slope.
vec2 slopeOf(vec3 normal) {
  vec3 along = vec3(dot(normal, sunX.xyz) / dot(sunX.xyz, sunX.xyz), dot(normal, sunY.xyz) / dot(sunY.xyz, sunY.xyz),
                    dot(normal, sunZ.xyz) / dot(sunZ.xyz, sunZ.xyz));
  return clamp(-along.xy / along.z, -8.0, 8.0);
}

// The weighted share of a block of 2×2 texels that is open to the sun, and the weight. The depth that the surface has at each texel is
// compared, for the texels in the order of a gather: (0,1), (1,1), (1,0), (0,0).
vec2 openShare(vec2 texel, vec2 place, vec2 reach, float depth, vec2 slope, vec2 size) {
  float corner = depth + dot(slope, (texel - place) / size);
  vec2 next = slope / size;
  vec4 own = min(corner + vec4(next.y, next.x + next.y, next.x, 0.0), 1.0);
  vec4 open = step(own, textureGather(shadowMap, (texel + 1.0) / size));
  vec2 a = max(1.0 - abs(texel - place) / reach, 0.0), b = max(1.0 - abs(texel + 1.0 - place) / reach, 0.0);
  vec4 weight = vec4(a.x * b.y, b.x * b.y, b.x * a.y, a.x * a.y);
  return vec2(dot(open, weight), dot(weight, vec4(1.0)));
}

// `facing`: whether the surface is turned towards the sun; else nothing need be known. `slope`: of the surface, see slopeOf.
float sunlight(vec3 point, bool facing, vec2 slope) {
  vec4 p = vec4(point, 1.0);
  vec3 q = vec3(dot(sunX, p), dot(sunY, p), min(dot(sunZ, p), 1.0));  // beyond the map nothing stands in the way
  bool within = facing && all(greaterThan(q.xy, vec2(0.0))) && all(lessThan(q.xy, vec2(1.0)));
  vec2 size = vec2(textureSize(shadowMap, 0));
  vec2 place = q.xy * size - 0.5;
#if SIDE == 1
  // A draft: the four nearest texels, and shadows as hard as they are.
  vec2 share = openShare(floor(place), place, vec2(1.0), q.z, slope, size);
  return within ? share.x / share.y : 1.0;
#else
  vec4 near = textureGather(coarseMap, q.xy);
  float blocker = min(min(near.x, near.y), min(near.z, near.w));
  bool shaded = within && blocker < q.z;
  vec2 reach = clamp(penumbra * (q.z - blocker), narrowest, widest);
  vec2 stride = max(ceil(2.0 * reach / taps), 2.0);
  vec2 blocks = shaded ? ceil(2.0 * reach / stride) : vec2(0.0);
  vec2 first = floor(place) - floor(0.5 * stride * (blocks - 1.0) + 0.5);
  vec2 share = vec2(0.0);
  for (float j = 0.0; j < blocks.y; ++j) {
    for (float i = 0.0; i < blocks.x; ++i) share += openShare(first + stride * vec2(i, j), place, reach, q.z, slope, size);
  }
  return share.y > 0.0 ? share.x / share.y : 1.0;
#endif
}
