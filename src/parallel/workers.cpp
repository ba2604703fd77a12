// Backends: oneTBB where it was found, std::thread otherwise, serial where there are no threads
// (NONOBTUSE_PARALLEL_TBB / _THREADS / _SERIAL, set by the build).
#include "parallel/workers.h"

#include <algorithm>

#if defined(NONOBTUSE_PARALLEL_TBB)
#include <tbb/blocked_range.h>
#include <tbb/info.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>
#elif !defined(NONOBTUSE_PARALLEL_SERIAL)
#include <atomic>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#endif

namespace nonobtuse::parallel {

#if defined(NONOBTUSE_PARALLEL_TBB)

struct Workers::Backend {
  explicit Backend(int threads) : arena(threads) {}
  tbb::task_arena arena;
};

Workers::Workers(int threads)
    // oneTBB never runs more threads than cores and complains on stderr when asked to.
    : threads_(std::max(1, threads > 0 ? std::min(threads, tbb::info::default_concurrency())
                                       : tbb::info::default_concurrency())),
      backend_(threads_ > 1 ? std::make_unique<Backend>(threads_) : nullptr) {}

void Workers::dispatch(std::size_t chunks, const std::function<void(std::size_t)>& run) const {
  backend_->arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<std::size_t>(0, chunks, 1),
        [&](const tbb::blocked_range<std::size_t>& range) {
          for (std::size_t c = range.begin(); c != range.end(); ++c) run(c);
        },
        tbb::simple_partitioner());
  });
}

#elif defined(NONOBTUSE_PARALLEL_SERIAL)

struct Workers::Backend {};

Workers::Workers(int) : threads_(1) {}

void Workers::dispatch(std::size_t chunks, const std::function<void(std::size_t)>& run) const {
  for (std::size_t c = 0; c < chunks; ++c) run(c);
}

#else

struct Workers::Backend {};

Workers::Workers(int threads)
    : threads_(threads > 0 ? threads
                           : std::max(1, static_cast<int>(std::thread::hardware_concurrency()))) {}

void Workers::dispatch(std::size_t chunks, const std::function<void(std::size_t)>& run) const {
  std::atomic<std::size_t> next{0};
  std::exception_ptr failure;
  std::mutex failure_mutex;
  const auto work = [&] {
    try {
      for (std::size_t c = next++; c < chunks; c = next++) run(c);
    } catch (...) {
      const std::lock_guard<std::mutex> lock(failure_mutex);
      if (!failure) failure = std::current_exception();
      next = chunks;
    }
  };
  std::vector<std::thread> others;
  const std::size_t count = std::min(chunks, static_cast<std::size_t>(threads_));
  try {
    for (std::size_t i = 1; i < count; ++i) others.emplace_back(work);
  } catch (const std::system_error&) {
    // The system grants no more threads: those there are do all the work.
  }
  work();
  for (std::thread& t : others) t.join();
  if (failure) std::rethrow_exception(failure);
}

#endif

Workers::~Workers() = default;

}  // namespace nonobtuse::parallel
