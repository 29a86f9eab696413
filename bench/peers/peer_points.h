#pragma once
/// The points of a ray cloud for programs that know no rays.

#include <cstddef>
#include <string>

namespace bench {

struct PeerPoints {
  std::size_t count = 0;
  double radius = 0.0;  ///< m, that holds 16 neighbours of half of the points
};

/// Writes the bounded ends as a binary PLY file of x, y and z in single precision, which every peer reads.
/// Ends the program with a message where it cannot.
PeerPoints write_peer_points(const std::string& cloud, const std::string& points);

}  // namespace bench
