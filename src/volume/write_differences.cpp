#include <raycloud/core/error.h>
#include <raycloud/volume/compare_clouds.h>

#include <algorithm>
#include <string>

namespace ray {
namespace {

const ColumnInfo kDifferenceColumn{"difference", ScalarType::uint8};

constexpr Colour kOnlyFirst{255, 0, 127, 0}, kOnlySecond{0, 255, 127, 0};
constexpr std::uint8_t kGrey = 128;

/// `share` of `to`, the rest of the colour itself; the intensity stays.
void blend(Colour& colour, const Colour& to, double share) {
  const auto mix = [share](std::uint8_t from, std::uint8_t into) {
    return static_cast<std::uint8_t>((1.0 - share) * from + share * into + 0.5);
  };
  colour.red = mix(colour.red, to.red);
  colour.green = mix(colour.green, to.green);
  colour.blue = mix(colour.blue, to.blue);
}

void colour_difference(Colour& colour, Difference difference, double distance_ratio) {
  constexpr double kFull = 2.0;  // ratio
  const double share = std::min(distance_ratio, kFull) / kFull;
  if (difference == Difference::removed) blend(colour, kOnlyFirst, share);
  if (difference == Difference::added) blend(colour, kOnlySecond, share);
  if (difference == Difference::unobserved) colour = {kGrey, kGrey, kGrey, colour.intensity};
}

}  // namespace

std::vector<ColumnInfo> difference_columns(std::vector<ColumnInfo> source) {
  const auto known = std::find_if(source.begin(), source.end(), [](const ColumnInfo& column) {
    return column.name == kDifferenceColumn.name;
  });
  if (known == source.end())
    source.push_back(kDifferenceColumn);
  else if (known->type != kDifferenceColumn.type)
    throw Error(ErrorCode::wrong_content,
                "the column difference is " + std::string(name_of(known->type)) + ", not uint8");
  return source;
}

StreamCounts write_differences(const Context& context, RaySource& source, const ComparedEnds& ends,
                               double distance, RaySink& sink) {
  std::size_t next = 0;
  const StreamCounts counts = stream(
      context, source, &sink,
      [](RayCloud& rays) {
        if (rays.extra(kDifferenceColumn.name) == nullptr)
          rays.extras.emplace_back(kDifferenceColumn, rays.size());
        return Nothing{};
      },
      [&](RayCloud& rays, Nothing) {
        const auto column = rays.extra(kDifferenceColumn.name)->values<std::uint8_t>();
        for (std::size_t i = 0; i < rays.size(); ++i) {
          Difference difference = Difference::none;
          if (rays.bounded[i] != 0) {
            difference = ends.differences[next];
            colour_difference(rays.colours[i], difference,
                              static_cast<double>(ends.distances[next]) / distance);
            ++next;
          }
          column[i] = static_cast<std::uint8_t>(difference);
        }
      });
  source.rewind();
  return counts;
}

}  // namespace ray
