// Threads that wait for work, so that a loop of a few hundred microseconds does not have to start its own.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <functional>
#include <list>
#include <mutex>
#include <thread>
#include <vector>

namespace catchlight {

class WorkerPool {
 public:
  /// The process's pool.
  static WorkerPool& shared();

  WorkerPool() = default;
  ~WorkerPool();
  WorkerPool(const WorkerPool&) = delete;
  WorkerPool& operator=(const WorkerPool&) = delete;

  /// Calls work(true) on the calling thread, and work(false) on each of up to `helpers` others that are free before the caller is
  /// done. Returns once all calls have. May be called from several threads at once, and from within work. `work` must not throw.
  void run(std::size_t helpers, const std::function<void(bool is_caller)>& work);

 private:
  struct Job {
    const std::function<void(bool)>* work;
    std::size_t wanted;       ///< workers that may still join
    std::size_t running = 0;  ///< workers that have joined and not ended
  };

  void serve();

  std::mutex mutex_;
  std::condition_variable job_waits_, worker_is_done_;
  std::list<Job*> jobs_;
  std::vector<std::thread> workers_;
  bool is_ending_ = false;
};

}  // namespace catchlight
