#include "support/random_cloud.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/filter/import_rays.h>

#include <gtest/gtest.h>

namespace ray {
namespace {

/// Lets the test look at what a sink got after the import has destroyed it.
class Forward final : public RaySink {
 public:
  Forward(MemorySink& to) : to_(to) {}
  void encode(const RayCloud& rays, RawChunk& raw) const override { to_.encode(rays, raw); }
  void write(const RawChunk& raw) override { to_.write(raw); }
  void finish() override { to_.finish(); }

 private:
  MemorySink& to_;
};

RayCloud imported(const RayCloud& points, const std::vector<std::string>& formal) {
  CloudInfo info;
  info.formal_extras = formal;
  MemorySource source(points, info, 10);
  std::unique_ptr<MemorySink> kept;
  ImportOptions options;
  options.origin = FixedSensor{{0.0, 0.0, 1.0}};
  (void)import_rays({}, source, options, [&](const CloudInfo& out) {
    kept = std::make_unique<MemorySink>(out.extras);
    return std::make_unique<Forward>(*kept);
  });
  return kept->cloud();
}

RayCloud points_with_zeros() {
  RayCloud points = test::random_cloud(
      1, {.rays = 1000,
          .extras = {{"zero", ScalarType::uint8}, {"id", ScalarType::int32}, {"late", ScalarType::float32}}});
  for (std::size_t i = 0; i < points.size(); ++i) {
    points.extras[0].values<std::uint8_t>()[i] = 0;
    points.extras[2].values<float>()[i] = 0.0F;
  }
  return points;
}

TEST(FormalExtras, AreLeftOutIfZeroThroughoutAndOnlyThen) {
  const RayCloud points = points_with_zeros();
  const RayCloud cloud = imported(points, {"zero", "id"});
  ASSERT_EQ(cloud.extras.size(), 2U);
  EXPECT_EQ(cloud.extras[0], points.extras[1]);
  EXPECT_EQ(cloud.extras[1], points.extras[2]) << "zeros that the user chose to record stay";
}

TEST(FormalExtras, OneValueTheSampleMissedBringsThemBack) {
  RayCloud points = points_with_zeros();
  points.extras[2].values<float>()[555] = 1.0F;
  const RayCloud cloud = imported(points, {"zero", "late"});
  ASSERT_NE(cloud.extra("late"), nullptr);
  EXPECT_EQ(*cloud.extra("late"), points.extras[2]);
}

}  // namespace
}  // namespace ray
