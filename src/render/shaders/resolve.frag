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
uniform int side;               // samples along the side of a pixel
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
};

Surface grainAt(int grain, vec3 ray) {
  vec4 ball = grainBall(grain), paint = grainPaint(grain), list = grainNeighbours(grain);
  float square = dot(ray, ray), closest = dot(ball.xyz, ray) / square;
  vec3 miss = ball.xyz - closest * ray;
  float hit = closest - sqrt(max(ball.w * ball.w - dot(miss, miss), 0.0) / square);
  Surface s;
  s.point = hit * ray;
  s.normal = normalize(s.point - ball.xyz);
  float facing = max(-dot(s.normal, ray) * inversesqrt(square), 0.15);
  float width = 0.75 * hit * length(rays.xy) * float(side) / (ball.w * facing);
  s.paint = paint.rgb * painted(int(paint.a), turnedBy(grainTurn(grain), s.normal), width);
  s.gloss = 1.0;
  s.share = 1.0;
  int first = int(list.x), end = first + int(list.y);
  for (int k = first; k < end; ++k) {
    vec4 other = texelFetch(neighbours, k);
    s.share *= 1.0 - hiddenBy(s.normal, other.xyz - s.normal, other.w);
  }
  return s;
}

vec3 lit(Surface s, vec3 ray) {
  vec3 towardsEye = -normalize(ray);
  float height = dot(s.normal, sun);
  float seen = mix(1.0, sunlight(s.point + shadowOffset * s.normal), shadowStrength);
  float share = pow(s.share, occlusionStrength);
  vec3 sky = mix(vec3(0.23, 0.22, 0.21), vec3(0.47, 0.50, 0.54), 0.5 + 0.5 * dot(s.normal, up)) * (skyStrength * share);
  vec3 direct = vec3(1.0, 0.965, 0.90) * (0.80 * sunStrength * seen);
  vec3 halfway = normalize(sun + towardsEye);
  float mirror = pow(max(dot(s.normal, halfway), 0.0), 40.0) * 0.16 * step(0.0, height);
  float rim = pow(1.0 - max(dot(s.normal, towardsEye), 0.0), 4.0) * 0.20;
  return s.paint * (direct * max(height, 0.0) + sky) + s.gloss * (direct * mirror + sky * rim);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), first = pixel * side;
  int samples = side * side;
  vec3 backdrop = mix(skyTop, skyBottom, gl_FragCoord.y / pictureSize.y);
  vec3 backLight = decoded(backdrop);
  float wallShare = texelFetch(wallShares, pixel, 0).r;
  vec3 sum = vec3(0.0);
  int covered = 0;
  int left = (1 << samples) - 1;  // samples not yet accounted for
  while (left != 0) {
    int leader = findLSB(left);
    uint name = texelFetch(names, first + ivec2(leader % side, leader / side), 0).r;
    uint key = isWall(name) ? name >> lookShift : name;
    vec2 where = vec2(0.0);
    float depth = 0.0;
    vec3 normal = vec3(0.0);
    int count = 0;
    for (int k = 0; k < samples; ++k) {
      ivec2 at = first + ivec2(k % side, k / side);
      uint other = texelFetch(names, at, 0).r;
      bool same = (left & (1 << k)) != 0 && (isWall(other) ? other >> lookShift : other) == key;
      left &= same ? ~(1 << k) : -1;
      count += same ? 1 : 0;
      where += same ? vec2(at) + 0.5 : vec2(0.0);
      depth += same ? texelFetch(depths, at, 0).r : 0.0;
      normal += same ? normalOf(other) : vec3(0.0);
    }
    vec3 ray = rayThrough(where / float(count));
    bool wall = isWall(name);
    Surface s = grainAt(wall || name == 0u ? 0 : int(name) - 1, ray);
    float veil = 0.0;
    if (wall) {
      vec4 look = texelFetch(looks, lookOf(name));
      s.point = ray * (nearPlane * float(count) / max(depth, 1e-12));
      s.normal = normalize(normal);
      s.paint = look.rgb;
      s.share = wallShare;
      s.gloss = 0.25;
      veil = look.a * smoothstep(0.6, 2.4, length(s.point - vec3(0.0, 0.0, -focus)) / focus);
      s.gloss *= 1.0 - look.a;
    }
    vec3 light = mix(softened(lit(s, ray)), backLight, veil);
    bool something = name != 0u;
    sum += something ? light * float(count) : vec3(0.0);
    covered += something ? count : 0;
  }
  float empty = float(samples - covered);
  vec3 mixed = encoded((sum + backLight * empty) / float(samples));
  vec3 result = covered == 0 ? backdrop : mixed;
  if (hasSheets) {
    vec4 over = vec4(0.0);
    for (int k = 0; k < samples; ++k) over += texelFetch(sheets, first + ivec2(k % side, k / side), 0);
    over /= float(samples);
    result = result * (1.0 - over.a) + over.rgb;
  }
  colour = vec4(floor(result * 255.0 + 0.5 + 0.98 * grainOfPaper(uvec2(pixel))) / 255.0, 1.0);
}
