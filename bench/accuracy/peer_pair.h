#pragma once
/// A pair of clouds as files for programs that know no rays, with its truth and what ours found.

#include <raycloud/align/clouds.h>
#include <raycloud/core/pose.h>
#include <raycloud/core/ray_cloud.h>

#include <string>

namespace bench {

struct PeerPair {
  const ray::RayCloud& cloud;
  const ray::RayCloud& reference;
  const ray::Pose& truth;
  const ray::CloudAlignment& found;
  double seconds = 0.0;  ///< that ours took
};

/// Writes NAME_cloud.ply and NAME_reference.ply, the bounded ends in single precision, and NAME.txt: a line
/// with the true pose, by rows, one with ours, and one with the seconds, whether ours was sure, and the
/// middle of the cloud. `name` with its folder. Ends the program with a message where it cannot.
void write_peer_pair(const std::string& name, const PeerPair& pair);

}  // namespace bench
