#include "building.h"

namespace ray::building {
namespace {

constexpr double kRiser = kStorey / 2 / kRisers;
constexpr double kRail = 0.9;  // m above the noses of the steps

// Goes up from `south` to north, or back if `direction` is -1; treads begin at height `base`.
Mesh flight(double middle, double start, double direction, double base) {
  MeshBuilder builder;
  for (int i = 0; i + 1 < kRisers; ++i) {
    const double top = base + (i + 1) * kRiser;
    const double near = start + direction * i * kGoing;
    const double far = start + direction * (i + 1) * kGoing;
    builder.box({middle - kFlightWidth / 2, std::min(near, far), top - 0.25},
                {middle + kFlightWidth / 2, std::max(near, far), top});
  }
  return builder.take();
}

// An inclined bar on posts along x = `side`.
Mesh rail(double side, double start, double direction, double base) {
  constexpr double kHalf = 0.02;
  const double length = (kRisers - 1) * kGoing;
  const double rise = (kRisers - 1) * kRiser;
  const double end = start + direction * length;
  const double south = std::min(start, end);
  const double north = std::max(start, end);
  const double south_height = base + kRail + kRiser + (direction > 0 ? 0.0 : rise);
  const double north_height = base + kRail + kRiser + (direction > 0 ? rise : 0.0);
  MeshBuilder builder;
  const double west = side - kHalf;
  const double east = side + kHalf;
  builder.hexahedron({Eigen::Vector3d{west, south, south_height},
                      {east, south, south_height},
                      {east, north, north_height},
                      {west, north, north_height},
                      {west, south, south_height + 0.05},
                      {east, south, south_height + 0.05},
                      {east, north, north_height + 0.05},
                      {west, north, north_height + 0.05}});
  for (int i = 0; i + 1 < kRisers; ++i) {
    const double y = start + direction * (i + 0.5) * kGoing;
    const double step = base + (i + 1) * kRiser;
    builder.tube({side, y, step}, 0.01, {side, y, step + kRail}, 0.01, 6);
  }
  return builder.take();
}

}  // namespace

void build_staircase(SceneBuilder& scene) {
  for (int floor = 0; floor + 1 < kFloors; ++floor) {
    const double base = floor * kStorey;
    const std::string from = ", floor " + std::to_string(floor);
    scene.add(SceneLabel::stairs, "lower flight" + from, flight(kFlightWest, kFlightSouth, 1, base));
    scene.add(SceneLabel::stairs, "upper flight" + from,
              flight(kFlightEast, kFlightNorth, -1, base + kStorey / 2));
    const Area landing{{kFlightWest - kFlightWidth / 2, kFlightNorth},
                       {kLength / 2 - 0.02, kWidth / 2 - 0.02}};
    scene.add(SceneLabel::stairs, "landing" + from,
              floor_plate(landing, base + kStorey / 2 - 0.25, base + kStorey / 2));
    scene.add(SceneLabel::stairs, "lower rail" + from,
              rail(kFlightWest + kFlightWidth / 2 - 0.04, kFlightSouth, 1, base));
    scene.add(SceneLabel::stairs, "upper rail" + from,
              rail(kFlightEast - kFlightWidth / 2 + 0.04, kFlightNorth, -1, base + kStorey / 2));
  }
  MeshBuilder guard;  // where no flight goes on
  const double top = (kFloors - 1) * kStorey;
  for (const double height : {0.5, 0.95})
    guard.box({kStairsWest + 0.07, kFlightSouth - 0.08, top + height},
              {kFlightEast - kFlightWidth / 2, kFlightSouth - 0.04, top + height + 0.05});
  for (const double x : {kStairsWest + 0.15, kFlightWest, kFlightEast - kFlightWidth / 2 - 0.1})
    guard.tube({x, kFlightSouth - 0.06, top}, 0.02, {x, kFlightSouth - 0.06, top + 0.95}, 0.02, 8);
  scene.add(SceneLabel::stairs, "guard rail", guard.take());
}

}  // namespace ray::building
