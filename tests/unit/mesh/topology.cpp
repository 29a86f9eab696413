#include "shapes.h"

#include <raycloud/core/error.h>
#include <raycloud/mesh/topology.h>
#include <raycloud/mesh/weld.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

using namespace test;

TEST(Topology, ABoxIsASphereAndSoIsItsSubdivision) {
  for (const int levels : {0, 1, 3}) {
    const Mesh mesh = sphere_shape(levels, [](const auto&) { return 2.0; });
    const MeshTopology topology = topology_of(mesh);
    EXPECT_TRUE(topology.is_sphere()) << levels;
    EXPECT_FALSE(topology.is_disc());
    EXPECT_EQ(2 * topology.edges, 3 * topology.faces);
  }
}

TEST(Topology, AGroundIsADisc) {
  const MeshTopology topology = topology_of(ground_shape(7, [](int x, int y) { return x * y; }));
  EXPECT_TRUE(topology.is_disc());
  EXPECT_EQ(topology.border_edges, 24u);
  EXPECT_FALSE(topology.is_closed());
}

TEST(Topology, AHoleMakesASecondBorder) {
  Mesh mesh = ground_shape(7, [](int, int) { return 0; });
  mesh.faces.erase(mesh.faces.begin() + 30);
  const MeshTopology topology = topology_of(mesh);
  EXPECT_TRUE(topology.is_surface());
  EXPECT_EQ(topology.border_loops, 2u);
  EXPECT_EQ(topology.euler_characteristic(), 0);
  EXPECT_FALSE(topology.is_disc());
}

TEST(Topology, ATorusIsClosedButNoSphere) {
  const MeshTopology topology = topology_of(torus_shape(12, 7));
  EXPECT_TRUE(topology.is_closed());
  EXPECT_EQ(topology.euler_characteristic(), 0);
  EXPECT_FALSE(topology.is_sphere());
}

TEST(Topology, AMoebiusBandHasOneBorderAndNoFront) {
  const MeshTopology band = topology_of(band_shape(10, 0));
  EXPECT_TRUE(band.is_surface());
  EXPECT_EQ(band.border_loops, 2u);
  const MeshTopology moebius = topology_of(band_shape(10, 1));
  EXPECT_EQ(moebius.border_loops, 1u);
  EXPECT_EQ(moebius.reversed_edges, 1u);
  EXPECT_FALSE(moebius.is_surface());
}

TEST(Topology, ThreeFacesAtAnEdgeAreTangled) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, -1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 1, 3}, {1, 0, 4}};
  EXPECT_EQ(topology_of(mesh).tangled_edges, 1u);
}

TEST(Topology, TwoFansAtAVertexPinchIt) {
  Mesh mesh;
  mesh.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}};
  mesh.faces = {{0, 1, 2}, {0, 3, 4}};
  const MeshTopology topology = topology_of(mesh);
  EXPECT_EQ(topology.pinched_vertices, 1u);
  EXPECT_EQ(topology.components, 2u);
  EXPECT_FALSE(topology.is_surface());
}

TEST(Topology, NothingIsNeitherSphereNorDisc) {
  const MeshTopology topology = topology_of({});
  EXPECT_FALSE(topology.is_sphere());
  EXPECT_FALSE(topology.is_disc());
  EXPECT_EQ(topology.components, 0u);
}

TEST(Weld, MakesASurfaceOfSingleFaces) {
  const Mesh sphere = sphere_shape(2, [](const auto&) { return 2.0; });
  EXPECT_EQ(topology_of(unwelded(sphere)).components, sphere.faces.size());
  const WeldedMesh welded = weld(unwelded(sphere));
  EXPECT_TRUE(topology_of(welded.mesh).is_sphere());
  EXPECT_EQ(welded.mesh.vertices.size(), sphere.vertices.size());
  EXPECT_EQ(welded.without_area, 0u);
}

TEST(Weld, LeavesOutFacesWithoutAnAreaAndUnusedVertices) {
  Mesh mesh;
  mesh.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {2, 0, 0}, {0, 0, 0}};
  mesh.faces = {{1, 2, 3}, {1, 2, 4}, {1, 5, 3}, {2, 2, 3}};
  const WeldedMesh welded = weld(mesh);
  EXPECT_EQ(welded.without_area, 3u);
  EXPECT_EQ(welded.mesh.faces.size(), 1u);
  EXPECT_EQ(welded.mesh.vertices.size(), 3u);
  mesh.faces.erase(mesh.faces.begin());
  EXPECT_THROW((void)weld(mesh), Error);
}

}  // namespace
}  // namespace ray
