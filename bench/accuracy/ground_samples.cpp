// The ground of real airborne scans whose ends people have told apart by hand: the samples of the ISPRS test
// of ground filters (Sithole and Vosselman, 2003), where their folder is.

#include "real_data.h"
#include "tables.h"

#include <raycloud/core/memory_stream.h>
#include <raycloud/mesh/mesh_height.h>
#include <raycloud/mesh/terrain.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <string>
#include <vector>

namespace bench {
namespace {

constexpr double kGradient = 3.0;  // of streets with walls and of quarries; the same for all
constexpr double kBand = 0.5;      // m above or below the mesh; such ends are called ground
constexpr double kBandOfSlope =
    1.25;  // m more for each unit of the mesh's slope, as Pingel et al. (2013) have it
constexpr std::uint8_t kGround = 2;

struct GroundSample {
  ray::RayCloud cloud;  ///< seen from straight above, as nothing is known of the sensor
  std::vector<std::uint8_t> classes;
};

/// x, y and z as double and the class as a byte.
GroundSample read_sample(const std::string& file) {
  GroundSample sample;
  FILE* in = popen(printing(file).c_str(), "r");
  if (in == nullptr) return sample;
  char line[200];
  std::size_t count = 0;
  while (std::fgets(line, sizeof line, in) != nullptr && std::strcmp(line, "end_header\n") != 0)
    if (std::strncmp(line, "element vertex ", 15) == 0) count = std::strtoull(line + 15, nullptr, 10);
  sample.cloud.resize(count);
  sample.classes.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    if (std::fread(sample.cloud.ends[i].data(), sizeof(double), 3, in) != 3) break;
    if (std::fread(&sample.classes[i], 1, 1, in) != 1) break;
    sample.cloud.starts[i] = sample.cloud.ends[i] + Eigen::Vector3d(0, 0, 500);
    sample.cloud.bounded[i] = 1;
  }
  pclose(in);
  return sample;
}

/// Over 2 m.
double slope_at(const ray::MeshHeight& mesh, double x, double y) {
  const double along_x = mesh.at(x + 1.0, y).height - mesh.at(x - 1.0, y).height;
  const double along_y = mesh.at(x, y + 1.0).height - mesh.at(x, y - 1.0).height;
  return 0.5 * std::hypot(along_x, along_y);
}

/// Shares of wrong ends, %.
struct SampleErrors {
  double cell = 0.0;
  double missed = 0.0;  ///< of ground ends
  double taken = 0.0;   ///< of others
  double total = 0.0;
};

SampleErrors errors_of(const GroundSample& sample, double gradient) {
  ray::MemorySource source(sample.cloud);
  const ray::Terrain terrain = extract_terrain({}, source, {.gradient = gradient});
  const ray::MeshHeight height(terrain.mesh);
  double ground = 0.0, objects = 0.0, missed = 0.0, taken = 0.0;
  for (std::size_t i = 0; i < sample.cloud.size(); ++i) {
    const Eigen::Vector3d& end = sample.cloud.ends[i];
    const double band = kBand + kBandOfSlope * slope_at(height, end.x(), end.y());
    const bool called_ground = std::abs(end.z() - height.at(end.x(), end.y()).height) <= band;
    if (sample.classes[i] == kGround) {
      ++ground;
      missed += called_ground ? 0 : 1;
    } else {
      ++objects;
      taken += called_ground ? 1 : 0;
    }
  }
  return {terrain.cell, 100.0 * missed / ground, 100.0 * taken / objects,
          100.0 * (missed + taken) / (ground + objects)};
}

}  // namespace

void print_ground_samples() {
  std::printf(
      "\n## Ground of labelled airborne scans\n\nThe samples of the ISPRS test of ground filters, all with `--gradient %.0f`; "
      "ends within %.1f m above or below the mesh, and 1.25 m more for each unit of its slope, are called ground. Type I: ground ends that are not, type II: others that "
      "are.\n\n| sample | ends | cell (m) | type I | type II | total | bar | |\n|---|---|---|---|---|---|---|---|\n",
      kGradient, kBand);
  double sum = 0.0, sum_by_default = 0.0;
  int count = 0;
  for (const char* number : {"11", "12", "21", "22", "23", "24", "31"}) {
    const std::string file = real_file(std::string("isprs_samp") + number);
    if (file.empty()) continue;
    const GroundSample sample = read_sample(file);
    const SampleErrors errors = errors_of(sample, kGradient);
    std::printf("| %s | %zu | %.2f | %.2f %% | %.2f %% | %.2f %% | | |\n", number, sample.cloud.size(),
                errors.cell, errors.missed, errors.taken, errors.total);
    sum += errors.total;
    sum_by_default += errors_of(sample, ray::TerrainOptions{}.gradient).total;
    ++count;
  }
  if (count == 0) {
    std::printf("\nThe files are not here: set RAYCLOUD_TEST_DATA.\n");
    return;
  }
  std::printf("| mean | | | | | %.2f %% | %s |\n", sum / count, verdict("≤ 5 %", sum <= 5.0 * count).c_str());
  std::printf("\nWith the default gradient the mean is %.2f %%.\n", sum_by_default / count);
}

}  // namespace bench
