#include "catchlight/util/worker_pool.hpp"

namespace catchlight {

WorkerPool& WorkerPool::shared() {
  static WorkerPool pool;
  return pool;
}

WorkerPool::~WorkerPool() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  job_waits_.notify_all();
  for (std::thread& worker : workers_) worker.join();
}

void WorkerPool::run(std::size_t helpers, const std::function<void(bool)>& work) {
  if (helpers == 0) return work(true);
  Job job{&work, helpers};
  {
    const std::lock_guard lock(mutex_);
    while (workers_.size() < helpers) workers_.emplace_back([this] { serve(); });
    jobs_.push_back(&job);
  }
  for (std::size_t i = 0; i < helpers; ++i) job_waits_.notify_one();
  work(true);
  std::unique_lock lock(mutex_);
  if (job.wanted > 0) jobs_.remove(&job);
  worker_is_done_.wait(lock, [&] { return job.running == 0; });
}

void WorkerPool::serve() {
  std::unique_lock lock(mutex_);
  while (true) {
    job_waits_.wait(lock, [&] { return is_ending_ || !jobs_.empty(); });
    if (is_ending_) return;
    Job& job = *jobs_.front();
    if (--job.wanted == 0) jobs_.pop_front();
    ++job.running;
    lock.unlock();
    (*job.work)(false);
    lock.lock();
    if (--job.running == 0) worker_is_done_.notify_all();
  }
}

}  // namespace catchlight
