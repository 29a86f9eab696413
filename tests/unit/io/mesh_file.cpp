// Meshes: every spelling of PLY gives the same triangles, files read back to the same bits, and what is no
// mesh is refused in one line.
#include "ply_fixture.h"
#include "support/scratch.h"

#include <raycloud/io/mesh_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <limits>

namespace ray {
namespace {

using namespace test;
using ::testing::HasSubstr;
using ::testing::StartsWith;

FixtureElement vertices(const std::string& type, std::size_t count) {
  FixtureElement element{"vertex", {{type, "x", ""}, {type, "y", ""}, {type, "z", ""}}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double t = static_cast<double>(i);
    element.rows.push_back({{t}, {t * t}, {3.0 - t}});
  }
  return element;
}

FixtureFile pentagon_and_triangle(Encoding encoding) {
  FixtureFile file;
  file.encoding = encoding;
  FixtureElement faces{"face", {{"int", "vertex_indices", "uchar"}, {"short", "object_id", ""}}, {}};
  faces.rows = {{{0, 1, 2, 3, 4}, {-7}}, {{4, 2, 5}, {12}}};
  file.elements = {vertices("float", 6), faces};
  return file;
}

Mesh read_fixture(const FixtureFile& file) {
  Scratch scratch;
  write_file(scratch.path("a.ply"), bytes_of(file));
  return read_mesh(scratch.path("a.ply"));
}

const std::vector<Mesh::Face> kFan{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {4, 2, 5}};

TEST(MeshFile, PolygonsBecomeFansAndFaceNumbersGoAlong) {
  for (const Encoding encoding : {Encoding::ascii, Encoding::little, Encoding::big}) {
    const Mesh mesh = read_fixture(pentagon_and_triangle(encoding));
    EXPECT_EQ(mesh.faces, kFan);
    ASSERT_EQ(mesh.vertices.size(), 6u);
    EXPECT_EQ(mesh.vertices[4], Eigen::Vector3d(4, 16, -1));
    ASSERT_EQ(mesh.face_columns.size(), 1u);
    EXPECT_EQ(mesh.face_columns[0].name(), "object_id");
    const auto ids = mesh.face_columns[0].values<std::int16_t>();
    EXPECT_EQ(std::vector<std::int16_t>(ids.begin(), ids.end()), (std::vector<std::int16_t>{-7, -7, -7, 12}));
  }
}

TEST(MeshFile, WhatIsNotOfAMeshIsPassedOver) {
  for (const Encoding encoding : {Encoding::ascii, Encoding::little, Encoding::big}) {
    FixtureFile file;
    file.encoding = encoding;
    file.line_end = "\r\n";
    file.notes = {"comment origin 100 200 300"};
    FixtureElement camera{"camera", {{"double", "view", ""}, {"short", "many", "ushort"}}, {}};
    camera.rows = {{{1.5}, {1, 2, 3}}, {{2.5}, {}}};
    FixtureElement points{"vertex",
                          {{"uchar", "red", ""},
                           {"double", "z", ""},
                           {"int", "seen_by", "uchar"},
                           {"double", "y", ""},
                           {"double", "x", ""}},
                          {}};
    points.rows = {{{9}, {1}, {5, 6}, {2}, {3}}, {{9}, {4}, {}, {5}, {6}}, {{9}, {7}, {5}, {8}, {9}}};
    FixtureElement faces{"face", {{"float", "texcoord", "uchar"}, {"uint", "vertex_index", "int"}}, {}};
    faces.rows = {{{0.5, 0.25}, {2, 1, 0}}};
    FixtureElement edges{"edge", {{"int", "a", ""}}, {}};
    edges.rows = {{{0}}, {{1}}};
    file.elements = {camera, faces, points, edges};  // faces may come before their vertices
    const Mesh mesh = read_fixture(file);
    EXPECT_EQ(mesh.faces, (std::vector<Mesh::Face>{{2, 1, 0}}));
    EXPECT_EQ(mesh.vertices[1], Eigen::Vector3d(106, 205, 304));
    EXPECT_TRUE(mesh.face_columns.empty());
  }
}

TEST(MeshFile, Obj) {
  Scratch scratch;
  const auto path = scratch.path("a.OBJ");
  write_file(
      path,
      "# a comment\nmtllib x.mtl\no thing\nv 0 0 0\nv 1 0 0 0.5 0.5 0.5\nvn 0 0 1\nv 1 1 0\r\nv 0 1e0 0\n"
      "f 1/2/3 2//1 3/4 4\nf -1 -2 -3");
  const Mesh mesh = read_mesh(path);
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.faces, (std::vector<Mesh::Face>{{0, 1, 2}, {0, 2, 3}, {3, 2, 1}}));
}

bool same_columns(const Mesh& a, const Mesh& b) {
  return a.face_columns == b.face_columns;
}

RC_GTEST_PROP(MeshFile, ReadsBackEveryBit, ()) {
  Mesh mesh;
  const bool single = *rc::gen::arbitrary<bool>();
  const auto count = *rc::gen::inRange<std::size_t>(3, 40);
  for (std::size_t i = 0; i < count; ++i) {
    Eigen::Vector3d vertex;
    for (double& x : vertex) {
      x = *rc::gen::inRange(-1000000, 1000000) * (single ? 0.25 : 0.1);
    }
    mesh.vertices.push_back(vertex);
  }
  const auto index = rc::gen::inRange<std::uint32_t>(0, static_cast<std::uint32_t>(count));
  const auto faces = *rc::gen::inRange<std::size_t>(1, 40);
  Column ids({"object_id", ScalarType::int32}, faces);
  Column areas({"area", ScalarType::float64}, faces);
  for (std::size_t f = 0; f < faces; ++f) {
    mesh.faces.push_back({*index, *index, *index});
    ids.values<std::int32_t>()[f] = *rc::gen::arbitrary<std::int32_t>();
    areas.values<double>()[f] = *rc::gen::arbitrary<double>();
  }
  mesh.face_columns = {ids, areas};
  Scratch scratch;
  for (const char* name : {"a.ply", "a.obj"}) {
    write_mesh(scratch.path(name), mesh);
    const Mesh back = read_mesh(scratch.path(name));
    RC_ASSERT(back.vertices == mesh.vertices);
    RC_ASSERT(back.faces == mesh.faces);
    if (std::string(name) == "a.ply") RC_ASSERT(same_columns(back, mesh));
  }
  // Whole quarters below 2^20 are exactly floats.
  if (single) RC_ASSERT(read_file(scratch.path("a.ply")).find("property float x") != std::string::npos);
}

class MeshBadInput : public ::testing::Test {
 protected:
  std::string message(const std::string& bytes, ErrorCode code = ErrorCode::file_format,
                      const std::string& name = "bad.ply") {
    const auto path = scratch_.path(name);
    write_file(path, bytes);
    const auto error = error_of([&] { (void)read_mesh(path); });
    if (!error) return "no error";
    const std::string what = error->what();
    EXPECT_EQ(error->code(), code) << what;
    EXPECT_THAT(what, StartsWith(path.string() + ": "));
    EXPECT_EQ(what.find('\n'), what.npos);
    return what.substr(path.string().size() + 2);
  }
  Scratch scratch_;
};

TEST_F(MeshBadInput, Ply) {
  EXPECT_EQ(message(""), "empty file");
  FixtureFile file = pentagon_and_triangle(Encoding::little);
  const std::string whole = bytes_of(file);
  EXPECT_THAT(message(whole.substr(0, whole.size() - 1)), StartsWith("truncated at face 2 of 2 (byte "));
  EXPECT_THAT(message(whole + "x"), StartsWith("holds more than its header says"));

  file.elements[1].rows[1][0] = {4, 6, 5};
  EXPECT_EQ(message(bytes_of(file)), "face 2 of 2: no vertex has the index 6 (there are 6)");
  file.elements[1].rows[1][0] = {4, -1, 5};
  EXPECT_EQ(message(bytes_of(file)), "face 2 of 2: no vertex has the index -1 (there are 6)");
  file.elements[1].rows[1][0] = {4, 3};
  EXPECT_EQ(message(bytes_of(file)), "face 2 of 2: has 2 corners");
  file = pentagon_and_triangle(Encoding::big);
  file.elements[0].rows[3][1] = {std::numeric_limits<double>::quiet_NaN()};
  EXPECT_EQ(message(bytes_of(file)), "vertex 4 of 6: a coordinate that is not a finite number");
  file = pentagon_and_triangle(Encoding::ascii);
  file.elements[1].rows.clear();
  EXPECT_EQ(message(bytes_of(file), ErrorCode::wrong_content), "has no faces, so it is not a mesh");
  file.elements.pop_back();
  EXPECT_EQ(message(bytes_of(file), ErrorCode::wrong_content), "has no faces, so it is not a mesh");
  file = pentagon_and_triangle(Encoding::ascii);
  file.elements[0].properties[1].name = "height";
  EXPECT_EQ(message(bytes_of(file), ErrorCode::wrong_content), "its vertices have no x, y and z");
}

TEST_F(MeshBadInput, EveryCutOfAFileIsRefused) {
  for (const Encoding encoding : {Encoding::ascii, Encoding::little, Encoding::big}) {
    FixtureFile file = pentagon_and_triangle(encoding);
    file.blank = " ";
    const std::string whole = bytes_of(file);
    // The last value of a text may lose a digit unnoticed: begin before it.
    for (std::size_t size = whole.size() - 4; size > 0; --size)
      ASSERT_NE(message(whole.substr(0, size)), "no error") << size;
  }
}

TEST_F(MeshBadInput, AbsurdCountsDoNotTakeMemory) {
  const std::string head =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4000000000\nproperty float x\n"
      "property float y\nproperty float z\nelement face 9000000000000\n"
      "property list uint int vertex_indices\nend_header\n";
  EXPECT_THAT(message(head), StartsWith("truncated at vertex 1 of 4000000000"));
}

TEST_F(MeshBadInput, Obj) {
  const auto obj = [&](const std::string& bytes, ErrorCode code = ErrorCode::file_format) {
    return message(bytes, code, "bad.obj");
  };
  EXPECT_EQ(obj(""), "empty file");
  EXPECT_EQ(obj("v 0 0 0\n", ErrorCode::wrong_content), "has no faces, so it is not a mesh");
  EXPECT_EQ(obj("v 0 0 0\nf 1 1 2\n"), "a face has vertex 2 of 1");
  EXPECT_EQ(obj("v 0 0\n"), "line 1 lacks a number");
  EXPECT_EQ(obj("v 0 nan 0\n"), "line 1 has a coordinate that is not a finite number");
  EXPECT_EQ(obj("v 0 0 0\nf 1 0 1\n"), "line 2 has '0' where the number of a vertex should be");
  EXPECT_EQ(obj("v 0 0 0\nf 1 -2 1\n"), "line 2 has '-2' where the number of a vertex should be");
  EXPECT_EQ(obj("v 0 0 0\nf 1 1\n"), "line 2 has a face of 2 corners");
}

TEST_F(MeshBadInput, NamesAndTypes) {
  EXPECT_EQ(message("x", ErrorCode::usage, "mesh.stl"), "a mesh is a .ply or .obj file");
  EXPECT_EQ(error_of([&] { (void)read_mesh(scratch_.path("none.ply")); })->code(), ErrorCode::file_not_found);
  Mesh mesh;
  mesh.face_columns = {Column({"big", ScalarType::int64})};
  const auto error = error_of([&] { write_mesh(scratch_.path("out.ply"), mesh); });
  EXPECT_THAT(error->what(), HasSubstr("PLY has no 64-bit integers for the face column 'big'"));
  EXPECT_FALSE(std::filesystem::exists(scratch_.path("out.ply")));
}

}  // namespace
}  // namespace ray
