#pragma once
// Does a mesh file end where it should? Assimp takes an STL text that breaks off for a shorter one, and does not return from a PLY file
// that does.

#include <string_view>

namespace tsubu::io {

/// `bytes`: the content of an STL file. False when it is a text that breaks off; binary files carry their length, which assimp checks.
bool isCompleteStl(std::string_view bytes);

/// `bytes`: the content of a PLY file, text or binary. False when the header or what it promises is not all there.
bool isCompletePly(std::string_view bytes);

}  // namespace tsubu::io
