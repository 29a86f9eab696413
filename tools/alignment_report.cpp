#include "alignment_report.h"

#include <raycloud/io/transform_file.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace ray::tools {
namespace {

template <class... Values>
std::string formatted(const char* pattern, Values... values) {
  std::array<char, 400> text;
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

/// Zero without a sign, so that the same transform looks the same.
double shown(double value, double least) {
  return std::abs(value) < least ? 0.0 : value;
}

}  // namespace

std::string as_text(const Pose& pose) {
  std::string text = "matrix\n";
  for (Eigen::Index row = 0; row < 3; ++row) {
    text += formatted("  %13.10f %13.10f %13.10f %16.6f\n", shown(pose.rotation(row, 0), 5e-11),
                      shown(pose.rotation(row, 1), 5e-11), shown(pose.rotation(row, 2), 5e-11),
                      shown(pose.translation[row], 5e-7));
  }
  text += formatted("  %13.10f %13.10f %13.10f %16.6f\n", 0.0, 0.0, 0.0, 1.0);
  const Eigen::Vector3d turn = rotation_vector_deg(pose);
  text += formatted("rotation vector  %.6f,%.6f,%.6f degrees\n", shown(turn.x(), 5e-7), shown(turn.y(), 5e-7),
                    shown(turn.z(), 5e-7));
  text += formatted("translation      %.6f,%.6f,%.6f m\n", shown(pose.translation.x(), 5e-7),
                    shown(pose.translation.y(), 5e-7), shown(pose.translation.z(), 5e-7));
  return text;
}

std::string as_text(const AxesAlignment& alignment) {
  return formatted("walls            %.0f m2 along the axes, %.0f %% of what is upright\n",
                   alignment.wall_area, 100.0 * alignment.wall_share) +
         formatted("ground           %.0f m2\n", alignment.ground_area) +
         formatted("residual         %.4f m RMSE of the walls\n", alignment.wall_residual);
}

std::string as_text(const CloudAlignment& alignment) {
  return formatted("overlap          %.1f %% of the cloud, %.1f %% of the reference\n",
                   100.0 * alignment.overlap, 100.0 * alignment.reference_overlap) +
         formatted("agreement        %.1f %% of what both have seen\n", 100.0 * alignment.agreement) +
         formatted("residual         %.4f m RMSE of %.0f patches\n", alignment.rmse, alignment.patches);
}

}  // namespace ray::tools
