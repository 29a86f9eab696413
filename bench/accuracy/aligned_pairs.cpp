#include "aligned_pairs.h"

#include "peer_pair.h"
#include "tables.h"

#include <raycloud/align/clouds.h>
#include <raycloud/core/memory_stream.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace bench {
namespace {

struct PoseError {
  double turn = 0.0;   ///< rad
  double shift = 0.0;  ///< m, of the middle of the cloud
};

PoseError error_of(const ray::Pose& pose, const CloudPair& pair) {
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  double count = 0.0;
  for (std::size_t i = 0; i < pair.cloud.size(); ++i)
    if (pair.cloud.bounded[i] != 0) middle += pair.cloud.ends[i], count += 1.0;
  middle /= count;
  return {Eigen::AngleAxisd(Eigen::Matrix3d(pose.rotation.transpose() * pair.truth.rotation)).angle(),
          (pose * middle - pair.truth * middle).norm()};
}

double quantile(std::vector<double> values, double share) {
  if (values.empty()) return std::nan("");
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(share * static_cast<double>(values.size() - 1))];
}

void tell(const std::string& name, const ray::CloudAlignment& found, const PoseError& error,
          const char* outcome) {
  if (std::getenv("RAYCLOUD_BENCH_PAIRS") == nullptr) return;
  std::fprintf(stderr,
               "%s: %s turn %.3f deg, shift %.3f m, overlap %.2f %.2f, agreement %.2f, rmse %.4f: %s\n",
               name.c_str(), outcome, error.turn / kDegree, error.shift, found.overlap,
               found.reference_overlap, found.agreement, found.rmse, found.doubt.c_str());
}

}  // namespace

CloudPair moved_pair(ray::RayCloud cloud, ray::RayCloud reference, double tilt,
                     const ray::RandomStream& random, std::uint64_t number) {
  const auto uniform = [&](std::uint64_t draw, double low, double high) {
    return low + (high - low) * random.uniform(number, draw);
  };
  const Eigen::Matrix3d level =
      Eigen::AngleAxisd(uniform(1, 0.0, 2.0 * std::numbers::pi), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double towards = uniform(5, 0.0, 2.0 * std::numbers::pi);
  const ray::Pose moved{
      ray::rotation_pose(tilt * Eigen::Vector3d(std::cos(towards), std::sin(towards), 0.0)).rotation * level,
      {uniform(2, -100.0, 100.0), uniform(3, -100.0, 100.0), uniform(4, -10.0, 10.0)}};
  cloud.transform(moved);
  return {std::move(cloud),
          std::move(reference),
          {moved.rotation.transpose(), -(moved.rotation.transpose() * moved.translation)}};
}

void judge(const CloudPair& pair, const std::string& name, Tally& tally) {
  constexpr double kCoarseTurn = 0.5 * kDegree, kCoarseShift = 0.2, kFineTurn = 0.05 * kDegree,
                   kFineShift = 0.02;
  ray::MemorySource cloud(pair.cloud), reference(pair.reference);
  const auto begin = std::chrono::steady_clock::now();
  const ray::CloudAlignment found = align_clouds({}, cloud, reference);
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  tally.seconds += seconds;
  if (const char* folder = std::getenv("RAYCLOUD_BENCH_PEER_PAIRS"))
    write_peer_pair(std::string(folder) + "/" + name,
                    {pair.cloud, pair.reference, pair.truth, found, seconds});
  const PoseError error = error_of(found.pose, pair);
  const bool is_coarse = error.turn < kCoarseTurn && error.shift < kCoarseShift;
  const bool is_fine = error.turn < kFineTurn && error.shift < kFineShift;
  ++tally.pairs;
  if (!found.doubt.empty()) {
    ++tally.refused;
    tally.refused_right += is_coarse ? 1 : 0;
  } else {
    tally.coarse += is_coarse ? 1 : 0;
    tally.fine += is_fine ? 1 : 0;
    tally.wrong += is_coarse ? 0 : 1;
    if (is_coarse) tally.turns.push_back(error.turn), tally.shifts.push_back(error.shift);
  }
  tell(name, found, error,
       !found.doubt.empty() ? (is_coarse ? "refused, though right" : "refused")
       : is_fine            ? "fine"
       : is_coarse          ? "coarse"
                            : "WRONG");
}

void print_alignment_header() {
  std::printf(
      "| world, overlap | pairs | coarse, %% | fine, %% | wrong, %% | refused, %% | of these right, %% | turn, degrees: "
      "median, 95 %% | shift, m | seconds | bar | |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const std::string& name, const Tally& tally, const std::string& bar, bool met) {
  const auto percent = [&](int part) { return 100.0 * part / tally.pairs; };
  std::printf("| %s | %d | %.0f | %.0f | %.1f | %.0f | %.0f | %.4f, %.4f | %.4f, %.4f | %.2f | %s |\n",
              name.c_str(), tally.pairs, percent(tally.coarse), percent(tally.fine), percent(tally.wrong),
              percent(tally.refused), percent(tally.refused_right), quantile(tally.turns, 0.5) / kDegree,
              quantile(tally.turns, 0.95) / kDegree, quantile(tally.shifts, 0.5),
              quantile(tally.shifts, 0.95), tally.seconds / tally.pairs, verdict(bar, met).c_str());
  std::fflush(stdout);
}

bool is_wanted(const std::string& row) {
  const char* words = std::getenv("RAYCLOUD_BENCH_ROWS");
  if (words == nullptr) return true;
  std::istringstream all(words);
  for (std::string word; all >> word;)
    if (row.find(word) != std::string::npos) return true;
  return false;
}

std::uint64_t number_given(const char* variable, std::uint64_t otherwise) {
  const char* given = std::getenv(variable);
  return given != nullptr ? std::strtoull(given, nullptr, 10) : otherwise;
}

std::uint64_t other_worlds() {
  constexpr std::uint64_t kApart = 100;
  return kApart * number_given("RAYCLOUD_BENCH_WORLDS", 0);
}

}  // namespace bench
