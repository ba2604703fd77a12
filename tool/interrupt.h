// Ctrl-C, once to stop with the best mesh so far, twice to end at once.
#pragma once

#include <atomic>

namespace nonobtuse::tool {

/// Catches SIGINT and SIGTERM once each; the second signal has its default action. The flag becomes
/// true with the first one. The only state a signal handler can reach is static; it lives here.
const std::atomic<bool>& catch_interrupts();

}  // namespace nonobtuse::tool
