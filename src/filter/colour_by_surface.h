#pragma once
/// Colours and shades that depend on the surface around each point.

#include <raycloud/filter/colour.h>

#include <functional>
#include <type_traits>

namespace ray {

template <class Rule>
concept ColouredBySurface = std::is_same_v<Rule, ColourByShape> || std::is_same_v<Rule, ColourByNormal> ||
    std::is_same_v<Rule, ColourByBranches>;

/// Colours by the surface where the rule is one of those, by `paint(rays)` elsewhere, and then shades.
StreamCounts colour_by_surface(const Context& context, RaySource& source, RaySink& sink,
                               const Colouring& colouring, Shading shading,
                               const std::function<void(RayCloud&)>& paint);

}  // namespace ray
