#pragma once
/// Points as bench programs write them, for the Point Cloud Library.

#include <pcl/point_cloud.h>
#include <pcl/point_types.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <vector>

namespace bench {

using PclCloud = pcl::PointCloud<pcl::PointXYZ>;

/// A binary PLY file of x, y and z in single precision. Ends the program with a message where there is none.
inline PclCloud::Ptr read_pcl_points(const char* name) {
  std::ifstream file(name, std::ios::binary);
  std::size_t count = 0;
  for (std::string line; std::getline(file, line) && line != "end_header";)
    if (line.rfind("element vertex ", 0) == 0) count = std::stoull(line.substr(15));
  std::vector<float> values(3 * count);
  file.read(reinterpret_cast<char*>(values.data()), static_cast<std::streamsize>(4 * values.size()));
  if (!file || count == 0) {
    std::fprintf(stderr, "%s: no points\n", name);
    std::exit(1);
  }
  const PclCloud::Ptr cloud(new PclCloud);
  for (std::size_t i = 0; i < values.size(); i += 3)
    cloud->push_back({values[i], values[i + 1], values[i + 2]});
  return cloud;
}

}  // namespace bench
