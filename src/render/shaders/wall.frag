#include "names.glsl"

in vec3 normal;
flat in uint look;
layout(location = 0) out uint seen;

void main() {
  seen = wallFlag | (look << lookShift) | packedNormal(normal);
}
