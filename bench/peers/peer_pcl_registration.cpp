// Global registration of two files of points by the Point Cloud Library, and ICP.
//   peer_pcl_registration CLOUD.ply REFERENCE.ply VOXEL
// Samples at VOXEL (m), normals within 2 and FPFH within 5 of it, sample consensus with prerejection (Buch
// and others 2013), then ICP, point to plane, on points of 5 cm. Prints the first three rows of the pose.

#include "peer_pcl_points.h"

#include <pcl/features/fpfh_omp.h>
#include <pcl/features/normal_3d_omp.h>
#include <pcl/filters/voxel_grid.h>
#include <pcl/registration/icp.h>
#include <pcl/registration/sample_consensus_prerejective.h>

#include <thread>

namespace {

using Points = pcl::PointCloud<pcl::PointNormal>;
using Features = pcl::PointCloud<pcl::FPFHSignature33>;

Points::Ptr sampled(const bench::PclCloud::Ptr& cloud, float width, float radius) {
  pcl::VoxelGrid<pcl::PointXYZ> grid;
  grid.setInputCloud(cloud);
  grid.setLeafSize(width, width, width);
  const bench::PclCloud::Ptr sparse(new bench::PclCloud);
  grid.filter(*sparse);
  const Points::Ptr points(new Points);
  pcl::copyPointCloud(*sparse, *points);
  pcl::NormalEstimationOMP<pcl::PointNormal, pcl::PointNormal> normals(std::thread::hardware_concurrency());
  normals.setInputCloud(points);
  normals.setRadiusSearch(static_cast<double>(radius));
  normals.compute(*points);
  const Points::Ptr known(new Points);
  for (const pcl::PointNormal& point : *points)
    if (std::isfinite(point.normal_x)) known->push_back(point);
  return known;
}

Features::Ptr features_of(const Points::Ptr& points, float radius) {
  pcl::FPFHEstimationOMP<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> estimation(
      std::thread::hardware_concurrency());
  estimation.setInputCloud(points);
  estimation.setInputNormals(points);
  estimation.setRadiusSearch(static_cast<double>(radius));
  const Features::Ptr features(new Features);
  estimation.compute(*features);
  return features;
}

Eigen::Matrix4f icp(const Points::Ptr& cloud, const Points::Ptr& reference, const Eigen::Matrix4f& start,
                    double distance) {
  pcl::IterativeClosestPointWithNormals<pcl::PointNormal, pcl::PointNormal> fit;
  fit.setInputSource(cloud);
  fit.setInputTarget(reference);
  fit.setMaxCorrespondenceDistance(distance);
  fit.setMaximumIterations(30);
  Points moved;
  fit.align(moved, start);
  return fit.getFinalTransformation();
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fprintf(stderr, "usage: peer_pcl_registration CLOUD.ply REFERENCE.ply VOXEL\n");
    return 2;
  }
  const bench::PclCloud::Ptr cloud = bench::read_pcl_points(argv[1]),
                             reference = bench::read_pcl_points(argv[2]);
  const auto voxel = static_cast<float>(std::atof(argv[3]));
  constexpr float kFine = 0.05F;
  const Points::Ptr from = sampled(cloud, voxel, 2 * voxel), to = sampled(reference, voxel, 2 * voxel);
  pcl::SampleConsensusPrerejective<pcl::PointNormal, pcl::PointNormal, pcl::FPFHSignature33> search;
  search.setInputSource(from);
  search.setSourceFeatures(features_of(from, 5 * voxel));
  search.setInputTarget(to);
  search.setTargetFeatures(features_of(to, 5 * voxel));
  search.setMaximumIterations(20000);
  search.setNumberOfSamples(3);
  search.setCorrespondenceRandomness(5);
  search.setSimilarityThreshold(0.9F);
  search.setMaxCorrespondenceDistance(static_cast<double>(1.5F * voxel));
  search.setInlierFraction(0.25F);
  Points moved;
  search.align(moved);
  const Points::Ptr fine_from = sampled(cloud, kFine, 4 * kFine),
                    fine_to = sampled(reference, kFine, 4 * kFine);
  Eigen::Matrix4f pose =
      icp(fine_from, fine_to, search.getFinalTransformation(), 2.0 * static_cast<double>(voxel));
  pose = icp(fine_from, fine_to, pose, 0.1);
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 4; ++column)
      std::printf("%.9g ", static_cast<double>(pose(row, column)));
  std::printf("\n");
  return 0;
}
