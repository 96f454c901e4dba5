#include "catchlight/util/bounded_queue.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace catchlight {
namespace {

constexpr int kItems = 200, kNone = -1;

/// Numbers from 0 on through three steps on threads of their own. The step `failing` fails at the item `at`.
struct Chain {
  explicit Chain(std::size_t length) : first(length), second(length), third(length) {}

  void fail(int step, int item) const {
    if (step == failing && item == at) throw std::runtime_error("step " + std::to_string(step));
    if (step == failing_later && item == later) throw std::runtime_error("step " + std::to_string(step) + " later");
  }

  void run() {
    const std::jthread one([&] {
      fill(first, [&, i = 0]() mutable -> std::optional<int> {
        if (i == kItems) return std::nullopt;
        fail(0, i);
        begun = i;
        return i++;
      });
    });
    const std::jthread two([&] { pass_on(first, second, [&](int& item) { return fail(1, item), true; }); });
    const std::jthread three([&] { pass_on(second, third, [&](int& item) { return fail(2, item), true; }); });
    drain(third, [&](int item) {
      fail(3, item);
      taken.push_back(item);
    });
  }

  BoundedQueue<int> first, second, third;
  int failing = kNone, at = kNone, failing_later = kNone, later = kNone;
  std::atomic<int> begun = 0;
  std::vector<int> taken;
};

class Lengths : public ::testing::TestWithParam<std::size_t> {};

TEST_P(Lengths, EveryItemComesOutOnceAndInOrder) {
  Chain chain(GetParam());
  chain.run();
  ASSERT_EQ(chain.taken.size(), static_cast<std::size_t>(kItems));
  for (int i = 0; i < kItems; ++i) EXPECT_EQ(chain.taken[static_cast<std::size_t>(i)], i);
}

/// As on one thread: the items before the failure are done, those behind it are not.
TEST_P(Lengths, AFailureOfAnyStepComesBehindTheItemsBeforeIt) {
  for (int step = 0; step < 4; ++step) {
    Chain chain(GetParam());
    chain.failing = step, chain.at = 50;
    try {
      chain.run();
      ADD_FAILURE() << "nothing was thrown by step " << step;
    } catch (const std::runtime_error& error) {
      EXPECT_EQ(error.what(), "step " + std::to_string(step));
    }
    EXPECT_EQ(chain.taken.size(), 50u) << step;
  }
}

/// An early step fails at an item that a loop on one thread would never have come to.
TEST_P(Lengths, TheEarliestItemsFailureIsTheOneThatComesOut) {
  Chain chain(GetParam());
  chain.failing_later = 0, chain.later = 51;
  chain.failing = 2, chain.at = 50;
  EXPECT_THROW(
      {
        try {
          chain.run();
        } catch (const std::runtime_error& error) {
          EXPECT_STREQ(error.what(), "step 2");
          throw;
        }
      },
      std::runtime_error);
  EXPECT_EQ(chain.taken.size(), 50u);
}

/// In each of the three queues and in each of the four hands there may be so many, and no more.
TEST_P(Lengths, NoStepRunsAheadOfTheLast) {
  Chain chain(GetParam());
  chain.failing = 3, chain.at = 100;
  EXPECT_THROW(chain.run(), std::runtime_error);
  EXPECT_LE(chain.begun, 100 + 3 * static_cast<int>(GetParam()) + 4);
}

INSTANTIATE_TEST_SUITE_P(BoundedQueue, Lengths, ::testing::Values(1, 2, 7, 1000),
                         [](const auto& test) { return "of" + std::to_string(test.param); });

TEST(BoundedQueue, AClosedOneTakesNoMoreAndLetsGoOfWhatItHolds) {
  BoundedQueue<std::shared_ptr<int>> queue(2);
  const auto item = std::make_shared<int>(1);
  EXPECT_TRUE(queue.push(item));
  queue.close();
  EXPECT_FALSE(queue.push(item));
  EXPECT_EQ(item.use_count(), 1);
}

TEST(BoundedQueue, WorkThatKeepsAnItemBackHandsOnTheOthers) {
  BoundedQueue<int> from(kItems), to(kItems);
  for (int i = 0; i < 10; ++i) from.push(i);
  from.end();
  pass_on(from, to, [](int item) { return item % 3 == 0; });
  std::vector<int> taken;
  drain(to, [&](int item) { taken.push_back(item); });
  EXPECT_EQ(taken, (std::vector{0, 3, 6, 9}));
}

/// An item of live footage is the newest when it is made: none is made while another waits.
TEST(BoundedQueue, AnItemIsMadeOnceThereIsRoom) {
  BoundedQueue<int> queue(1);
  std::atomic<int> taken = 0, made = 0;
  const std::jthread making([&] {
    fill(queue, [&]() -> std::optional<int> {
      if (made == kItems) return std::nullopt;
      EXPECT_LE(made, taken + 1) << "one was taken, or is being taken, for each but the one that waits";
      return made++;
    });
  });
  drain(queue, [&](int item) {
    EXPECT_EQ(item, taken);
    ++taken;
  });
  EXPECT_EQ(taken, kItems);
}

}  // namespace
}  // namespace catchlight
