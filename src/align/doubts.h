#pragma once
/// Which pose is the best, and why it is not to be trusted.

#include "rest.h"

#include <string>
#include <vector>

namespace ray::align {

/// The one with the best score, unless narrow patches are clearly for another that scores nearly as much.
[[nodiscard]] Hypothesis best_of(const Case& of, const std::vector<Hypothesis>& judged);

/// Empty if it is to be trusted.
struct Doubt {
  std::string text;
  bool is_elsewhere = false;  ///< another place is as good
};

/// Of the best of those that were judged.
[[nodiscard]] Doubt doubt_of(const Case& of, const std::vector<Hypothesis>& judged, const Hypothesis& best);

/// By more than a standard error, if cells are independent of each other. Of right poses 89 % and more of the
/// patches agree, where leaves, people and vehicles have come and gone.
[[nodiscard]] bool agrees_too_little(const Hypothesis& best, double agreement);

/// As it is told: "12 %".
[[nodiscard]] std::string percent(double share_of_one);

}  // namespace ray::align
