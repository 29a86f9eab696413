#pragma once
/// One cloud onto another, from anywhere (paper, section VIII-E). docs/algorithms/alignment.md.

#include <raycloud/core/bend.h>
#include <raycloud/core/pose.h>
#include <raycloud/core/ray_stream.h>
#include <raycloud/exec/context.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>

namespace ray {

struct AlignRule {
  bool local = false;     ///< the clouds are about where they should be: look nowhere else
  bool nonrigid = false;  ///< bend the cloud, too, where it clearly fits better then
};

struct CloudAlignment {
  Pose pose;          ///< takes the cloud onto the reference
  Bend bend;          ///< to be applied after the pose; none unless it was asked for and is clearly better
  std::string doubt;  ///< why the pose is not to be trusted, for the user; empty: it is

  double overlap = 0.0;            ///< of the cloud's surfaces, the share that lies on those of the reference
  double reference_overlap = 0.0;  ///< of the reference's surfaces, the share that lies on those of the cloud
  /// Of the surfaces that are where the other cloud has a surface or has seen that there is none, the share
  /// that lies on one.
  double agreement = 0.0;
  double rmse = 0.0;     ///< m, of the distances of patches from the surfaces of the reference
  double patches = 0.0;  ///< so many

  /// Of small turns (rad, about `centre`) and shifts (m).
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Zero();
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();  ///< m, where the patches of the cloud come to lie

  /// By how much Schwarz's criterion falls below that of the rigid transform; 0 where no bend was looked for.
  /// It is applied where this is above 10, and the bend above 2 cm.
  double bend_gain = 0.0;
  double bend_size = 0.0;  ///< m, the largest shift of a patch by the bend

  std::uint64_t dropped = 0;  ///< rays left out because of a NaN or infinite value
};

/// Looks for the turn about the vertical and the shift, by correlation of both clouds as seen from above,
/// then for the rigid transform that brings surfaces onto surfaces. Each of many hypotheses is judged by
/// surfaces and by free space: what one cloud has where the rays of the other went through counts against it.
/// The best is trusted only where hardly a ray of one cloud goes through a surface of the other, and where no
/// other place at which the finest fit comes to rest is as good.
/// The vertical may be wrong by some degrees. A bend is fitted to all patches of the rigid answer, together
/// with its turn and shift, and what comes of it is judged anew.
///
/// Reads each cloud twice (the first four times where it is bent) and rewinds it. Streaming; 0.1 µs of one
/// core a ray, and a second; memory: about 250 bytes a patch of some 16 rays. The result does not depend on
/// threads or chunks.
///
/// Throws Error(no_data) if one of the clouds has no surfaces.
[[nodiscard]] CloudAlignment align_clouds(const Context& context, RaySource& cloud, RaySource& reference,
                                          const AlignRule& rule = {});

}  // namespace ray
