#include "search.h"

#include "ground.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace ray::align {
namespace {

/// Adds what comes of the poses beside one to others, the best first.
void add_aside(const Context& context, const Known& cloud, const Known& reference, const Jury& jury,
               const Pose& pose, std::vector<Hypothesis>& all) {
  const std::vector<Hypothesis> aside =
      fitted(context, cloud, reference, jury, aside_of(context, pose, cloud, reference, jury));
  all.insert(all.end(), aside.begin(), aside.end());
  sort_by_score(all);
}

/// The turn about a horizontal axis that brings `up` upright.
Eigen::Matrix3d upright(const Eigen::Vector3d& up) {
  return Eigen::Quaterniond::FromTwoVectors(up, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// The rotation that levels the floors of a cloud, if there are any.
Eigen::Matrix3d level_by_floors(const Known& known) {
  constexpr double kMostTilt = 0.3;  // rad
  return levelling(floor_patches(known.fine, kMostTilt)).value_or(Eigen::Matrix3d::Identity());
}

/// The best `kKept` of a search with these verticals, fitted.
std::vector<Hypothesis> search(const Context& context, const Known& cloud, const Known& reference,
                               const Jury& jury, const Verticals& verticals) {
  constexpr std::size_t kKept = 24;
  std::vector<Hypothesis> found = rough_hypotheses(context, cloud, reference, verticals);
  found.resize(std::min(found.size(), kKept));
  return fitted(context, cloud, reference, jury, std::move(found));
}

/// Whether a pose brings one vertical onto the other.
bool fits_verticals(const Pose& pose, const Verticals& verticals) {
  constexpr double kTilt = 0.02;  // rad
  const Eigen::Vector3d up = pose.rotation * verticals.cloud.transpose() * Eigen::Vector3d::UnitZ();
  return up.dot(verticals.reference.transpose() * Eigen::Vector3d::UnitZ()) > std::cos(kTilt);
}

/// Whether a search with the ones finds what one with the others does.
bool are_alike(const Verticals& a, const Verticals& b) {
  constexpr double kTilt = 0.1;  // rad
  const auto is_like = [](const Eigen::Matrix3d& one, const Eigen::Matrix3d& other) {
    return one.row(2).dot(other.row(2)) > std::cos(kTilt);  // what comes to be up
  };
  return is_like(a.cloud, b.cloud) && is_like(a.reference, b.reference);
}

/// What may be upright in either cloud, together.
std::vector<Verticals> maybe_askew(const Known& cloud, const Known& reference) {
  constexpr std::size_t kMost = 2;
  std::vector<Verticals> askew;
  for (const Eigen::Vector3d& up : maybe_up(cloud.fine, kMost))
    for (const Eigen::Vector3d& reference_up : maybe_up(reference.fine, kMost))
      askew.push_back({upright(up), upright(reference_up)});
  return askew;
}

/// The search turns the cloud about the vertical, and so finds little if one of the clouds is tilted. Where
/// what it found is tilted or refuted, it is made again with the floors of both level, and then as the best
/// tilts them.
void search_tilted(const Context& context, const Known& cloud, const Known& reference, const Jury& jury,
                   std::vector<Hypothesis>& all) {
  std::vector<Verticals> searched{Verticals()};
  const auto is_searched = [&](const Pose& pose) {
    return std::any_of(searched.begin(), searched.end(),
                       [&](const Verticals& one) { return fits_verticals(pose, one); });
  };
  const auto is_found = [&] {
    const Hypothesis& best = all.front();
    return !best.is_idle() && !best.is_refuted() && is_searched(best.pose);
  };
  // A right pose nearly always has more that speaks for it than against.
  const auto is_clear = [&] { return is_found() && all.front().score > 0.0; };
  const auto add = [&](const Verticals& verticals) {
    const std::vector<Hypothesis> more = search(context, cloud, reference, jury, verticals);
    all.insert(all.end(), more.begin(), more.end());
    sort_by_score(all);
    searched.push_back(verticals);
  };
  if (is_clear()) return;
  const Verticals floors{level_by_floors(cloud), level_by_floors(reference)}, none;
  const auto is_upright = [&](const Eigen::Matrix3d& rotation) {
    return fits_verticals({rotation, {}}, none);
  };
  if (!is_upright(floors.cloud) || !is_upright(floors.reference)) add(floors);
  if (!is_found() && !is_searched(all.front().pose))
    add({upright(all.front().pose.rotation.transpose() * Eigen::Vector3d::UnitZ()), none.reference});
  for (const Verticals& askew : maybe_askew(cloud, reference))
    if (!is_clear() && std::none_of(searched.begin(), searched.end(),
                                    [&](const Verticals& one) { return are_alike(askew, one); }))
      add(askew);
}

}  // namespace

std::vector<Hypothesis> judged_poses(const Context& context, const Known& cloud, const Known& reference,
                                     const Jury& jury, bool local) {
  constexpr std::size_t kBeside = 3;
  constexpr int kRounds = 3;
  constexpr double kFarBelow = 20.0;  // cells
  std::vector<Hypothesis> all;
  if (!local) all = search(context, cloud, reference, jury, Verticals());
  const Eigen::Vector3d as_they_are = cloud.surfaces.survey.origin - reference.surfaces.survey.origin;
  const std::vector<Hypothesis> here =
      fitted(context, cloud, reference, jury, {{{Eigen::Matrix3d::Identity(), as_they_are}, {}, {}, 0.0}});
  all.insert(all.end(), here.begin(), here.end());
  sort_by_score(all);
  if (!local) search_tilted(context, cloud, reference, jury, all);
  std::vector<Pose> looked;
  const auto is_looked = [&](const Hypothesis& one) {
    return std::any_of(looked.begin(), looked.end(),
                       [&](const Pose& pose) { return is_same_place(one.pose, pose, cloud); });
  };
  const std::vector<Hypothesis> first = all;
  for (const Hypothesis& one : first)
    if (looked.size() < kBeside && !one.is_idle() && !is_looked(one) &&
        one.score > all.front().score - kFarBelow) {
      looked.push_back(one.pose);
      add_aside(context, cloud, reference, jury, one.pose, all);
    }
  for (int round = 0; round < kRounds && !is_looked(all.front()); ++round) {
    looked.push_back(all.front().pose);
    add_aside(context, cloud, reference, jury, looked.back(), all);
  }
  return all;
}

}  // namespace ray::align
