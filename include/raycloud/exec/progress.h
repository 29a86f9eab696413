#pragma once
/// Progress and cancellation travel together: whoever runs an algorithm passes one Progress, the algorithm
/// reports to it and asks it whether to go on.

#include <cstdint>
#include <string_view>

namespace ray {

/// Base class that hears nothing and never cancels. Override what is needed; every function may be called
/// from any thread, so an override must be thread-safe and quick.
class Progress {
 public:
  virtual ~Progress() = default;
  /// A stage begins: `name` is a verb for the user ("reading"), `total` the expected number of items, 0 if
  /// unknown.
  virtual void begin(std::string_view name, std::uint64_t total);
  /// `count` more items of the current stage are done.
  virtual void advance(std::uint64_t count);
  /// The current stage is complete.
  virtual void end();
  /// True once the user wants to stop. The verbs of exec/parallel.h poll it and throw Error(cancelled).
  [[nodiscard]] virtual bool cancelled() const;
};

}  // namespace ray
