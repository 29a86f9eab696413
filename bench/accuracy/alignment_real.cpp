// Sweeps of real scans onto each other, where the pose of each is known: what a program sees that nobody made
// for it.

#include "aligned_pairs.h"
#include "real_data.h"
#include "tables.h"

#include <raycloud/exec/random.h>
#include <raycloud/exec/stream.h>
#include <raycloud/io/ply_cloud.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

namespace bench {
namespace {

struct RealScan {
  const char* file;
  const char* name;
  double period;  ///< s, of the pieces
};

constexpr RealScan kScans[] = {{"kitti07_dump__kitti07_dump", "car round a corner, sweeps", 1.0},
                               {"uos3d", "corridor, stops", 40.0},
                               {"balm", "walking robot, 5 s", 5.0},
                               {"ouster_os1_128", "spinning lidar in a street, spins", 0.1},
                               {"kitti_dyn1", "car in traffic, 0.5 s", 0.5}};

ray::RayCloud read_real(const std::string& file) {
  namespace fs = std::filesystem;
  const fs::path unpacked =
      fs::temp_directory_path() / ("bench_alignment_" + fs::path(file).stem().stem().string() + ".ply");
  ray::RayCloud rays;
  if (std::system((printing(file) + " > " + unpacked.string()).c_str()) == 0)
    rays = read_all({}, *ray::open_ply(unpacked));
  fs::remove(unpacked);
  return rays;
}

/// Those of each period, but for ends of a scan that are less than half a piece.
std::vector<ray::RayCloud> pieces_of(const ray::RayCloud& rays, double period) {
  constexpr double kLate = 1e-3;  // of a period: times are rounded
  constexpr std::size_t kLeast = 5000;
  const double first = *std::min_element(rays.times.begin(), rays.times.end());
  std::vector<ray::RayCloud> pieces;
  std::vector<std::uint8_t> mask(rays.size());
  for (std::size_t number = 0, seen = 0; seen < rays.size(); ++number) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      mask[i] = std::floor((rays.times[i] - first) / period + kLate) == static_cast<double>(number) ? 1 : 0;
      count += mask[i];
    }
    seen += count;
    if (count < kLeast) continue;
    pieces.push_back(rays);
    pieces.back().select(mask);
  }
  return pieces;
}

void scan_rows(const RealScan& scan, double tilt) {
  const std::string row =
      std::string(scan.name) + ", tilted by " + std::to_string(std::lround(tilt / kDegree)) + " degrees";
  const std::string file = real_file(scan.file);
  if (file.empty() || !is_wanted(row)) return;
  const std::vector<ray::RayCloud> pieces = pieces_of(read_real(file), scan.period);
  const ray::RandomStream random(7 + other_worlds(), row);
  Tally tally;
  for (std::size_t i = 0; i < pieces.size(); ++i)
    for (std::size_t j = 0; j < pieces.size(); ++j)
      if (i != j) {
        const auto name = std::to_string(i) + " onto " + std::to_string(j);
        judge(moved_pair(pieces[i], pieces[j], tilt, random, i * pieces.size() + j), row + ": " + name,
              tally);
      }
  print_row(row, tally, "wrong < 0.5", tally.wrong == 0);
}

}  // namespace

void print_real_alignment() {
  std::printf(
      "\nPieces of real scans onto each other, each onto every other, by the poses of their files, good to some "
      "centimetres\n\n");
  print_alignment_header();
  for (const RealScan& scan : kScans)
    for (const double tilt : {0.0, 10.0 * kDegree, 40.0 * kDegree})
      scan_rows(scan, tilt);
}

}  // namespace bench
