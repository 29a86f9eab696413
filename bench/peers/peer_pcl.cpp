// One operation of the Point Cloud Library on a file of points.
//   peer_pcl normals|outliers|radius|smooth POINTS.ply OUT.bin [RADIUS]
// Reads what write_peer_points wrote and writes the result as it lies in memory, so that reading and writing
// take PCL no longer than they must.

#include "peer_pcl_points.h"

#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/radius_outlier_removal.h>
#include <pcl/filters/statistical_outlier_removal.h>
#include <pcl/search/kdtree.h>
#include <pcl/surface/mls.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>

namespace {

using Cloud = bench::PclCloud;

template <class Points>
void write(const Points& points, const char* name) {
  std::ofstream file(name, std::ios::binary);
  file.write(reinterpret_cast<const char*>(points.points.data()),
             static_cast<std::streamsize>(points.size() * sizeof(points.points[0])));
}

pcl::search::KdTree<pcl::PointXYZ>::Ptr new_tree() {
  return pcl::search::KdTree<pcl::PointXYZ>::Ptr(new pcl::search::KdTree<pcl::PointXYZ>);
}

void normals(const Cloud::Ptr& cloud, const char* out) {
  pcl::NormalEstimationOMP<pcl::PointXYZ, pcl::Normal> estimation(std::thread::hardware_concurrency());
  estimation.setInputCloud(cloud);
  estimation.setSearchMethod(new_tree());
  estimation.setKSearch(16);
  pcl::PointCloud<pcl::Normal> result;
  estimation.compute(result);
  write(result, out);
}

void outliers(const Cloud::Ptr& cloud, const char* out) {
  pcl::StatisticalOutlierRemoval<pcl::PointXYZ> removal;
  removal.setInputCloud(cloud);
  removal.setMeanK(16);
  removal.setStddevMulThresh(3.0);
  Cloud result;
  removal.filter(result);
  write(result, out);
}

void radius_outliers(const Cloud::Ptr& cloud, const char* out, double radius) {
  pcl::RadiusOutlierRemoval<pcl::PointXYZ> removal;
  removal.setInputCloud(cloud);
  removal.setRadiusSearch(radius);
  removal.setMinNeighborsInRadius(1);
  Cloud result;
  removal.filter(result);
  write(result, out);
}

void smooth(const Cloud::Ptr& cloud, const char* out, double radius) {
  pcl::MovingLeastSquares<pcl::PointXYZ, pcl::PointXYZ> squares;
  squares.setInputCloud(cloud);
  squares.setSearchMethod(new_tree());
  squares.setSearchRadius(radius);
  squares.setPolynomialOrder(2);
  squares.setNumberOfThreads(std::thread::hardware_concurrency());
  Cloud result;
  squares.process(result);
  write(result, out);
}

}  // namespace

int main(int argc, char** argv) {
  const std::string operation = argc > 1 ? argv[1] : "";
  const bool has_radius = operation == "radius" || operation == "smooth";
  if (argc != (has_radius ? 5 : 4) || (!has_radius && operation != "normals" && operation != "outliers")) {
    std::fprintf(stderr, "usage: peer_pcl normals|outliers|radius|smooth POINTS.ply OUT.bin [RADIUS]\n");
    return 2;
  }
  const Cloud::Ptr cloud = bench::read_pcl_points(argv[2]);
  if (operation == "normals") normals(cloud, argv[3]);
  if (operation == "outliers") outliers(cloud, argv[3]);
  if (operation == "radius") radius_outliers(cloud, argv[3], std::atof(argv[4]));
  if (operation == "smooth") smooth(cloud, argv[3], std::atof(argv[4]));
  return 0;
}
