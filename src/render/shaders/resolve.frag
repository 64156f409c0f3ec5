// Constants of the build: SIDE, samples along the side of a pixel; SHOWS, what the pixels show that this is for: 0 nothing, 1 walls,
// 2 grains and anything else (see classify.frag).
// From names to light: each surface that has a sample in the pixel is shaded once, where the mean of its samples lies, and counts by the
// number of its samples.
#include "rays.glsl"
#include "grains.glsl"
#include "names.glsl"
#include "occlusion.glsl"
#include "pattern.glsl"
#include "shadow.glsl"

uniform usampler2D names;
uniform sampler2D depths;
uniform sampler2D wallShares;   // what the walls still see of the sky
uniform sampler2D sheets;       // translucent walls and lines, premultiplied, encoded
uniform samplerBuffer neighbours;  // offset and radius in radii of the grain
uniform samplerBuffer looks;    // one texel a look: linear colour, 1 for a ground
uniform bool hasSheets;
uniform vec2 pictureSize;       // pixels
uniform vec3 skyTop, skyBottom; // background, encoded
uniform vec3 up, sun;           // unit vectors in the frame of the eye
uniform float sunStrength, skyStrength, shadowStrength, occlusionStrength;
uniform float shadowOffset;     // m along the normal, for walls
uniform float focus;            // m to what the camera looks at

layout(location = 0) out vec4 colour;

vec3 decoded(vec3 c) { return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045))); }
vec3 encoded(vec3 c) { return mix(c * 12.92, 1.055 * pow(max(c, 1e-6), vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308))); }

// Linear up to 0.7, then bends towards 1: highlights keep their hue.
vec3 softened(vec3 c) { return mix(c, 1.0 - 0.3 * exp((0.7 - c) / 0.3), greaterThan(c, vec3(0.7))); }

// Uniform in −½ … ½, from the place in the picture alone: gradients do not band and films do not flicker.
float grainOfPaper(uvec2 p) {
  uint h = p.x * 0x9e3779b9u ^ p.y * 0x85ebca6bu;
  h ^= h >> 16; h *= 0x7feb352du; h ^= h >> 15; h *= 0x846ca68bu; h ^= h >> 16;
  return float(h >> 8) / 16777216.0 - 0.5;
}

struct Surface {
  vec3 point, normal, paint;
  float share;  // of the sky that is not hidden
  float gloss;
  float veil;   // how far it has faded into the background
  vec2 slope;   // see slopeOf in shadow.glsl; discs that stand for grains never shade their own grain
};

Surface wallAt(uint name, float depth, float share, vec3 ray) {
  vec4 look = texelFetch(looks, lookOf(name));
  Surface s;
  s.point = ray * (nearPlane / depth);
  s.normal = normalOf(name);
  s.paint = look.rgb;
  s.share = share;
  s.gloss = 0.25 * (1.0 - look.a);
  s.slope = slopeOf(s.normal);
  s.veil = look.a * smoothstep(0.6, 2.4, length(s.point - vec3(0.0, 0.0, -focus)) / focus);
  return s;
}

Surface grainAt(int grain, vec3 ray) {
  vec4 ball = grainBall(grain), paint = grainPaint(grain), list = grainNeighbours(grain);
  float square = dot(ray, ray), closest = dot(ball.xyz, ray) / square;
  vec3 miss = ball.xyz - closest * ray;
  float hit = closest - sqrt(max(ball.w * ball.w - dot(miss, miss), 0.0) / square);
  Surface s;
  s.point = hit * ray;
  s.normal = normalize(s.point - ball.xyz);
  float facing = max(-dot(s.normal, ray) * inversesqrt(square), 0.15);
  float width = 0.75 * hit * length(rays.xy) * float(SIDE) / (ball.w * facing);
  s.paint = paint.rgb * painted(int(paint.a), turnedBy(grainTurn(grain), s.normal), width);
  s.gloss = 1.0;
  s.veil = 0.0;
  s.slope = vec2(0.0);
  s.share = 1.0;
  int first = int(list.x), end = first + int(list.y);
  for (int k = first; k < end; ++k) {
    vec4 other = texelFetch(neighbours, k);
    s.share *= 1.0 - hiddenBy(s.normal, other.xyz - s.normal, other.w);
  }
  return s;
}

float pow2(float x) { return x * x; }

vec3 lit(Surface s, vec3 ray) {
  vec3 towardsEye = -normalize(ray);
  float height = dot(s.normal, sun);
  float seen = mix(1.0, sunlight(s.point + shadowOffset * s.normal, height > 0.0, s.slope), shadowStrength);
  float share = max(1.0 - occlusionStrength * (1.0 - s.share), 0.0);
  vec3 sky = mix(vec3(0.23, 0.22, 0.21), vec3(0.47, 0.50, 0.54), 0.5 + 0.5 * dot(s.normal, up)) * (skyStrength * share);
  vec3 direct = vec3(1.0, 0.965, 0.90) * (0.90 * sunStrength * seen);
  vec3 halfway = normalize(sun + towardsEye);
  float m2 = pow2(max(dot(s.normal, halfway), 0.0)), m8 = pow2(pow2(m2));
  float mirror = pow2(pow2(m8)) * m8 * 0.16 * step(0.0, height);
  float rim = pow2(pow2(1.0 - max(dot(s.normal, towardsEye), 0.0))) * 0.20;
  return s.paint * (direct * max(height, 0.0) + sky) + s.gloss * (direct * mirror + sky * rim);
}

#if SHOWS > 0
// Each surface of the pixel is shaded once. Returns their sum, weighted by samples, and the number of samples.
vec4 surfaces(ivec2 first, float wallShare, vec3 backLight) {
  const int samples = SIDE * SIDE;
  uint seen[samples];
  for (int k = 0; k < samples; ++k) seen[k] = texelFetch(names, first + ivec2(k % SIDE, k / SIDE), 0).r;
  vec4 sum = vec4(0.0);
  for (;;) {
    // The first name left, its samples, and their mean place; they are then crossed out.
    uint name = 0u;
    ivec2 leader = first;
    for (int k = samples - 1; k >= 0; --k) {
      leader = seen[k] != 0u ? first + ivec2(k % SIDE, k / SIDE) : leader;
      name = seen[k] != 0u ? seen[k] : name;
    }
    if (name == 0u) return sum;
    bool wall = isWall(name);
    uint key = wall ? name >> lookShift : name;
    vec2 middle = vec2(0.0);
    int count = 0;
    for (int k = 0; k < samples; ++k) {
      bool same = (isWall(seen[k]) ? seen[k] >> lookShift : seen[k]) == key;
      middle += same ? vec2(k % SIDE, k / SIDE) : vec2(0.0);
      count += same ? 1 : 0;
      seen[k] = same ? 0u : seen[k];
    }
    vec3 ray = rayThrough((wall ? vec2(leader) : vec2(first) + middle / float(count)) + 0.5);
    Surface s = wallAt(name, texelFetch(depths, leader, 0).r, wallShare, ray);
#if SHOWS > 1
    Surface grain = grainAt(wall ? 0 : int(name) - 1, ray);
    if (!wall) s = grain;
#endif
    sum += vec4(mix(softened(lit(s, ray)), backLight, s.veil), 1.0) * float(count);
  }
}
#endif

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), first = pixel * SIDE;
  float samples = float(SIDE * SIDE);
  vec3 result = mix(skyTop, skyBottom, gl_FragCoord.y / pictureSize.y);
#if SHOWS > 0
  vec3 backLight = decoded(result);
  vec4 sum = surfaces(first, texelFetch(wallShares, pixel, 0).r, backLight);
  result = encoded((sum.rgb + backLight * (samples - sum.a)) / samples);
#endif
  if (hasSheets) {
    vec4 over = vec4(0.0);
    for (int k = 0; k < SIDE * SIDE; ++k) over += texelFetch(sheets, first + ivec2(k % SIDE, k / SIDE), 0);
    over /= samples;
    result = result * (1.0 - over.a) + over.rgb;
  }
  colour = vec4(floor(result * 255.0 + 0.5 + 0.98 * grainOfPaper(uvec2(pixel))) / 255.0, 1.0);
}
