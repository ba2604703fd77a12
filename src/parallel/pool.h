// Working memory that chunks borrow, so that there are never more copies than threads.
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace nonobtuse::parallel {

/// Thread-safe. What is borrowed must leave no trace in the results.
template <class T>
class Pool {
 public:
  explicit Pool(std::function<std::unique_ptr<T>()> make) : make_(std::move(make)) {}

  /// Calls body(T&) with an object that no other thread uses meanwhile.
  template <class Body>
  void with(const Body& body) {
    std::unique_ptr<T> item;
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      if (!free_.empty()) {
        item = std::move(free_.back());
        free_.pop_back();
      }
    }
    if (!item) item = make_();
    body(*item);
    const std::lock_guard<std::mutex> lock(mutex_);
    free_.push_back(std::move(item));
  }

 private:
  std::function<std::unique_ptr<T>()> make_;
  std::mutex mutex_;
  std::vector<std::unique_ptr<T>> free_;
};

}  // namespace nonobtuse::parallel
