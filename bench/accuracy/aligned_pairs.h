#pragma once
/// Pairs of clouds whose true pose is known, one of them moved: how truly they are aligned, row by row.

#include <raycloud/core/pose.h>
#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/random.h>

#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace bench {

constexpr double kDegree = std::numbers::pi / 180.0;

struct CloudPair {
  ray::RayCloud cloud, reference;
  ray::Pose truth;
};

/// The cloud moved by up to 100 m, turned by any yaw and tilted by `tilt` (rad), and how it comes back.
[[nodiscard]] CloudPair moved_pair(ray::RayCloud cloud, ray::RayCloud reference, double tilt,
                                   const ray::RandomStream& random, std::uint64_t number);

/// What came of the pairs of a row.
struct Tally {
  int pairs = 0, fine = 0, coarse = 0, wrong = 0, refused = 0, refused_right = 0;
  std::vector<double> turns, shifts;
  double seconds = 0.0;
};

/// Aligns a pair and counts what came of it. RAYCLOUD_BENCH_PAIRS prints each pair; RAYCLOUD_BENCH_PEER_PAIRS
/// names a folder where pairs are left for other programs, each by its name.
void judge(const CloudPair& pair, const std::string& name, Tally& tally);

void print_alignment_header();
void print_row(const std::string& name, const Tally& tally, const std::string& bar, bool met);

/// Whether one of the words of RAYCLOUD_BENCH_ROWS is in the name of a row, as in "street:50"; all rows where
/// there are no words.
[[nodiscard]] bool is_wanted(const std::string& row);

[[nodiscard]] std::uint64_t number_given(const char* variable, std::uint64_t otherwise);

/// Numbers that alignment needs are chosen on other worlds and cuts than those of the tables: with
/// RAYCLOUD_BENCH_WORLDS, above 0, every seed is another.
[[nodiscard]] std::uint64_t other_worlds();

}  // namespace bench
