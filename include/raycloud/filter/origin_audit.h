#pragma once
/// Are the sensor positions of a cloud plausible? Wrong origins are the usual reason why free space, and with
/// it moving-object removal, does not work; this looks for the marks they leave.

#include <raycloud/core/ray_cloud.h>
#include <raycloud/exec/context.h>
#include <raycloud/exec/random.h>

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace ray {

struct AuditOptions {
  bool origins_by_request = false;  ///< one point or one vector for all was asked for: no finding
  bool real_times = true;           ///< else nothing is concluded from times
};

struct OriginFindings {
  std::vector<std::string>
      findings;  ///< one line each, with the option that mends it; empty: nothing suspicious

  double path_length = 0.0;   ///< m, over the origins in file order
  double median_speed = 0.0;  ///< m/s
  std::uint64_t jumps = 0;    ///< steps over 1 m, faster than 10 m/s and 10 × the median speed
  double zero_length = 0.0;   ///< share of rays that start where they end (within 1 µm)
  double too_long = 0.0;      ///< share of bounded rays beyond 3 × the 99th percentile of length
  double through = 0.0;       ///< share of the walked rays that pass through a surface which others hit
};

/// Goes over a cloud once, in file order, and keeps a bounded summary: a histogram of lengths, the steps of
/// the path (of all of the first million rays, of one in seven beyond) and an even sample of the rays. About
/// 5 ns a ray; memory ≤ 30 MB. The answer depends neither on how the cloud is cut into chunks nor on threads.
///
/// The test for shifted origins fits flat patches to the sampled ends in 0.25 m cubes and counts the rays
/// that cross one steeply, more than 1 m before their end. In a cloud with right origins that count has a
/// minimum where they are: if moving all origins (1 m along each axis, 3 m but not up, and along the path by
/// changing the clock) halves it, they are wrong. Passing moving objects, glass and a sparse sample (maps of
/// many hundred metres) make it see less, not more.
class OriginAudit {
 public:
  OriginAudit();
  void add(const RayCloud& rays);
  /// Walks 20 000 rays past the patches, and where that finds something, for each of the moves: up to half a
  /// second on one core.
  [[nodiscard]] OriginFindings findings(const Context& context, const AuditOptions& options = {}) const;

  /// A ray of the sample, relative to reference().
  struct Sampled {
    std::uint64_t key;
    double time;
    Eigen::Vector3f start;
    Eigen::Vector3f end;
    bool bounded;
  };

 private:
  struct Step {
    float length;
    float duration;
  };
  void add_sameness(const RayCloud& rays);
  void add_length(double squared, bool bounded);
  void add_step(double time, const Eigen::Vector3d& start);
  [[nodiscard]] bool takes_second(std::uint64_t block, unsigned level) const;
  [[nodiscard]] std::uint64_t sampled_of(std::uint64_t block) const;
  void add_sample(const RayCloud& rays, std::size_t i);
  void judge_lengths(OriginFindings& result) const;
  void judge_path(OriginFindings& result, const AuditOptions& options) const;
  void judge_surfaces(const Context& context, OriginFindings& result, const AuditOptions& options) const;

  std::uint64_t count_ = 0;
  std::uint64_t next_measured_ = 0;  // the next ray whose length and step are looked at, by number
  std::uint64_t measured_ = 0;
  std::uint64_t zero_ = 0;
  std::vector<std::uint64_t> lengths_;
  Eigen::Vector3d first_start_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d first_end_ = Eigen::Vector3d::Zero();
  bool one_start_ = true;
  bool one_vector_ = true;
  double first_time_ = std::numeric_limits<double>::infinity();
  double last_time_ = -std::numeric_limits<double>::infinity();

  std::vector<Step> steps_;
  double step_duration_ = 0.05;  // s; doubles when there are too many steps
  double anchor_time_ = 0.0;
  Eigen::Vector3d anchor_ = Eigen::Vector3d::Zero();

  RandomStream random_;
  // One ray of each block of 2^level_ rays, chosen so that of two blocks that are joined one choice remains.
  std::vector<Sampled> sample_;
  unsigned level_ = 0;
  std::uint64_t block_ = 0;         // the next to be sampled
  std::uint64_t next_sampled_ = 0;  // its ray, by number
};

}  // namespace ray
