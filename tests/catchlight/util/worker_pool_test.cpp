#include "catchlight/util/worker_pool.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <latch>
#include <set>
#include <stdexcept>

#include "catchlight/util/parallel.hpp"

namespace catchlight {
namespace {

TEST(WorkerPool, CallsTheCallerAndWorkers) {
  WorkerPool pool;
  std::latch all_here(3);  // three threads must be at work at once for any to go on
  std::atomic<int> callers{0}, workers{0};
  pool.run(2, [&](bool is_caller) {
    ++(is_caller ? callers : workers);
    all_here.arrive_and_wait();
  });
  EXPECT_EQ(callers, 1);
  EXPECT_EQ(workers, 2);
}

TEST(WorkerPool, KeepsItsThreads) {
  WorkerPool pool;
  std::set<std::thread::id> seen;
  for (int i = 0; i < 20; ++i) {
    std::latch both_here(2);
    std::mutex mutex;
    pool.run(1, [&](bool is_caller) {
      both_here.arrive_and_wait();
      const std::lock_guard lock(mutex);
      if (!is_caller) seen.insert(std::this_thread::get_id());
    });
  }
  EXPECT_EQ(seen.size(), 1u);
}

TEST(WorkerPool, DoesNotWaitForWorkersThatAreBusy) {
  WorkerPool pool;
  std::latch busy(2), done(1);
  std::thread other([&] {
    pool.run(1, [&](bool) {
      busy.count_down();
      done.wait();
    });
  });
  busy.wait();  // the only worker is taken
  int calls = 0;
  pool.run(1, [&](bool) { ++calls; });
  EXPECT_EQ(calls, 1);
  done.count_down();
  other.join();
}

TEST(ParallelFor, VisitsEachOnceFromManyThreadsAndWithin) {
  std::vector<std::atomic<int>> visits(64 * 64);
  std::vector<std::thread> callers;
  for (int caller = 0; caller < 3; ++caller)
    callers.emplace_back(
        [&] { parallel_for(64, 4, [&](std::size_t i) { parallel_for(64, 4, [&](std::size_t j) { ++visits[64 * i + j]; }); }); });
  for (std::thread& caller : callers) caller.join();
  for (const std::atomic<int>& count : visits) ASSERT_EQ(count, 3);
}

TEST(ParallelFor, ThrowsWhatAnyThreadThrew) {
  const auto throws_late = [](std::size_t i) {
    if (i == 900) throw std::runtime_error("the 900th");
  };
  EXPECT_THROW(parallel_for(1000, 4, throws_late), std::runtime_error);
  int calls = 0;
  parallel_for(0, 4, [&](std::size_t) { ++calls; });
  EXPECT_EQ(calls, 0);
}

}  // namespace
}  // namespace catchlight
