// The ray through a point of the window, in the frame of the eye: x right, y up, −1 along z. Window rows run from top to bottom.
uniform vec4 rays;        // scale x, scale y, offset x, offset y
uniform float nearPlane;  // m; depth = nearPlane / distance along −z: 1 at the near plane, 0 at infinity, and affine over a plane

vec3 rayThrough(vec2 window) {
  return vec3(window * rays.xy + rays.zw, -1.0);
}
