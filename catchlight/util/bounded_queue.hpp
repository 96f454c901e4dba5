// Hands items from one thread to the next, in order.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <utility>

namespace catchlight {

/// Holds at most `length` items. What went wrong on the giving side comes to the taking side behind the items before it, so that
/// a chain of queues fails as the same steps on one thread would: by the earliest item's failure.
template <class Item>
class BoundedQueue {
 public:
  explicit BoundedQueue(std::size_t length) : length_(length) {}

  /// Waits while the queue is full. False where nobody takes items any more; the item is then lost.
  bool push(Item item) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return items_.size() < length_ || is_closed_; });
    if (is_closed_) return false;
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// As push(), but never waits: false where the queue is full, too.
  bool offer(Item item) {
    const std::lock_guard lock(mutex_);
    if (is_closed_ || items_.size() >= length_) return false;
    items_.push_back(std::move(item));
    changed_.notify_all();
    return true;
  }

  /// Waits while the queue is full. False where nobody takes items any more.
  bool wait_for_room() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return items_.size() < length_ || is_closed_; });
    return !is_closed_;
  }

  /// No more items come, because of `failure` where there is one.
  void end(std::exception_ptr failure = {}) {
    const std::lock_guard lock(mutex_);
    has_ended_ = true;
    failure_ = std::move(failure);
    changed_.notify_all();
  }

  /// The next item; waits for it. None behind the last one; throws what end() was given.
  std::optional<Item> pop() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return !items_.empty() || has_ended_; });
    if (items_.empty()) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    std::optional<Item> item = std::move(items_.front());
    items_.pop_front();
    changed_.notify_all();
    return item;
  }

  /// Takes no more items: those that nobody has taken are lost.
  void close() {
    const std::lock_guard lock(mutex_);
    is_closed_ = true;
    items_.clear();
    changed_.notify_all();
  }

 private:
  const std::size_t length_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::deque<std::optional<Item>> items_;  ///< none of them empty
  bool has_ended_ = false, is_closed_ = false;
  std::exception_ptr failure_;
};

/// Fills a queue with what `next` gives until it gives none or nobody takes it any more. `next` is called once there is room, so
/// that an item is no older than it must be.
template <class Item, class Next>
void fill(BoundedQueue<Item>& to, Next next) {
  try {
    for (std::optional<Item> item; to.wait_for_room() && (item = next()) && to.push(std::move(*item));) {
    }
    to.end();
  } catch (...) {
    to.end(std::current_exception());
  }
}

/// Takes items from one queue to another. work(item) says whether the item goes on.
template <class Item, class Work>
void pass_on(BoundedQueue<Item>& from, BoundedQueue<Item>& to, const Work& work) {
  fill(to, [&]() -> std::optional<Item> {
    while (std::optional<Item> item = from.pop())
      if (work(*item)) return item;
    return std::nullopt;
  });
  from.close();
}

/// Takes items from a queue to its end. Throws what the work throws, and what comes with the end.
template <class Item, class Work>
void drain(BoundedQueue<Item>& from, const Work& work) {
  struct Close {
    BoundedQueue<Item>& queue;
    ~Close() { queue.close(); }
  } close{from};
  while (std::optional<Item> item = from.pop()) work(*item);
}

}  // namespace catchlight
