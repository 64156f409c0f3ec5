# cmake -DOUTPUT=… -DDIRECTORY=… -DFILES=a.vert,b.frag -P embed.cmake
# Writes a C++ file that holds the shader files as raw strings, so that the program needs no files at run time.
string(REPLACE "," ";" files "${FILES}")
set(text "// Written by embed.cmake.\n#include \"render/gl/shader_source.h\"\n\nnamespace tsubu::render {\n\n")
string(APPEND text "const std::vector<EmbeddedFile>& embeddedShaders() {\n  static const std::vector<EmbeddedFile> files{\n")
foreach(file ${files})
  file(READ "${DIRECTORY}/${file}" content)
  string(APPEND text "{\"${file}\", R\"glsl(${content})glsl\"},\n")
endforeach()
string(APPEND text "  };\n  return files;\n}\n\n}  // namespace tsubu::render\n")
file(WRITE "${OUTPUT}" "${text}")
