#include "steps/steps.h"

int main(int argc, char** argv) {
  return ray::tools::step_main<ray::tools::kTransientsStep>(argc, argv);
}
