#pragma once
/// Clouds for property tests: any size, extra columns of every scalar type, coordinates of chosen magnitude.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/random.h>

#include <array>
#include <cstring>

namespace ray::test {

inline constexpr std::array<ScalarType, 10> kAllScalarTypes{
    ScalarType::int8,   ScalarType::uint8, ScalarType::int16,  ScalarType::uint16,  ScalarType::int32,
    ScalarType::uint32, ScalarType::int64, ScalarType::uint64, ScalarType::float32, ScalarType::float64};

/// One column of every scalar type, named "extra_<type>".
inline std::vector<ColumnInfo> schema_of_every_type() {
  std::vector<ColumnInfo> schema;
  for (const ScalarType type : kAllScalarTypes)
    schema.push_back({"extra_" + std::string(name_of(type)), type});
  return schema;
}

struct RandomCloudOptions {
  std::size_t rays = 100;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m
  double half_extent = 20.0;                         ///< m
  bool float_coordinates = false;                    ///< every coordinate and ray vector is exact in float
  std::vector<ColumnInfo> extras;
};

/// Deterministic for a seed; includes unbounded rays, zero-length rays, duplicate times and repeated end
/// points.
inline RayCloud random_cloud(std::uint64_t seed, const RandomCloudOptions& options = {}) {
  const RandomStream random(seed, "test cloud");
  RayCloud cloud;
  cloud.set_schema(options.extras);
  cloud.resize(options.rays);
  for (std::size_t i = 0; i < options.rays; ++i) {
    const auto in_box = [&](std::uint64_t draw) {
      return options.half_extent * (2.0 * random.uniform(i, draw) - 1.0);
    };
    Eigen::Vector3d end = options.centre + Eigen::Vector3d(in_box(0), in_box(1), in_box(2));
    Eigen::Vector3d to_start(in_box(3), in_box(4), in_box(5));
    if (random.below(20, i, 6) == 0) to_start.setZero();
    if (i > 0 && random.below(20, i, 7) == 0) end = cloud.ends[i - 1];
    if (options.float_coordinates) {
      end = end.cast<float>().cast<double>();
      // Multiples of 2^-10 m, so that end + vector is exact as well.
      to_start = (to_start * 1024.0).array().round() / 1024.0;
      end = (end * 1024.0).array().round() / 1024.0;
    }
    cloud.ends[i] = end;
    cloud.starts[i] = end + to_start;
    cloud.times[i] = static_cast<double>(i / 2) * 0.01;
    cloud.bounded[i] = random.below(5, i, 8) == 0 ? 0 : 1;
    const std::uint64_t bits = random.bits(i, 9);
    cloud.colours[i] = {static_cast<std::uint8_t>(bits), static_cast<std::uint8_t>(bits >> 8),
                        static_cast<std::uint8_t>(bits >> 16),
                        static_cast<std::uint8_t>(cloud.bounded[i] ? 1 + (bits >> 24) % 255 : 0)};
    for (std::size_t c = 0; c < cloud.extras.size(); ++c) {
      Column& column = cloud.extras[c];
      const std::uint64_t value = random.bits(i, 10 + c);
      visit_scalar(column.type(), [&]<class T>() {
        if constexpr (std::is_floating_point_v<T>) {
          column.values<T>()[i] = static_cast<T>(static_cast<double>(value >> 40) / 1024.0 - 8000.0);
        } else {
          column.values<T>()[i] = static_cast<T>(value);
        }
      });
    }
  }
  return cloud;
}

/// Every bit of every column is the same.
inline bool same_bits(const RayCloud& a, const RayCloud& b) {
  const auto same = [](const auto& x, const auto& y) {
    return x.size() == y.size() &&
           (x.empty() || std::memcmp(x.data(), y.data(), x.size() * sizeof(x[0])) == 0);
  };
  return same(a.starts, b.starts) && same(a.ends, b.ends) && same(a.times, b.times) &&
         same(a.colours, b.colours) && same(a.bounded, b.bounded) && a.extras == b.extras;
}

}  // namespace ray::test
