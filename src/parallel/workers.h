// The one facade over threads. Work is cut into chunks whose size depends on the problem alone,
// never on the number of threads, and reductions add the chunks' results in order: the same bits
// for any number of threads.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <vector>

namespace nonobtuse::parallel {

/// A number of threads to run chunks on. Made once per call of the library and passed down.
class Workers {
 public:
  /// `threads` = 0 takes all cores; 1 runs everything in the calling thread.
  explicit Workers(int threads = 1);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  [[nodiscard]] int threads() const { return threads_; }

  /// Calls body(begin, end, chunk) for every chunk of at most `chunk_size` of [0, count). Chunks
  /// run in any order, on any thread; the first exception thrown is rethrown here. Bodies
  /// should not call it again: that brings no further threads.
  template <class Body>
  void for_chunks(std::size_t count, std::size_t chunk_size, const Body& body) const {
    const std::size_t chunks = (count + chunk_size - 1) / chunk_size;
    const auto run = [&](std::size_t chunk) {
      const std::size_t begin = chunk * chunk_size;
      const std::size_t end = begin + chunk_size < count ? begin + chunk_size : count;
      body(begin, end, chunk);
    };
    if (threads_ == 1 || chunks <= 1) {
      for (std::size_t c = 0; c < chunks; ++c) run(c);
    } else {
      dispatch(chunks, run);
    }
  }

  /// Calls body(i) for every i of [0, count), in chunks of `chunk_size`.
  template <class Body>
  void for_each(std::size_t count, std::size_t chunk_size, const Body& body) const {
    for_chunks(count, chunk_size, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) body(i);
    });
  }

  /// Sum of part(begin, end) over chunks of `chunk_size`, added in order of the chunks.
  template <class T, class Part>
  T ordered_sum(std::size_t count, std::size_t chunk_size, T zero, const Part& part) const {
    std::vector<T> parts((count + chunk_size - 1) / chunk_size, zero);
    for_chunks(count, chunk_size, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
      parts[chunk] = part(begin, end);
    });
    T sum = zero;
    for (const T& p : parts) sum += p;
    return sum;
  }

 private:
  void dispatch(std::size_t chunks, const std::function<void(std::size_t)>& run) const;

  struct Backend;
  int threads_;
  std::unique_ptr<Backend> backend_;
};

}  // namespace nonobtuse::parallel
