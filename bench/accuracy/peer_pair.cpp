#include "peer_pair.h"

#include <cstdio>
#include <cstdlib>
#include <vector>

namespace bench {
namespace {

std::FILE* open_or_exit(const std::string& name) {
  std::FILE* file = std::fopen(name.c_str(), "wb");
  if (file != nullptr) return file;
  std::fprintf(stderr, "failed: to write %s\n", name.c_str());
  std::exit(1);
}

Eigen::Vector3d write_ends(const std::string& name, const ray::RayCloud& rays) {
  std::vector<float> coordinates;
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < rays.size(); ++i) {
    if (rays.bounded[i] == 0) continue;
    middle += rays.ends[i];
    for (const double coordinate : rays.ends[i])
      coordinates.push_back(static_cast<float>(coordinate));
  }
  std::FILE* file = open_or_exit(name);
  std::fprintf(file,
               "ply\nformat binary_little_endian 1.0\nelement vertex %zu\n"
               "property float x\nproperty float y\nproperty float z\nend_header\n",
               coordinates.size() / 3);
  std::fwrite(coordinates.data(), sizeof(float), coordinates.size(), file);
  std::fclose(file);
  return middle * (3.0 / static_cast<double>(coordinates.size()));
}

void write_pose(std::FILE* file, const ray::Pose& pose) {
  for (Eigen::Index i = 0; i < 3; ++i)
    std::fprintf(file, "%.12g %.12g %.12g %.12g ", pose.rotation(i, 0), pose.rotation(i, 1),
                 pose.rotation(i, 2), pose.translation[i]);
  std::fprintf(file, "\n");
}

}  // namespace

void write_peer_pair(const std::string& name, const PeerPair& pair) {
  write_ends(name + "_reference.ply", pair.reference);
  const Eigen::Vector3d middle = write_ends(name + "_cloud.ply", pair.cloud);
  std::FILE* file = open_or_exit(name + ".txt");
  write_pose(file, pair.truth);
  write_pose(file, pair.found.pose);
  std::fprintf(file, "%.3f %d %.6f %.6f %.6f\n", pair.seconds, pair.found.doubt.empty() ? 1 : 0, middle.x(),
               middle.y(), middle.z());
  std::fclose(file);
}

}  // namespace bench
