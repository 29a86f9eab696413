#include "alignment_report.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>

namespace ray::tools {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

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

std::string three(const Eigen::Vector3d& values, const char* unit) {
  constexpr double kLeast = 5e-7;
  return formatted("%.6f,%.6f,%.6f %s", shown(values.x(), kLeast), shown(values.y(), kLeast),
                   shown(values.z(), kLeast), unit);
}

}  // namespace

Found found(const AxesAlignment& alignment) {
  Found result{alignment.pose, {}, {}, {}};
  result.report = formatted("walls            %.0f m2 along the axes, %.0f %% of what is upright\n",
                            alignment.wall_area, 100.0 * alignment.wall_share) +
                  formatted("ground           %.0f m2\n", alignment.ground_area) +
                  formatted("residual         %.4f m RMSE of the walls\n", alignment.wall_residual);
  result.notes = {{"wall_residual", formatted("%.6f  # m", alignment.wall_residual)}};
  return result;
}

Found found(const CloudAlignment& alignment, bool nonrigid) {
  Found result{alignment.pose, alignment.bend, {}, {}};
  const Eigen::Vector<double, 6> sigmas = alignment.covariance.diagonal().cwiseSqrt();
  const Eigen::Vector3d turns = kDegrees * sigmas.head<3>(), shifts = sigmas.tail<3>();
  result.report =
      formatted("overlap          %.1f %% of the cloud, %.1f %% of the reference\n",
                100.0 * alignment.overlap, 100.0 * alignment.reference_overlap) +
      formatted("agreement        %.1f %% of what both have seen\n", 100.0 * alignment.agreement) +
      formatted("residual         %.4f m RMSE of %.0f patches\n", alignment.rmse, alignment.patches) +
      formatted("standard error   %.4f,%.4f,%.4f degrees, %.4f,%.4f,%.4f m\n", turns.x(), turns.y(),
                turns.z(), shifts.x(), shifts.y(), shifts.z());
  if (nonrigid)
    result.report += alignment.bend.is_none()
                         ? std::string("bend             none: rigid is as good\n")
                         : formatted("bend             %.4f m at most, criterion better by %.0f\n",
                                     alignment.bend_size, alignment.bend_gain);
  result.notes = {{"overlap", formatted("%.4f", alignment.overlap)},
                  {"reference_overlap", formatted("%.4f", alignment.reference_overlap)},
                  {"agreement", formatted("%.4f", alignment.agreement)},
                  {"rmse", formatted("%.6f  # m", alignment.rmse)},
                  {"centre", formatted("[%.6f, %.6f, %.6f]  # m, about which the turns of the covariance are",
                                       alignment.centre.x(), alignment.centre.y(), alignment.centre.z())},
                  {"covariance", "  # of turns about x, y, z (rad), and shifts (m)"}};
  for (Eigen::Index row = 0; row < 6; ++row) {
    std::string& text = result.notes.back().second;
    for (Eigen::Index column = 0; column < 6; ++column)
      text += formatted("%s%.4g", column == 0 ? "\n  - [" : ", ", alignment.covariance(row, column));
    text += "]";
  }
  return result;
}

std::string as_text(const Found& found) {
  std::string text = "matrix\n";
  constexpr double kLeast = 5e-11;
  for (Eigen::Index row = 0; row < 3; ++row) {
    const auto r = found.pose.rotation.row(row);
    text += formatted("  %13.10f %13.10f %13.10f %16.6f\n", shown(r[0], kLeast), shown(r[1], kLeast),
                      shown(r[2], kLeast), shown(found.pose.translation[row], 5e-7));
  }
  text += formatted("  %13.10f %13.10f %13.10f %16.6f\n", 0.0, 0.0, 0.0, 1.0);
  text += "rotation vector  " + three(rotation_vector_deg(found.pose), "degrees") + "\n";
  text += "translation      " + three(found.pose.translation, "m") + "\n";
  return text + found.report;
}

}  // namespace ray::tools
