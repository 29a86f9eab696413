#pragma once
/// The steps there are, each in its own file; a command links the one it is.

#include "step.h"

#include <span>

namespace ray::tools {

extern const Step kColourStep;
extern const Step kDecimateStep;
extern const Step kDenoiseStep;
extern const Step kRotateStep;
extern const Step kSmoothStep;
extern const Step kSplitStep;
extern const Step kTransientsStep;
extern const Step kTranslateStep;

/// All of them, for `raycloud pipe` (in steps/all_steps.cpp).
[[nodiscard]] std::span<const Step* const> all_steps();

}  // namespace ray::tools
