#pragma once
/// Lengths, durations and angles that cannot be mistaken for each other. Inside, everything is SI (metres,
/// seconds, radians); "cm" exists only in literals and in the grammar of the commands.

#include <compare>
#include <numbers>

namespace ray {

/// A number with a unit. `value` is in the unit the alias below names.
template <class Unit>
struct Quantity {
  double value = 0.0;
  friend constexpr auto operator<=>(Quantity, Quantity) = default;
};

using Metres = Quantity<struct MetreUnit>;
using Seconds = Quantity<struct SecondUnit>;
using Radians = Quantity<struct RadianUnit>;

/// `using namespace ray::literals;` gives `4_cm`, `0.5_m`, `90_deg`, `1.5_s`.
namespace literals {
constexpr Metres operator""_m(long double v) {
  return {static_cast<double>(v)};
}
constexpr Metres operator""_m(unsigned long long v) {
  return {static_cast<double>(v)};
}
constexpr Metres operator""_cm(long double v) {
  return {static_cast<double>(v) / 100.0};
}
constexpr Metres operator""_cm(unsigned long long v) {
  return {static_cast<double>(v) / 100.0};
}
constexpr Seconds operator""_s(long double v) {
  return {static_cast<double>(v)};
}
constexpr Seconds operator""_s(unsigned long long v) {
  return {static_cast<double>(v)};
}
constexpr Radians operator""_deg(long double v) {
  return {static_cast<double>(v) * std::numbers::pi / 180.0};
}
constexpr Radians operator""_deg(unsigned long long v) {
  return {static_cast<double>(v) * std::numbers::pi / 180.0};
}
}  // namespace literals

}  // namespace ray
