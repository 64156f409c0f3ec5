// Every kind of fault, what is done about it and what is said.

#include <gtest/gtest.h>

#include <limits>

#include "core/error.h"
#include "shapes.h"

namespace tsubu::sim::test {
namespace {

const MeshFault* find(const Surface& surface, MeshFaultKind kind) {
  for (const MeshFault& fault : surface.faults())
    if (fault.kind == kind) return &fault;
  return nullptr;
}

void expectFault(const TriangleMesh& mesh, MeshFaultKind kind, MeshRemedy remedy, const std::vector<int>& triangles,
                 const std::string& sentence) {
  const Surface surface(mesh);
  const MeshFault* fault = find(surface, kind);
  ASSERT_NE(fault, nullptr);
  EXPECT_EQ(fault->remedy, remedy);
  EXPECT_EQ(fault->triangles, triangles);
  EXPECT_EQ(fault->sentence, sentence);
}

void expectRefused(const TriangleMesh& mesh, const std::string& sentence) {
  try {
    const Surface surface(mesh);
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::files);
    ASSERT_EQ(error.diagnostics().size(), 1u);
    EXPECT_EQ(error.diagnostics()[0].message, sentence);
  }
}

TriangleMesh square() {
  TriangleMesh mesh;
  mesh.name = "square.stl";
  addQuad(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0});
  return mesh;
}

TEST(Fault, ASoundMeshHasNone) { EXPECT_TRUE(Surface(square()).faults().empty()); }

TEST(Fault, Degenerate) {
  TriangleMesh mesh = square();
  addTriangle(mesh, {0, 0, 0}, {0.5, 0.5, 0}, {1, 1, 0});  // collinear
  addTriangle(mesh, {0, 0, 0}, {0, 0, 0}, {1, 1, 0});      // two corners at one place
  expectFault(mesh, MeshFaultKind::degenerate, MeshRemedy::repaired, {2, 3},
              "The mesh 'square.stl': without area, left out: triangles 2 and 3.");
  EXPECT_EQ(Surface(mesh).faceCount(), 1u);
}

TEST(Fault, Duplicate) {
  TriangleMesh mesh = square();
  addTriangle(mesh, {1, 1, 0}, {1, 0, 0}, {0, 0, 0});
  expectFault(mesh, MeshFaultKind::duplicate, MeshRemedy::repaired, {2},
              "The mesh 'square.stl': repeated from an earlier triangle, left out: triangle 2.");
}

TEST(Fault, TJoint) {
  TriangleMesh mesh;
  mesh.name = "t.stl";
  addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  addTriangle(mesh, {0, 0, 0}, {0, -1, 0}, {0.5, 0, 0});
  addTriangle(mesh, {0.5, 0, 0}, {0, -1, 0}, {1, 0, 0});
  expectFault(mesh, MeshFaultKind::tJoint, MeshRemedy::repaired, {0},
              "The mesh 't.stl': a vertex of another triangle lies inside an edge, which was split: triangle 0.");
  const Surface surface(mesh);
  EXPECT_EQ(surface.faceCount(), 1u);
  EXPECT_EQ(surface.mesh().triangles.size(), 4u);
}

TEST(Fault, Sliver) {
  TriangleMesh mesh = square();
  addTriangle(mesh, {0, 0, 0}, {0.5, -2e-5, 0}, {1, 0, 0});
  expectFault(mesh, MeshFaultKind::sliver, MeshRemedy::harmless, {2},
              "The mesh 'square.stl': more than ten thousand times longer than wide, kept: triangle 2.");
}

TEST(Fault, NonManifold) {
  TriangleMesh mesh = square();
  addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5, 0, 1});
  addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5, 0, -1});
  expectFault(mesh, MeshFaultKind::nonManifold, MeshRemedy::harmless, {0, 2, 3},
              "The mesh 'square.stl': three or more triangles meet in one edge, kept: triangles 0, 2 and 3.");
}

TEST(Fault, InconsistentWinding) {
  TriangleMesh mesh = square();
  std::swap(mesh.triangles[1][0], mesh.triangles[1][1]);
  expectFault(mesh, MeshFaultKind::inconsistentWinding, MeshRemedy::harmless, {1},
              "The mesh 'square.stl': turned the other way than a neighbour, which two-sided walls do not mind: triangle 1.");
  EXPECT_EQ(Surface(mesh).faceCount(), 1u);
}

TEST(Fault, Overlap) {
  TriangleMesh mesh = square();
  addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {0.5, 0.3, 0});
  expectFault(mesh, MeshFaultKind::overlap, MeshRemedy::harmless, {2},
              "The mesh 'square.stl': covering the same area of one plane, counted once: triangle 2.");
  const Surface surface(mesh);
  Probe probe(surface);
  Random random(8, 8);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 centre = randomIn(random, {0, 0, 0.02}, {1, 1, 0.1});
    EXPECT_EQ(probe.contacts(centre, 0.1).size(), 1) << centre.transpose();
  }
}

TEST(Fault, ManyTrianglesAreNotAllNamed) {
  TriangleMesh mesh = square();
  for (int i = 0; i < 20; ++i) addTriangle(mesh, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
  const Surface surface(mesh);
  ASSERT_EQ(surface.faults().size(), 1u);
  EXPECT_EQ(surface.faults()[0].triangles.size(), 20u);
  EXPECT_EQ(surface.faults()[0].sentence,
            "The mesh 'square.stl': repeated from an earlier triangle, left out: 20 triangles, first 2, 3, 4, 5, 6, 7, 8, 9 ….");
}

TEST(Fault, VerticesMustExist) {
  TriangleMesh mesh = square();
  mesh.triangles[1][2] = 99;
  expectRefused(mesh, "The mesh 'square.stl': a vertex that does not exist is named by triangle 1.");
  mesh.triangles[1][2] = -1;
  expectRefused(mesh, "The mesh 'square.stl': a vertex that does not exist is named by triangle 1.");
}

TEST(Fault, VerticesMustBeFinite) {
  TriangleMesh mesh = square();
  mesh.vertices[0].x() = std::numeric_limits<double>::quiet_NaN();
  mesh.vertices[4].x() = std::numeric_limits<double>::infinity();
  expectRefused(mesh, "The mesh 'square.stl': a vertex is not a finite number in triangles 0 and 1.");
}

TEST(Fault, SomethingMustBeLeft) {
  TriangleMesh mesh;
  mesh.name = "empty.stl";
  expectRefused(mesh, "The mesh 'empty.stl': no triangle has an area.");
  addTriangle(mesh, {1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  addTriangle(mesh, {1, 1, 1}, {2, 2, 2}, {3, 3, 3});
  expectRefused(mesh, "The mesh 'empty.stl': no triangle has an area.");
}

TEST(Fault, VerticesThatDifferByRoundingAreWelded) {
  TriangleMesh mesh = makeBox(Vec3::Zero(), Vec3::Ones());
  Random random(2, 2);
  for (Vec3& x : mesh.vertices) x += 2e-8 * randomDirection(random);
  const Surface surface(mesh);
  EXPECT_EQ(surface.faceCount(), 6u);
  EXPECT_EQ(surface.edgeCount(), 12u);
  EXPECT_EQ(surface.cornerCount(), 8u);
}

}  // namespace
}  // namespace tsubu::sim::test
