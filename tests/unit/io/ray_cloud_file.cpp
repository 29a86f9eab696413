#include "ply_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"

#include <raycloud/io/point_file.h>
#include <raycloud/io/ray_cloud_file.h>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ray {
namespace {

using namespace test;
using ::testing::EndsWith;

TEST(RayCloudFile, TheExtensionDecidesInEitherCase) {
  const Scratch scratch;
  const RayCloud cloud = random_cloud(3, {.float_coordinates = true});
  for (const char* name : {"a.ply", "b.PLY", "c.las", "d.Laz"}) {
    write_all(*create_ray_cloud(scratch.path(name), {}), cloud);
    EXPECT_EQ(read_rest(*open_ray_cloud(scratch.path(name))).rays.times, cloud.times) << name;
    EXPECT_EQ(read_file(scratch.path(name)).substr(0, 3), name[2] == 'p' || name[2] == 'P' ? "ply" : "LAS")
        << name;
  }
}

TEST(RayCloudFile, WhereTheNameTellsNothingTheContentDoes) {
  const Scratch scratch;
  const RayCloud cloud = random_cloud(3, {.float_coordinates = true});
  for (const char* format : {".ply", ".las", ".laz"}) {
    for (const char* name : {".merge_file_a1B2c3", "map.4", "map"}) {
      const auto path = scratch.path(name);
      write_all(*create_ray_cloud(path, {}, {.format = format}), cloud);
      EXPECT_EQ(cloud_format(path), format) << name;
      EXPECT_EQ(read_rest(*open_ray_cloud(path)).rays.times, cloud.times) << format << name;
    }
    // A name that tells is believed.
    const std::string other = format == std::string(".las") ? ".laz" : ".las";
    const auto path = scratch.path("named" + other);
    write_all(*create_ray_cloud(path, {}, {.format = format}), cloud);
    std::filesystem::rename(path, scratch.path("renamed"));
    EXPECT_EQ(cloud_format(scratch.path("renamed")), other);
  }
  for (const char* content : {"", "p", "plyers", "LASF", "x,y,z"}) {
    write_file(scratch.path("text"), content);
    EXPECT_EQ(cloud_format(scratch.path("text")), "") << content;
  }
}

TEST(PointFile, TheExtensionDecidesInEitherCase) {
  const Scratch scratch;
  const RayCloud cloud = random_cloud(3, {.float_coordinates = true});
  for (const char* name : {"a.ply", "b.LAS", "c.laz", "d.xyz", "e.txt", "f.CSV"}) {
    write_all(*create_points(scratch.path(name), {}), cloud);
    EXPECT_EQ(read_rest(*open_points(scratch.path(name))).rays.times, cloud.times) << name;
  }
}

TEST(RayCloudFile, UnknownExtensionsAreAnsweredWithTheKnown) {
  const Scratch scratch;
  const auto message = [](const auto& action, ErrorCode code = ErrorCode::usage) {
    const auto error = error_of(action);
    EXPECT_TRUE(error && error->code() == code);
    return error ? std::string(error->what()) : std::string();
  };
  EXPECT_EQ(message([] { static_cast<void>(open_ray_cloud("a.pcd")); }, ErrorCode::wrong_content),
            "a.pcd: not a ray cloud (.ply, .las or .laz): make one with rayimport");
  EXPECT_EQ(message([&] { static_cast<void>(create_ray_cloud(scratch.path("a"), {})); }),
            scratch.path("a").string() + ": a file name needs an extension; known are .ply .las .laz");
  EXPECT_THAT(message([] { static_cast<void>(open_points("a.doc")); }),
              EndsWith(".ply .las .laz .xyz .txt .csv .asc .pts"));
  EXPECT_THAT(message([] { static_cast<void>(create_points("a.pts", {})); }),
              EndsWith(".ply .las .laz .xyz .txt .csv"));
  EXPECT_EQ(files_in(scratch.folder()), 0u);
}

}  // namespace
}  // namespace ray
