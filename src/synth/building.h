#pragma once
/// Measures of the building that its parts share, in m. x runs along the corridor, floor 0 is at z = 0.

#include "indoors.h"

#include <array>
#include <optional>
#include <span>

namespace ray::building {

constexpr int kFloors = 3;
constexpr double kStorey = 3.0;
constexpr double kSlab = 0.25;
constexpr double kLength = 18.0;  // inside
constexpr double kWidth = 11.0;   // inside
constexpr double kOuterWall = 0.3;
constexpr double kGround = -0.15;

constexpr double kStairsWest = 6.0;   // middle of the wall beside the staircase
constexpr double kFlightSouth = 1.6;  // the first riser
constexpr int kRisers = 9;            // of a flight
constexpr double kGoing = 0.28;       // depth of a tread
constexpr double kFlightNorth = kFlightSouth + (kRisers - 1) * kGoing;  // begin of the landing
constexpr double kFlightWidth = 1.3;
constexpr double kFlightWest = 6.1 + kFlightWidth / 2;         // middle of the flight that goes up north
constexpr double kFlightEast = 9.0 - 0.02 - kFlightWidth / 2;  // of the one that comes back

/// Two flights and a landing for every floor but the last, with rails.
void build_staircase(SceneBuilder& scene);

}  // namespace ray::building
