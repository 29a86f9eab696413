#pragma once
/// Of the loops of point_sieve.h, those that gain by sixteen lanes.

#include "point_sieve.h"

#include <raycloud/core/lanes.h>

#ifdef RAY_HAS_LANES
namespace ray::avx512 {

void sieve_box(const SieveSource& source, const SieveBox& box, SievePoints& points);
[[nodiscard]] bool sieve_sphere(const SievePoints& points, const SieveSphere& sphere, SievedPoints& near);
[[nodiscard]] std::size_t sieve_count(const SievedPoints& near, float distance2);
void sieve_further(SievedPoints& near, float distance2);

}  // namespace ray::avx512
#endif
