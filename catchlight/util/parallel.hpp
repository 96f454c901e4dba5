// Data-parallel loops whose results do not depend on the number of threads.
#pragma once

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>

#include "catchlight/progress.hpp"
#include "catchlight/util/worker_pool.hpp"

namespace catchlight {

/// Calls work(i) once for each i < count from `threads` threads (0: one a core), the calling one among them. work must write only
/// what belongs to i. Progress is told on the calling thread; the first exception of any thread is thrown there once all have
/// stopped.
template <typename Work>
void parallel_for(std::size_t count, int threads, const Work& work, const ProgressHandler& progress = {}) {
  std::atomic<std::size_t> next{0}, done{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto run = [&](bool tells) {
    try {
      for (std::size_t i; (i = next.fetch_add(1)) < count;) {
        work(i);
        const std::size_t finished = done.fetch_add(1) + 1;
        if (tells && progress) progress(static_cast<double>(finished) / static_cast<double>(count));
      }
    } catch (...) {
      next = count;
      const std::lock_guard lock(failure_mutex);
      if (!failure) failure = std::current_exception();
    }
  };
  const std::size_t wanted = threads > 0 ? threads : std::max(1u, std::thread::hardware_concurrency());
  WorkerPool::shared().run(std::max<std::size_t>(std::min(wanted, count), 1) - 1, run);
  if (failure) std::rethrow_exception(failure);
  if (progress) progress(1.0);
}

}  // namespace catchlight
