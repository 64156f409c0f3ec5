// The same cube in every format, what is read besides triangles, and what is said about files that cannot be read.

#include "io/mesh_file.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <clocale>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <locale>
#include <sstream>
#include <thread>

#include "core/error.h"

namespace tsubu::io {
namespace {

namespace fs = std::filesystem;

/// A directory of its own for the files of one test.
class MeshFile : public testing::Test {
 protected:
  void SetUp() override {
    directory_ =
        fs::temp_directory_path() / ("tsubu_mesh_file_test_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(directory_);
  }
  void TearDown() override { fs::remove_all(directory_); }

  fs::path write(const std::string& name, const std::string& content) {
    std::ofstream(directory_ / name, std::ios::binary) << content;
    return directory_ / name;
  }

  fs::path directory_;
};

using Triangle = std::array<Vec3, 3>;

constexpr int quads[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};

Vec3 corner(int k) { return {k & 1 ? 2.0 : 1.0, k & 2 ? 2.5 : 0.5, k & 4 ? 0.25 : 0.0}; }

/// The box [1, 2] × [0.5, 2.5] × [0, 0.25] in twelve triangles; all coordinates are exact in single precision.
std::vector<Triangle> box() {
  std::vector<Triangle> triangles;
  for (const auto& q : quads) {
    triangles.push_back({corner(q[0]), corner(q[1]), corner(q[2])});
    triangles.push_back({corner(q[0]), corner(q[2]), corner(q[3])});
  }
  return triangles;
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void append(std::string& bytes, const Vec3& v) {
  for (int k = 0; k < 3; ++k) append(bytes, static_cast<float>(v[k]));
}

std::string asciiStl(const std::vector<Triangle>& triangles) {
  std::ostringstream text;
  text << "solid box\n";
  for (const Triangle& t : triangles) {
    text << " facet normal 0 0 0\n  outer loop\n";
    for (const Vec3& x : t) text << "   vertex " << x.transpose() << "\n";
    text << "  endloop\n endfacet\n";
  }
  text << "endsolid box\n";
  return text.str();
}

std::string binaryStl(const std::vector<Triangle>& triangles, const std::string& header = "binary") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  append(bytes, static_cast<std::uint32_t>(triangles.size()));
  for (const Triangle& t : triangles) {
    append(bytes, Vec3(Vec3::Zero()));
    for (const Vec3& x : t) append(bytes, x);
    append(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string objWithQuads() {
  std::ostringstream text;
  text << "mtllib nowhere.mtl\no box\nusemtl red\n";
  for (int k = 0; k < 8; ++k) text << "v " << corner(k).transpose() << "\n";
  for (const auto& q : quads) text << "f " << q[0] + 1 << " " << q[1] + 1 << " " << q[2] + 1 << " " << q[3] + 1 << "\n";
  return text.str();
}

std::string asciiPlyWithQuads() {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\nelement face 6\n"
       << "property list uchar int vertex_indices\nend_header\n";
  for (int k = 0; k < 8; ++k) text << corner(k).transpose() << "\n";
  for (const auto& q : quads) text << "4 " << q[0] << " " << q[1] << " " << q[2] << " " << q[3] << "\n";
  return text.str();
}

std::string binaryPly() {
  std::string bytes =
      "ply\nformat binary_big_endian 1.0\ncomment a box\nelement vertex 8\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 6\nproperty list uchar int vertex_indices\nend_header\n";
  const auto appendSwapped = [&](auto value) {
    std::string word;
    append(word, value);
    bytes.append(word.rbegin(), word.rend());
  };
  for (int k = 0; k < 8; ++k)
    for (int axis = 0; axis < 3; ++axis) appendSwapped(static_cast<float>(corner(k)[axis]));
  for (const auto& q : quads) {
    bytes += '\4';
    for (const int k : q) appendSwapped(static_cast<std::int32_t>(k));
  }
  return bytes;
}

/// JSON and buffer of a glTF file with the corners minus (1, 0.5, 0), put back by the translation of a node and its child.
std::pair<std::string, std::string> gltfParts(const std::string& uri) {
  std::string buffer;
  for (const auto& q : quads)
    for (const int k : {0, 1, 2, 0, 2, 3}) append(buffer, static_cast<std::uint32_t>(q[k]));
  for (int k = 0; k < 8; ++k) append(buffer, Vec3(corner(k) - Vec3(1, 0.5, 0)));
  const std::string json =
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"translation":[1,0,0],"children":[1]},)"
      R"({"translation":[0,0.5,0],"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
      R"("buffers":[{)" +
      uri +
      R"("byteLength":240}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":144},{"buffer":0,"byteOffset":144,"byteLength":96}],)"
      R"("accessors":[{"bufferView":0,"componentType":5125,"count":36,"type":"SCALAR"},)"
      R"({"bufferView":1,"componentType":5126,"count":8,"type":"VEC3","min":[0,0,0],"max":[1,2,0.25]}]})";
  return {json, buffer};
}

std::string glb() {
  auto [json, buffer] = gltfParts("");
  json.resize((json.size() + 3) / 4 * 4, ' ');
  std::string bytes = "glTF";
  append(bytes, std::uint32_t{2});
  append(bytes, static_cast<std::uint32_t>(12 + 8 + json.size() + 8 + buffer.size()));
  append(bytes, static_cast<std::uint32_t>(json.size()));
  bytes += "JSON" + json;
  append(bytes, static_cast<std::uint32_t>(buffer.size()));
  bytes += std::string("BIN\0", 4) + buffer;
  return bytes;
}

Triangle triangleOf(const TriangleMesh& mesh, std::size_t t) {
  const auto& [a, b, c] = mesh.triangles[t];
  const auto at = [&](int v) { return mesh.vertices[static_cast<std::size_t>(v)]; };
  return {at(a), at(b), at(c)};
}

/// Which quadrilateral of the box a triangle belongs to, or -1.
int faceOf(const Triangle& triangle) {
  for (int f = 0; f < 6; ++f) {
    const auto isCorner = [&](const Vec3& x) { return std::any_of(quads[f], quads[f] + 4, [&](int k) { return corner(k) == x; }); };
    if (std::all_of(triangle.begin(), triangle.end(), isCorner)) return f;
  }
  return -1;
}

/// Two triangles per face in the order of the faces, each of half its area: quadrilaterals may be cut along either diagonal.
void expectBox(const fs::path& path) {
  const TriangleMesh mesh = readMesh(path);
  EXPECT_EQ(mesh.name, path.string());
  ASSERT_EQ(mesh.triangles.size(), 12u);
  for (std::size_t t = 0; t < 12; ++t) {
    const Triangle triangle = triangleOf(mesh, t);
    ASSERT_EQ(faceOf(triangle), static_cast<int>(t / 2)) << path << " triangle " << t;
    const auto& q = quads[t / 2];
    const Vec3 expected = 0.5 * (corner(q[1]) - corner(q[0])).cross(corner(q[2]) - corner(q[1]));
    EXPECT_EQ(0.5 * (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]), expected);
  }
}

void expectError(const fs::path& path, const std::string& part) {
  try {
    readMesh(path);
    FAIL() << path << " was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_NE(error.diagnostics()[0].message.find("'" + path.string() + "'"), std::string::npos) << error.what();
    EXPECT_NE(error.diagnostics()[0].message.find(part), std::string::npos) << error.what();
  }
}

TEST_F(MeshFile, StlAsText) { expectBox(write("box.stl", asciiStl(box()))); }
TEST_F(MeshFile, StlAsBinary) { expectBox(write("box.stl", binaryStl(box()))); }
TEST_F(MeshFile, StlAsBinaryWithTheHeaderOfText) {
  expectBox(write("box.stl", binaryStl(box(), "solid made by a program that does not know better")));
}
TEST_F(MeshFile, Obj) { expectBox(write("box.obj", objWithQuads())); }
TEST_F(MeshFile, Ply) { expectBox(write("box.ply", asciiPlyWithQuads())); }
TEST_F(MeshFile, PlyAsBinary) { expectBox(write("box.ply", binaryPly())); }
TEST_F(MeshFile, Glb) { expectBox(write("box.glb", glb())); }
TEST_F(MeshFile, UpperCase) { expectBox(write("BOX.STL", binaryStl(box()))); }

TEST_F(MeshFile, GltfWithABufferBesideIt) {
  const auto [json, buffer] = gltfParts(R"("uri":"box.bin",)");
  write("box.bin", buffer);
  expectBox(write("box.gltf", json));
}

TEST_F(MeshFile, NothingIsJoinedOrLeftOut) {
  std::vector<Triangle> triangles = box();
  triangles.push_back(triangles[3]);                                          // a duplicate
  triangles.push_back({corner(0), corner(0), corner(1)});                     // no area
  triangles.push_back({corner(0), corner(1), corner(1) + Vec3(0, 1e-6, 0)});  // a splinter
  for (const std::string& bytes : {asciiStl(triangles), binaryStl(triangles)}) {
    const TriangleMesh mesh = readMesh(write("bad.stl", bytes));
    ASSERT_EQ(mesh.triangles.size(), triangles.size());
    for (std::size_t t = 0; t < 14; ++t) EXPECT_EQ(triangleOf(mesh, t), triangles[t]) << t;
  }
}

TEST_F(MeshFile, PolygonsAreCutWithoutLosingArea) {
  // An L of six corners, area 3, and a loose line that is no triangle.
  const TriangleMesh mesh = readMesh(write("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\nl 1 4\n"));
  ASSERT_EQ(mesh.triangles.size(), 4u);
  double area = 0;
  for (std::size_t t = 0; t < 4; ++t) {
    const Triangle x = triangleOf(mesh, t);
    area += 0.5 * (x[1] - x[0]).cross(x[2] - x[0]).z();
  }
  EXPECT_NEAR(area, 3, 1e-12);
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
};

// That of streams, which needs no installed locale; and that of the C library where there is one with decimal commas.
TEST_F(MeshFile, TheLocaleDoesNotMatter) {
  const fs::path path = write("box.stl", asciiStl(box()));
  const std::string before = std::setlocale(LC_ALL, nullptr);
  const std::locale streams = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  std::setlocale(LC_ALL, "de_DE.UTF-8");
  std::ostringstream number;
  number << 1.5;
  EXPECT_EQ(number.str(), "1,5");
  expectBox(path);
  std::locale::global(streams);
  std::setlocale(LC_ALL, before.c_str());
}

TEST_F(MeshFile, SeveralThreadsMayReadAtOnce) {
  const fs::path stl = write("box.stl", asciiStl(box())), ply = write("box.ply", asciiPlyWithQuads());
  std::vector<std::size_t> counts(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < counts.size(); ++i)
    threads.emplace_back([&, i] { counts[i] = readMesh(i % 2 ? stl : ply).triangles.size(); });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(counts, std::vector<std::size_t>(8, 12));
}

TEST_F(MeshFile, SaysWhatIsWrongWithAFile) {
  expectError(directory_ / "missing.stl", "cannot be opened: No such file or directory");
  expectError(write("box.txt", asciiStl(box())), "unknown format");
  fs::create_directories(directory_ / "folder.stl");
  expectError(directory_ / "folder.stl", "is a directory");
  expectError(write("empty.stl", ""), "cannot be read. Its reader says: ");
  expectError(write("none.stl", "solid nothing\nendsolid nothing\n"), "holds no triangles");
  expectError(write("noise.ply", "this is not a mesh"), "cannot be read. Its reader says: ");
  expectError(write("noise.glb", "this is not a mesh"), "cannot be read. Its reader says: ");
  expectError(write("points.obj", "v 0 0 0\nv 1 0 0\nl 1 2\n"), "holds no triangles");
  expectError(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"), "vertex index out of range");
  std::string cut = binaryStl(box());
  cut.resize(cut.size() - 70);
  expectError(write("cut.stl", cut), "cannot be read. Its reader says: ");
}

TEST_F(MeshFile, AFileThatBreaksOffIsRefused) {
  const std::pair<const char*, std::string> files[] = {{"cut_text.stl", asciiStl(box())},
                                                       {"cut.stl", binaryStl(box())},
                                                       {"cut.ply", asciiPlyWithQuads()},
                                                       {"cut_binary.ply", binaryPly()},
                                                       {"cut.glb", glb()}};
  for (const auto& [name, whole] : files) {
    ASSERT_NO_THROW(readMesh(write(name, whole))) << name;
    for (std::size_t size = 1; size + 12 < whole.size(); size += 37)
      EXPECT_THROW(readMesh(write(name, whole.substr(0, size))), Error) << name << " " << size;
  }
}

TEST_F(MeshFile, NamesTheTriangleWithAVertexThatIsNoNumber) {
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    std::vector<Triangle> triangles = box();
    triangles[7][1].y() = bad;
    expectError(write("bad.stl", binaryStl(triangles)), "not a finite number, in triangle 7.");
    expectError(write("bad.stl", asciiStl(triangles)), "not a finite number, in triangle 7.");
  }
}

}  // namespace
}  // namespace tsubu::io
