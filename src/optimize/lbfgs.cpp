#include "optimize/lbfgs.h"

#include <utility>

namespace nonobtuse::optimize {
namespace {

constexpr std::size_t kChunk = 2048;

// a += f * b, and the dot product of the new a with c: one pass over memory instead of two.
double add_scaled_and_dot(std::span<Vec3> a, double f, std::span<const Vec3> b,
                          std::span<const Vec3> c, const parallel::Workers& workers) {
  return workers.ordered_sum(a.size(), kChunk, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) {
      a[i] += f * b[i];
      sum += nonobtuse::dot(a[i], c[i]);
    }
    return sum;
  });
}

}  // namespace

double dot(std::span<const Vec3> a, std::span<const Vec3> b, const parallel::Workers& workers) {
  return workers.ordered_sum(a.size(), kChunk, 0.0, [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += nonobtuse::dot(a[i], b[i]);
    return sum;
  });
}

bool LbfgsHistory::add(std::span<const Vec3> s, std::span<const Vec3> y,
                       const parallel::Workers& workers) {
  const double sy = dot(s, y, workers);
  if (!(sy > 0)) return false;
  Pair pair;
  if (static_cast<int>(pairs_.size()) >= limit_) {  // reuse the memory of the oldest
    pair = std::move(pairs_.front());
    pairs_.pop_front();
  }
  pair.s.assign(s.begin(), s.end());
  pair.y.assign(y.begin(), y.end());
  pair.sy = sy;
  pairs_.push_back(std::move(pair));
  return true;
}

void LbfgsHistory::direction(std::span<const Vec3> gradient, std::span<Vec3> out,
                             const Preconditioner& preconditioner,
                             const parallel::Workers& workers) const {
  const std::size_t count = pairs_.size();
  const std::size_t n = gradient.size();
  std::vector<Vec3> q(gradient.begin(), gradient.end());
  if (count == 0) {
    preconditioner(q, out);
    for (Vec3& d : out) d = -d;
    return;
  }
  std::vector<double> alpha(count);
  double sq = dot(pairs_[count - 1].s, q, workers);
  for (std::size_t k = count; k-- > 0;) {
    alpha[k] = sq / pairs_[k].sy;
    // The dot product that the next older pair needs (after the oldest: any vector will do).
    const std::vector<Vec3>& older = pairs_[k > 0 ? k - 1 : 0].s;
    sq = add_scaled_and_dot(q, -alpha[k], pairs_[k].y, older, workers);
  }

  const Pair& last = pairs_.back();
  preconditioner(last.y, out);
  const double ypy = dot(last.y, out, workers);
  const double gamma = ypy > 0 ? last.sy / ypy : 1.0;
  preconditioner(q, out);
  workers.for_each(n, kChunk, [&](std::size_t i) { out[i] *= -gamma; });

  // out holds -r, hence the signs: beta = y.r / s.y, r += (alpha - beta) s.
  double yr = dot(pairs_[0].y, out, workers);
  for (std::size_t k = 0; k < count; ++k) {
    const double beta = -yr / pairs_[k].sy;
    const std::vector<Vec3>& newer = pairs_[k + 1 < count ? k + 1 : k].y;
    yr = add_scaled_and_dot(out, beta - alpha[k], pairs_[k].s, newer, workers);
  }
}

}  // namespace nonobtuse::optimize
