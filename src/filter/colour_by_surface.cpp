#include "colour_by_surface.h"

#include "surface_points.h"

#include <raycloud/exec/fresh_memory.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace ray {
namespace {

/// What the neighbourhood says about a ray. The shade is in parts of kFullShade.
struct SurfaceColour {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;
  std::uint8_t shade = 0;
};

/// The colour stays: that of flat level ground. Ridges are brighter.
constexpr double kFullShade = 160.0;

std::uint8_t byte_of(double fraction) {
  return static_cast<std::uint8_t>(255.0 * std::clamp(fraction, 0.0, 1.0) + 0.5);
}

/// Which neighbours a rule looks at, and the colour of what they are.
struct SurfaceRule {
  SurfelRule surfel;
  SurfaceColour (*colour)(const Surfel&) = nullptr;  // null: another rule colours
};

SurfaceColour by_shape(const Surfel& surfel) {
  // Too few to be anything, or all in one place: equal parts of everything.
  if (surfel.count <= 3 || !(surfel.variances[2] > 0.0)) return {85, 85, 85};
  const Shape shape = shape_of(surfel);
  return {byte_of(shape.sphericity), byte_of(shape.cylindricality), byte_of(shape.planarity)};
}

SurfaceColour by_normal(const Surfel& surfel) {
  const Eigen::Vector3d half = (surfel.normal.array() + 1.0) / 2.0;
  return {byte_of(half.x()), byte_of(half.y()), byte_of(half.z())};
}

SurfaceColour by_branches(const Surfel& surfel) {
  constexpr double kGrey = 0.2;
  constexpr double kNone = 0.4, kFull = 0.75;  // neighbours on a plane have 0.2 by chance
  if (surfel.count <= 3) return {byte_of(kGrey), byte_of(kGrey), byte_of(kGrey)};
  const double part = std::clamp((shape_of(surfel).cylindricality - kNone) / (kFull - kNone), 0.0, 1.0);
  const Colour hue = hue_colour(surfel.axis.z() * surfel.axis.z() / 3.0);
  const auto mixed = [&](std::uint8_t channel) {
    return byte_of(kGrey + part * (static_cast<double>(channel) / 255.0 - kGrey));
  };
  return {mixed(hue.red), mixed(hue.green), mixed(hue.blue)};
}

/// The surface that is lit is the one that was seen.
constexpr SurfelRule kLitSurfel{.neighbours = 16, .by_side = true, .past_rings = true};

SurfaceRule rule_of(const Colouring& colouring) {
  if (std::holds_alternative<ColourByShape>(colouring)) return {{.neighbours = 20}, by_shape};
  if (std::holds_alternative<ColourByNormal>(colouring)) return {kLitSurfel, by_normal};
  // A branch is round: what was seen of it from all sides counts.
  if (std::holds_alternative<ColourByBranches>(colouring))
    return {{.neighbours = 16, .by_side = false}, by_branches};
  return {};
}

/// How much the normals of the neighbours part: the mean of their components away from the point, above 0
/// where the surface is a ridge, below 0 in a hollow.
double ridge_at(const PointTree& tree, std::span<const PackedDirection> normals, std::size_t place,
                std::span<const Neighbour> neighbours) {
  const Eigen::Vector3d own = unpack_direction(normals[place]);
  std::int64_t sum = 0;  // in fixed point, which does not depend on the order of the terms
  for (const Neighbour& neighbour : neighbours) {
    if (!(neighbour.distance2 > 0.0)) continue;
    const Eigen::Vector3d away = tree.point(neighbour.place) - tree.point(place);
    const Eigen::Vector3d change = unpack_direction(normals[neighbour.place]) - own;
    sum += static_cast<std::int64_t>(change.dot(away) / std::sqrt(neighbour.distance2) * 0x1p32);
  }
  return neighbours.empty() ? 0.0
                            : static_cast<double>(sum) * 0x1p-32 / static_cast<double>(neighbours.size());
}

std::uint8_t shade_of(const Eigen::Vector3d& normal, double ridge) {
  const Eigen::Vector3d to_light(0.36, -0.48, 0.8);  // the front, the right, above
  constexpr double kFill = 0.5;
  constexpr double kRelief = 1.0;
  // Softly: dark only where it is opposite, and not black there.
  const auto light = [&](double facing) { return kFill + (1.0 - kFill) * (1.0 + facing) / 2.0; };
  const double relief = std::clamp(1.0 + kRelief * ridge, 0.5, 1.5);
  const double part = light(normal.dot(to_light)) / light(to_light.z()) * relief;
  return static_cast<std::uint8_t>(std::min(kFullShade * part + 0.5, 255.0));
}

std::vector<SurfaceColour> colour_block(const Context& context, Block<SeenPoint>&& block, double reach,
                                        const SurfaceRule& rule, Shading shading) {
  const PointTree tree(context, block.records);
  block.records = std::vector<SeenPoint>();
  const bool lit = shading == Shading::lit;
  const double neighbour_reach = lit ? reach / 2.0 : reach;
  const auto within_reach = [&](SurfelRule surfel_rule) {
    surfel_rule.reach = neighbour_reach;
    return surfel_rule;
  };
  const SurfelRule own_rule = within_reach(rule.surfel), lit_rule = within_reach(kLitSurfel);
  std::vector<SurfaceColour> colours(tree.size());
  std::vector<PackedDirection> normals(lit ? tree.size() : 0);
  const auto lit_neighbours = [&](NeighbourSearch& search, std::size_t place) {
    return search.nearest_facing(place, kLitSurfel.neighbours, neighbour_reach,
                                 unpack_direction(normals[place]));
  };
  NeededPlaces(block, tree)
      .work_on(
          context, lit ? 1 : 0,
          [&](NeighbourSearch& search, std::size_t begin, std::size_t end, const auto& wanted) {
            const auto is_coloured = [&](std::size_t place) {
              return wanted(place) && block.is_own(tree.index(place));
            };
            if (rule.colour != nullptr)
              SurfelFinder(search, own_rule).for_each(begin, end, is_coloured, [&](const SurfelOf& found) {
                colours[tree.index(found.place)] = rule.colour(found.surfel);
              });
            if (lit)
              SurfelFinder(search, lit_rule).for_each(begin, end, wanted, [&](const SurfelOf& found) {
                normals[found.place] = pack_direction(found.surfel.normal);
              });
          },
          {.radius = [&](std::size_t) { return neighbour_reach; },
           .neighbours =
               [&](NeighbourSearch& search, std::size_t place) {
                 return search.places_facing(place, kLitSurfel.neighbours, neighbour_reach,
                                             unpack_direction(normals[place]));
               }});
  if (!lit) return colours;
  for_each_place(context, tree, [&](NeighbourSearch& search, std::size_t begin, std::size_t end) {
    for (std::size_t place = begin; place < end; ++place) {
      if (!block.is_own(tree.index(place))) continue;
      const Eigen::Vector3d normal = unpack_direction(normals[place]);
      const auto neighbours = lit_neighbours(search, place);
      colours[tree.index(place)].shade = shade_of(normal, ridge_at(tree, normals, place, neighbours));
    }
  });
  return colours;
}

void shade_colour(Colour& colour, std::uint8_t shade) {
  for (std::uint8_t* channel : {&colour.red, &colour.green, &colour.blue})
    *channel = static_cast<std::uint8_t>(std::min(*channel * shade / kFullShade + 0.5, 255.0));
}

}  // namespace

StreamCounts colour_by_surface(const Context& context, RaySource& source, RaySink& sink,
                               const Colouring& colouring, Shading shading,
                               const std::function<void(RayCloud&)>& paint) {
  const SurfaceRule rule = rule_of(colouring);
  const bool lit = shading == Shading::lit;
  // The shade depends on the normals of the neighbours, which depend on their neighbours.
  const BlockNeeds needs{.bytes_per_record = 90, .reach = [&](const EndSample& sample) {
                           return (lit ? 2.0 : 1.0) * neighbour_reach(sample);
                         }};
  const auto compute = [&](const Context& with, Block<SeenPoint>&& block, double reach) {
    return colour_block(with, std::move(block), reach, rule, shading);
  };
  const auto apply = [&](RayCloud& rays, std::span<const SurfaceColour> colours) {
    const std::vector<std::uint8_t> bounded = rays.bounded;  // before `paint` may change it
    if (rule.colour == nullptr) paint(rays);
    std::size_t next = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      Colour& colour = rays.colours[i];
      const SurfaceColour seen = bounded[i] != 0 ? colours[next++] : SurfaceColour{};
      if (rule.colour != nullptr) colour = {seen.red, seen.green, seen.blue, colour.intensity};
      if (lit && bounded[i] != 0) shade_colour(colour, seen.shade);
    }
  };
  return run_blocks<SeenPoint, SurfaceColour>(context, source, sink, needs, seen_point, compute, apply);
}

}  // namespace ray
