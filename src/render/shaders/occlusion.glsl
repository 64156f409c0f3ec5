// The share of the sky above a point with normal n that a sphere hides: v from the point to its centre, r its radius. Exact while the
// sphere is wholly above the horizon of the point; below, a fit by Inigo Quilez ("sphere ambient occlusion") that fades as the sphere sets.
float hiddenBy(vec3 n, vec3 v, float r) {
  float square = dot(v, v) / (r * r);  // squared distance in radii
  float over = dot(n, v) / r;          // height of the centre above the horizon, in radii
  float partly = clamp(0.5 * (over + 1.0) / square, 0.0, 1.0);
  return over >= 1.0 ? min(over * inversesqrt(square) / square, 1.0) : partly * sqrt(partly);
}
