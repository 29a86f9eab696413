#pragma once
/// The table that the benchmarks of whole commands print.

#include "measure.h"

#include <string>

namespace bench {

constexpr int kRuns = 5;

struct Paths {
  std::string bin;
  std::string big;
  std::string work;
  double rays = 0.0;
  [[nodiscard]] std::string command(const std::string& words) const { return "exec " + bin + "/" + words; }
  [[nodiscard]] std::string file(const std::string& name) const { return work + "/" + name; }
};

void heading();
/// One row; `baseline` names what the ratio is of, if there is one.
void row(const char* what, const Result& result, double rays, const char* baseline, const char* bar,
         bool met);

}  // namespace bench
