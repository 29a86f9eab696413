// Every odd LAS and LAZ file of the project's test data, against a plain LASzip loop. The data does not come
// with the source; where it is absent the tests are skipped.
#include "las_fixture.h"
#include "support/random_cloud.h"
#include "support/scratch.h"
#include "support/shared_data.h"

#include <raycloud/core/error.h>

#include <gtest/gtest.h>

#include <algorithm>

namespace {

using namespace ray;
using namespace ray::test;
using namespace ray::test::las;

void expect_same(const PlainPoints& plain, const RayCloud& rays) {
  ASSERT_EQ(plain.ends.size(), rays.size());
  const int format = plain.header.point_data_format;
  const auto intensity = rays.extra("intensity")->values<std::uint16_t>();
  const auto classification = rays.extra("classification")->values<std::uint8_t>();
  const auto returns = rays.extra("return_number")->values<std::uint8_t>();
  bool wide = false;
  for (const auto& point : plain.points)
    wide = wide || std::max({point.rgb[0], point.rgb[1], point.rgb[2]}) > 255;
  for (std::size_t i = 0; i < rays.size(); ++i) {
    const auto& point = plain.points[i];
    ASSERT_EQ(plain.ends[i], rays.ends[i]) << i;
    ASSERT_EQ(point.intensity, intensity[i]) << i;
    ASSERT_EQ(format < 6 ? point.classification : point.extended_classification, classification[i]) << i;
    ASSERT_EQ(format < 6 ? point.return_number : point.extended_return_number, returns[i]) << i;
    if (has_time(format)) {
      ASSERT_EQ(point.gps_time, rays.times[i]) << i;
    }
    if (has_colour(format)) {
      ASSERT_EQ(static_cast<std::uint8_t>(wide ? point.rgb[1] >> 8 : point.rgb[1]), rays.colours[i].green)
          << i;
    }
  }
}

TEST(LasCorpus, SamePointsAsAPlainLoopOrAnError) {
  const auto files = shared_files("corpus_las");
  if (files.empty()) GTEST_SKIP() << kNoSharedFiles;
  std::size_t read = 0;
  for (const auto& path : files) {
    SCOPED_TRACE(path.filename().string());
    const PlainPoints plain = plain_loop(path);
    RayCloud rays;
    try {
      rays = read_points(path, 1);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::file_format);
      EXPECT_FALSE(plain.whole) << error.what();
      continue;
    }
    ++read;
    if (plain.whole) expect_same(plain, rays);
    EXPECT_TRUE(same_bits(rays, read_points(path, 3, 100)));
  }
  EXPECT_GE(read, 100u);
}

TEST(LasCorpus, WrittenAndReadBackNothingIsLost) {
  const auto files = shared_files("corpus_las");
  if (files.empty()) GTEST_SKIP() << kNoSharedFiles;
  const Scratch scratch;
  for (const auto& path : files) {
    SCOPED_TRACE(path.filename().string());
    RayCloud rays;
    CloudInfo info;
    try {
      const auto source = open_las_points(path);
      info = source->info();
      rays = read_all({}, *source);
    } catch (const Error&) {
      continue;
    }
    const auto out = scratch.path("out.laz");
    const auto sink = create_las_points(out, info);
    RawChunk raw;
    sink->encode(rays, raw);
    sink->write(raw);
    sink->finish();
    const auto back = open_las_points(out);
    EXPECT_EQ(back->info().crs, info.crs);
    EXPECT_EQ(back->info().time_base, info.time_base);
    EXPECT_EQ(back->info().extras, info.extras);
    const RayCloud again = read_all({}, *back);
    ASSERT_EQ(again.size(), rays.size());
    EXPECT_EQ(again.times, rays.times);
    EXPECT_EQ(again.colours, rays.colours);
    EXPECT_EQ(again.extras, rays.extras);
    // The source's grid is kept, but one step for all axes is all that is known of it.
    const auto header = plain_loop(path).header;
    const auto [finest, coarsest] =
        std::minmax({header.x_scale_factor, header.y_scale_factor, header.z_scale_factor});
    const double tolerance = std::max(1e-9, finest == coarsest ? 0.001 * finest : 0.501 * coarsest);
    for (std::size_t i = 0; i < rays.size(); ++i)
      ASSERT_LE((again.ends[i] - rays.ends[i]).cwiseAbs().maxCoeff(), tolerance) << "point " << i;
  }
}

}  // namespace
