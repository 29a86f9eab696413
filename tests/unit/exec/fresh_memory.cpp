#include <raycloud/exec/fresh_memory.h>

#include <gtest/gtest.h>

#include <algorithm>
#include <string>

namespace ray {
namespace {

TEST(TouchedVector, HasItsElements) {
  for (const std::size_t count : {0U, 1U, 1000U, 5'000'000U}) {
    const std::vector<int> numbers = touched_vector<int>({}, count);
    ASSERT_EQ(numbers.size(), count);
    EXPECT_TRUE(std::all_of(numbers.begin(), numbers.end(), [](int number) { return number == 0; }));
  }
  EXPECT_EQ(touched_vector<std::string>({}, 3), std::vector<std::string>(3));
}

TEST(ReserveTouched, HasRoom) {
  std::vector<int> numbers;
  for (const std::size_t count : {0U, 5U, 5'000'000U, 3U}) {
    reserve_touched({}, numbers, count);
    EXPECT_TRUE(numbers.empty());
    EXPECT_GE(numbers.capacity(), count);
  }
}

}  // namespace
}  // namespace ray
