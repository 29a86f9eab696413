#pragma once
/// What the rays of another scan tell of the points of one, and what of the changed ones a merge leaves.

#include <raycloud/core/ray_cloud.h>

#include <string>

namespace bench {

/// Adds the columns `crossings` (uint16: how many rays of the other cloud go through the ellipsoid around the
/// end and on for 5 cm) and `near` (uint8: 1 if an end of the other cloud is within 5 cm); 0 for unbounded
/// rays.
void add_what_others_tell(ray::RayCloud& rays, const ray::RayCloud& of_other);

/// A table with a row for each pair of scans: of the points with the column `changed` set, how many go, and
/// of those that stay, what is known of them.
void print_left_heading();
/// With a bar for those that go, in %, if it is above 0.
[[nodiscard]] std::string left_row(const std::string& name, const ray::RayCloud& stays,
                                   const ray::RayCloud& goes, double least_gone);

}  // namespace bench
