#include "steps.h"

#include <array>

namespace ray::tools {

std::span<const Step* const> all_steps() {
  static const std::array kSteps{&kDecimateStep, &kDenoiseStep,   &kTransientsStep, &kSmoothStep,
                                 &kSplitStep,    &kTranslateStep, &kRotateStep,     &kColourStep};
  return kSteps;
}

}  // namespace ray::tools
