#pragma once
/// The bricks of consecutive rays, less what is remembered of them.

#include <raycloud/spatial/crossed_cubes.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <new>
#include <utility>

namespace ray {

/// Neighbouring rays cross the same cubes. So a table of what is listed already, or was known before, saves
/// nearly all of the list. It fits into the cache of a core, and may forget.
class BrickList {
 public:
  struct Place {
    BrickNames::Name name;
    std::uint64_t cubes;  // that are listed or known
  };

  /// Brick names count from `known`, if it reaches the brick of the first ray.
  BrickList(const VoxelIndex& first, const KnownBricks* known)
      : names_(first), places_(zeros<Place>()), bricks_(zeros<std::uint32_t>()) {
    if (known == nullptr || !known->has_centre() || known->names().of(first) == BrickNames::kNone) return;
    known_ = known;
    names_ = known->names();
  }

  [[nodiscard]] const BrickNames& names() const { return names_; }
  [[nodiscard]] Place& place(BrickNames::Name name) {
    Place& place = places_[BrickNames::place(name, kLast)];
    if (place.name != name) take(name);
    return place;
  }
  [[nodiscard]] std::size_t size() const { return crossed_.cubes.size(); }

  void add(std::uint32_t ray, const VoxelIndex& brick, BrickNames::Name name, std::uint64_t cubes) {
    Place nameless{};
    Place& known = name == BrickNames::kNone ? nameless : place(name);
    const std::uint64_t fresh = cubes & ~known.cubes;
    if (fresh == 0) return;
    known.cubes |= fresh;
    std::uint32_t none = 0;
    std::uint32_t& which = name == BrickNames::kNone ? none : bricks_[BrickNames::place(name, kLast)];
    if (which == 0) {
      CrossedCubes::Brick& added = crossed_.all.emplace_back();
      added.place = voxel_place(brick);
      added.name = known_ == nullptr ? BrickNames::kNone : name;
      which = static_cast<std::uint32_t>(crossed_.all.size());
    }
    list(ray, which - 1, fresh);
  }

  [[nodiscard]] CrossedCubes take_all() { return std::move(crossed_); }

 private:
  static constexpr std::size_t kLast = (std::size_t{1} << 15) - 1;
  struct Free {
    void operator()(void* table) const { std::free(table); }
  };
  template <class T>
  using Table = std::unique_ptr<T[], Free>;

  /// Of which a few rays touch little.
  template <class T>
  static Table<T> zeros() {
    Table<T> table(static_cast<T*>(std::calloc(kLast + 1, sizeof(T))));
    if (table == nullptr) throw std::bad_alloc();
    return table;
  }

  /// Apart, so that `place` is inlined.
  [[gnu::noinline]] void take(BrickNames::Name name) {
    places_[BrickNames::place(name, kLast)] = {name, known_ == nullptr ? 0 : known_->cubes(name)};
    bricks_[BrickNames::place(name, kLast)] = 0;
  }

  void list(std::uint32_t ray, std::uint32_t which, std::uint64_t cubes) {
    CrossedCubes::Brick& brick = crossed_.all[which];
    brick.cubes |= cubes;
    VoxelKeys& bricks = crossed_.bricks;
    if (bricks.runs.empty() || bricks.runs.back().block != brick.place.block) {
      bricks.runs.push_back({brick.place.block, bricks.keys.size()});
    }
    bricks.keys.push_back(brick.place.key);
    bricks.runs.back().end = bricks.keys.size();
    crossed_.cubes.push_back(cubes);
    crossed_.rays.push_back(ray);
    crossed_.which.push_back(which);
  }

  CrossedCubes crossed_;
  BrickNames names_;
  const KnownBricks* known_ = nullptr;
  Table<Place> places_;
  Table<std::uint32_t> bricks_;  // of each place, its number in `all`, from 1
};

}  // namespace ray
