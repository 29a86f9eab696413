#include <raycloud/core/error.h>
#include <raycloud/filter/intensity.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <cmath>

namespace ray {
namespace {

using Rule = IntensityScale::Rule;

template <class T>
RayCloud with_intensity(const std::vector<T>& values) {
  RayCloud rays;
  rays.set_schema({{"intensity", scalar_type_of<T>()}});
  rays.resize(values.size());
  std::copy(values.begin(), values.end(), rays.extras[0].values<T>().begin());
  return rays;
}

template <class T>
IntensityScale scale_for(const std::vector<T>& values, std::optional<double> maximum = {}) {
  const RayCloud rays = with_intensity(values);
  return intensity_scale({.extras = schema_of(rays), .present = {.intensity = false}},
                         intensity_range(rays, "intensity"), maximum);
}

TEST(intensity, a_source_that_has_8_bits_already_keeps_them_unless_asked) {
  const CloudInfo both{.extras = {{"intensity", ScalarType::uint16}}, .present = {.intensity = true}};
  EXPECT_EQ(intensity_scale(both, {0.0, 900.0}, {}).rule, Rule::keep);
  EXPECT_EQ(intensity_scale(both, {0.0, 900.0}, 1000.0).rule, Rule::scaled);
  EXPECT_EQ(intensity_scale(both, {0.0, 900.0}, 0.0).rule, Rule::all_bounded);
}

TEST(intensity, the_maximum_follows_type_and_range) {
  EXPECT_EQ(scale_for<std::uint8_t>({3}).maximum, 255.0);
  EXPECT_EQ(scale_for<std::uint16_t>({0, 255}).maximum, 255.0);
  EXPECT_EQ(scale_for<std::uint16_t>({256}).maximum, 4095.0);
  EXPECT_EQ(scale_for<std::uint16_t>({4096}).maximum, 65535.0);
  EXPECT_EQ(scale_for<float>({0.25f, 1.0f}).maximum, 1.0);
  EXPECT_EQ(scale_for<double>({1.5}).maximum, 255.0);
  EXPECT_EQ(scale_for<double>({1e6}).maximum, 1e6);
  EXPECT_EQ(scale_for<std::uint16_t>({9}, 100.0).maximum, 100.0);
}

TEST(intensity, zeros_are_unbounded_unless_all_are_zero_or_none_may_be) {
  const auto bounded = [](const IntensityScale& scale, RayCloud rays) {
    apply_intensity(scale, rays);
    return rays.bounded;
  };
  using Bytes = std::vector<std::uint8_t>;
  const std::vector<std::uint16_t> some{0, 1, 65535};
  const std::vector<std::uint16_t> none{0, 0};
  EXPECT_EQ(bounded(scale_for(some), with_intensity(some)), (Bytes{0, 1, 1}));
  EXPECT_EQ(bounded(scale_for(some, 0.0), with_intensity(some)), (Bytes{1, 1, 1}));
  EXPECT_EQ(bounded(scale_for(none), with_intensity(none)), (Bytes{1, 1}));
  const std::vector<float> decibels{-20.0f, 0.0f, 3.0f};
  EXPECT_EQ(bounded(scale_for(decibels), with_intensity(decibels)), (Bytes{1, 1, 1}));
}

TEST(intensity, without_a_column_what_the_source_says_stays) {
  RayCloud rays;
  rays.resize(1);
  rays.colours[0].intensity = 17;
  EXPECT_EQ(intensity_scale({}, {}, {}).rule, Rule::keep);
  apply_intensity(intensity_scale({}, {}, {}), rays);
  EXPECT_EQ(rays.colours[0].intensity, 17);
  EXPECT_EQ(rays.bounded[0], 0);
  EXPECT_THROW(static_cast<void>(intensity_scale({}, {}, -1.0)), Error);
  EXPECT_THROW(static_cast<void>(intensity_scale({}, {}, std::nan(""))), Error);
}

RC_GTEST_PROP(intensity, bounded_rays_are_never_0_and_the_column_never_changes, ()) {
  const auto values = *rc::gen::nonEmpty(rc::gen::arbitrary<std::vector<std::uint16_t>>());
  RayCloud rays = with_intensity(values);
  const auto scale = scale_for(values);
  const IntensityRange range = apply_intensity(scale, rays);
  RC_ASSERT(range.high == *std::max_element(values.begin(), values.end()));
  for (std::size_t i = 0; i < values.size(); ++i) {
    RC_ASSERT(rays.extras[0].values<std::uint16_t>()[i] == values[i]);
    if (scale.rule == Rule::all_bounded) continue;
    RC_ASSERT((rays.bounded[i] != 0) == (values[i] != 0));
    RC_ASSERT((rays.colours[i].intensity != 0) == (values[i] != 0));
    const double exact = 255.0 * values[i] / scale.maximum;
    RC_ASSERT(std::abs(rays.colours[i].intensity - exact) <= (exact < 0.5 ? 1.0 : 0.5));
  }
}

}  // namespace
}  // namespace ray
