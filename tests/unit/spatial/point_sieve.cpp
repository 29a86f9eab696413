#include "spatial/point_sieve.h"

#include <raycloud/core/lanes.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <memory>
#include <vector>

namespace ray {
namespace {

/// Few different values, so that many distances are equal, and equal to the bound.
float coarse(int most) {
  return static_cast<float>(*rc::gen::inRange(-most, most + 1)) * 0.25F;
}

std::vector<std::pair<float, std::uint32_t>> listed(const SievedPoints& near) {
  std::vector<std::pair<float, std::uint32_t>> list;
  for (std::size_t i = 0; i < near.size; ++i)
    list.emplace_back(near.distance2[i], near.place[i]);
  return list;
}

/// What a processor with wide lanes does is what the plain loops do, in the same order.
RC_GTEST_PROP(PointSieve, LanesDoWhatPlainLoopsDo, ()) {
  const FewerLanes fewer(*rc::gen::element(LaneSet::kAvx2, LaneSet::kAvx512));
  const auto wide = std::make_unique<SievePoints>(), plain = std::make_unique<SievePoints>();
  std::array<std::vector<double>, 3> columns;
  const auto leaves = *rc::gen::inRange<std::uint32_t>(1, 8);
  for (std::vector<double>& column : columns)
    for (std::uint32_t i = 0; i < 32 * leaves + 7; ++i)
      column.push_back(5e5 + static_cast<double>(coarse(12)));
  SieveBox box{.middle = {5e5, 5e5, 5e5}, .half = {0.5F, 0.25F, 1.0F}};
  box.within2 = *rc::gen::element(std::numeric_limits<float>::infinity(), 1.0F, 3.0F, 0.0F);
  for (std::uint32_t leaf = 0; leaf < leaves; ++leaf) {
    const SieveSource source{{columns[0].data(), columns[1].data(), columns[2].data()},
                             32 * leaf,
                             *rc::gen::inRange<std::uint32_t>(1, 33)};
    sieve_box(source, box, *wide);
    plain::sieve_box(source, box, *plain);
  }
  RC_ASSERT(wide->size == plain->size);
  for (const auto column : {&SievePoints::x, &SievePoints::y, &SievePoints::z})
    RC_ASSERT(std::equal(((*wide).*column).begin(), ((*wide).*column).begin() + std::ptrdiff_t(wide->size),
                         ((*plain).*column).begin()));
  RC_ASSERT(std::equal(wide->place.begin(), wide->place.begin() + std::ptrdiff_t(wide->size),
                       plain->place.begin()));
  for (std::size_t i = 0; i < wide->size; ++i) {
    wide->to_sensor_x[i] = coarse(2);
    wide->to_sensor_y[i] = coarse(2);
    wide->to_sensor_z[i] = coarse(2);
  }
  wide->pad();

  const auto near = std::make_unique<SievedPoints>(), expected = std::make_unique<SievedPoints>();
  SieveSphere sphere{.middle = {coarse(4), coarse(4), coarse(4)},
                     .within2 = *rc::gen::element(1e18F, 4.0F, 1.0F, 0.0F),
                     .self = *rc::gen::inRange<std::uint32_t>(0, 32)};
  sphere.has_side = *rc::gen::arbitrary<bool>();
  sphere.side = {coarse(2), coarse(2), coarse(2)};
  sphere.doubt = *rc::gen::element(0.0F, 0.125F);
  RC_ASSERT(sieve_sphere(*wide, sphere, *near) == plain::sieve_sphere(*wide, sphere, *expected));
  RC_ASSERT(listed(*near) == listed(*expected));

  for (const float bound : {0.0F, 0.5F, 2.0F}) {
    RC_ASSERT(sieve_count(*near, bound) == plain::sieve_count(*near, bound));
    alignas(32) std::array<float, 32> values;
    for (float& value : values)
      value = coarse(8) + 2.0F;
    const std::size_t count = std::min<std::size_t>(wide->size / kSieveLanes * kSieveLanes, 32);
    RC_ASSERT(sieve_least_sum(*wide, sphere.middle, values.data(), count) ==
              plain::sieve_least_sum(*wide, sphere.middle, values.data(), count));
  }
  SieveBody body{.centre = {coarse(4), coarse(4), coarse(4)},
                 .shape = {2.0F, coarse(2), coarse(2), 1.0F, coarse(2), 3.0F}};
  body.rounding = *rc::gen::element(0.0F, 1e-6F, 0.125F);
  const auto inside = std::make_unique<SievedPoints>(), plainly_inside = std::make_unique<SievedPoints>();
  sieve_body(*wide, body, *inside);
  plain::sieve_body(*wide, body, *plainly_inside);
  RC_ASSERT(listed(*inside) == listed(*plainly_inside));

  sieve_further(*near, 0.75F);
  plain::sieve_further(*expected, 0.75F);
  RC_ASSERT(listed(*near) == listed(*expected));
  RC_ASSERT(sieve_count(*near, 1e30F) == near->size);
}

}  // namespace
}  // namespace ray
