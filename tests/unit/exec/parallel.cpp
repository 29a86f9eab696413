#include <raycloud/core/error.h>
#include <raycloud/exec/parallel.h>
#include <raycloud/exec/progress.h>

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <atomic>
#include <cstring>
#include <utility>

namespace ray {
namespace {

constexpr unsigned kThreadCounts[] = {1, 2, 3, 8};

TEST(ParallelFor, CallsEveryIndexOnceInRangesCutAtTheGrain) {
  for (const unsigned threads : kThreadCounts) {
    std::vector<std::atomic<int>> calls(1003);
    parallel_for({.threads = threads}, calls.size(), 10, [&](std::size_t begin, std::size_t end) {
      EXPECT_EQ(begin % 10, 0U);
      EXPECT_LE(end - begin, 10U);
      for (std::size_t i = begin; i < end; ++i)
        ++calls[i];
    });
    for (const auto& count : calls)
      ASSERT_EQ(count, 1);
  }
}

RC_GTEST_PROP(ParallelReduce, FloatingPointSumHasTheSameBitsForEveryThreadCount, ()) {
  const auto values = *rc::gen::container<std::vector<double>>(rc::gen::arbitrary<double>());
  const auto sum = [&](unsigned threads) {
    return parallel_reduce(
        Context{.threads = threads}, values.size(), 3, 0.0,
        [&](std::size_t begin, std::size_t end) {
          double part = 0.0;
          for (std::size_t i = begin; i < end; ++i)
            part += values[i];
          return part;
        },
        [](double a, double b) { return a + b; });
  };
  const double expected = sum(1);
  for (const unsigned threads : kThreadCounts) {
    const double got = sum(threads);
    RC_ASSERT(std::memcmp(&got, &expected, sizeof got) == 0);
  }
}

TEST(ParallelSort, IsAStableSortOnEveryThreadCount) {
  for (const std::size_t count : {0UL, 1UL, 1000UL, 32768UL, 32769UL, 200003UL}) {
    std::vector<std::pair<int, std::size_t>> values(count);
    for (std::size_t i = 0; i < count; ++i)
      values[i] = {static_cast<int>((i * 7919) % 101), i};
    auto expected = values;
    const auto by_first = [](const auto& a, const auto& b) { return a.first < b.first; };
    std::stable_sort(expected.begin(), expected.end(), by_first);
    for (const unsigned threads : kThreadCounts) {
      auto sorted = values;
      parallel_sort({.threads = threads}, sorted.begin(), sorted.end(), by_first);
      ASSERT_EQ(sorted, expected) << count << " values, " << threads << " threads";
    }
  }
}

TEST(Pipeline, OrderedStagesSeeEveryItemInOrder) {
  for (const unsigned threads : kThreadCounts) {
    const Context context{.threads = threads};
    std::vector<int> slots(pipeline_slots(context));
    int next = 0;
    std::vector<int> written;
    pipeline(context, slots.size(),
             [&](std::size_t slot) {
               slots[slot] = next++;
               return next <= 500;
             },
             {{PipelineStage::Mode::parallel, [&](std::size_t slot) { slots[slot] *= 2; }},
              {PipelineStage::Mode::ordered, [&](std::size_t slot) { written.push_back(slots[slot]); }}});
    ASSERT_EQ(written.size(), 500U);
    for (int i = 0; i < 500; ++i)
      ASSERT_EQ(written[static_cast<std::size_t>(i)], 2 * i);
  }
}

TEST(Pipeline, AnErrorInAnyStageComesOut) {
  for (const unsigned threads : kThreadCounts) {
    for (const PipelineStage::Mode failing : {PipelineStage::Mode::parallel, PipelineStage::Mode::ordered}) {
      int next = 0;
      const auto fail = [](std::size_t) { throw Error(ErrorCode::no_data, "planted"); };
      std::vector<PipelineStage> stages{{failing, fail}, {PipelineStage::Mode::ordered, [](std::size_t) {}}};
      EXPECT_THROW(pipeline(
                       {.threads = threads}, 4, [&](std::size_t) { return ++next < 100; }, stages),
                   Error);
    }
  }
}

class StopsAfter final : public Progress {
 public:
  explicit StopsAfter(int polls) : polls_(polls) {}
  [[nodiscard]] bool cancelled() const override { return --polls_ < 0; }

 private:
  mutable std::atomic<int> polls_;
};

TEST(Cancellation, StopsEveryVerbWithTheCodeCancelled) {
  const auto expect_cancelled = [](const auto& run) {
    try {
      run();
      FAIL() << "went on";
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::cancelled);
    }
  };
  for (const unsigned threads : kThreadCounts) {
    StopsAfter a(5);
    expect_cancelled(
        [&] { parallel_for({.threads = threads, .progress = &a}, 100, 1, [](std::size_t, std::size_t) {}); });
    StopsAfter b(5);
    expect_cancelled([&] {
      pipeline({.threads = threads, .progress = &b}, 4, [](std::size_t) { return true; },
               {{PipelineStage::Mode::ordered, [](std::size_t) {}}});
    });
  }
}

}  // namespace
}  // namespace ray
